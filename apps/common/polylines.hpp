#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <shape3d/zmc/contour.hpp>
#include <shape3d/zmc/volume_view.hpp>

#include "output_file.hpp"

namespace shape3d::apps {

/// Vertices of a contour in the order in which its edges join them.
struct Polyline {
  std::vector<std::int32_t>
      vertices;  ///< Rows of Contour::V; the first is not repeated at the end.
  bool closed = false;
};

/// Joins the edges of a contour into polylines: each edge is in exactly one, once.
///
/// Open polylines begin and end at vertices of odd degree (the border of the volume); the others
/// are closed and pass each vertex once, so that loops that touch in a vertex come apart. Edges
/// keep their direction where it is consistent. O(edges), in the order of the edges.
[[nodiscard]] std::vector<Polyline> join_edges(const zmc::Contour& contour);

/// A slice as it is looked at: axial with the patient's left to the right and posterior down,
/// sagittal and coronal with superior up, if the direction of the volume is near a permutation with
/// signs; millimetres from the corner of the slice.
class SlicePlane {
 public:
  SlicePlane(const zmc::VolumeView& volume, int axis);
  /// Width and height in millimetres.
  [[nodiscard]] std::array<double, 2> size() const { return size_; }
  /// Right and down from the corner.
  [[nodiscard]] std::array<double, 2> project(const Eigen::Vector3d& world) const;
  /// Lattice coordinates of a place on the slice: the inverse of project() there.
  [[nodiscard]] Eigen::Vector3d lattice(const std::array<double, 2>& place,
                                        std::int64_t slice) const;

 private:
  Eigen::Matrix3d to_lattice_;
  Eigen::Vector3d origin_;
  int axis_ = 2;
  std::array<int, 2> axes_{};
  std::array<bool, 2> flipped_{};
  std::array<double, 2> spacing_{}, size_{};
};

/// Writes a contour as a picture: one path, filled by the even-odd rule; coordinates with three
/// decimals.
void write_svg(OutputFile& file, const zmc::Contour& contour, const std::vector<Polyline>& lines,
               const SlicePlane& plane, const std::string& title);

/// Writes a contour as VTK PolyData with lines, and the space as the meshes have it.
void write_contour_vtp(OutputFile& file, const zmc::Contour& contour,
                       const std::vector<Polyline>& lines, const std::string& space);

}  // namespace shape3d::apps
