#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/polylines.hpp"
#include "window_level.hpp"

namespace shape3d::apps::viewer {

/// Lines as places of SliceGeometry.
using SliceLines = std::vector<std::vector<std::array<double, 2>>>;

/// How the slices of a volume across one axis stand on the screen: one pixel a sample, turned as
/// SlicePlane turns them (a patient's left to the right, posterior down, superior up).
class SliceGeometry {
 public:
  /// @pre  validate(volume); axis is 0, 1 or 2.
  SliceGeometry(const zmc::VolumeView& volume, int axis);

  [[nodiscard]] int axis() const { return axis_; }
  [[nodiscard]] std::int64_t slices() const { return slices_; }
  [[nodiscard]] int columns() const { return columns_; }  ///< Pixels.
  [[nodiscard]] int rows() const { return rows_; }
  /// Millimetres, from border to border of the outermost pixels.
  [[nodiscard]] std::array<double, 2> size() const;
  /// Lattice coordinates of a place: millimetres right and down from the upper left corner of the
  /// picture, which is half a pixel outside the first sample.
  [[nodiscard]] Eigen::Vector3d lattice(const std::array<double, 2>& place, double slice) const;
  /// The inverse: the coordinate across the slice is lost.
  [[nodiscard]] std::array<double, 2> place(const Eigen::Vector3d& lattice) const;
  /// The sample under a pixel. @pre  the pixel is within the picture.
  [[nodiscard]] std::array<std::int64_t, 3> sample(int column, int row, std::int64_t slice) const;
  /// Directions of the patient at the left, right, upper and lower side: "R", "L", "A", "P" …;
  /// oblique axes are named by what they are nearest to.
  [[nodiscard]] std::array<std::string, 4> sides() const;
  /// "axial", "sagittal" or "coronal": by the direction that is nearest to the axis across.
  [[nodiscard]] std::string name() const;

 private:
  int axis_ = 2, columns_ = 0, rows_ = 0;
  std::int64_t slices_ = 0;
  std::array<int, 2> axes_{};
  std::array<bool, 2> flipped_{};
  std::array<double, 2> spacing_{};
  Eigen::Matrix3d direction_ = Eigen::Matrix3d::Identity();
};

/// A slice as bytes of grey, row by row from the top: 0 at the black end of the window, 255 at the
/// white one, linear between; samples that are not finite are black.
/// @pre  0 ≤ slice < geometry.slices(); geometry is that of the volume.
[[nodiscard]] std::vector<std::uint8_t> slice_image(const zmc::VolumeView& volume,
                                                    const SliceGeometry& geometry,
                                                    std::int64_t slice, const Window& window);

/// The lines in which the surface of an isovalue cuts a slice, from its own patch edges
/// (zmc::contour), as places of SliceGeometry; closed lines repeat their first point.
/// @param exact  Classify the whole volume, as cells of eight samples equal to the isovalue need,
///        whose sign comes from around; else only the layer of cells beside the slice.
[[nodiscard]] SliceLines slice_contour(const zmc::VolumeView& volume, const SliceGeometry& geometry,
                                       double isovalue, std::int64_t slice, bool exact = false);

/// The same of a part of the volume, or of other samples in its place, over the slice of the whole.
/// @param part   Its axes are those of the whole.
/// @param slice  Of the part.
[[nodiscard]] SliceLines part_contour(const zmc::VolumeView& whole, const SliceGeometry& geometry,
                                      const zmc::VolumeView& part, double isovalue,
                                      std::int64_t slice, bool exact = false);

}  // namespace shape3d::apps::viewer
