#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "samples.hpp"
#include "shape3d/zmc/cell.hpp"
#include "shape3d/zmc/volume_view.hpp"

namespace shape3d::zmc::detail {

/// Lattice coordinates to world coordinates. With a capped border lattice indices start one sample
/// early; those of a lattice that begins at a later plane of the volume, at that plane.
class Geometry {
 public:
  explicit Geometry(const VolumeView& view, bool capped = false, std::int64_t first_plane = 0)
      : origin_(view.origin),
        axes_(view.direction * view.spacing.asDiagonal()),
        shift_(capped ? 1.0 : 0.0),
        z_shift_(shift_ - static_cast<double>(first_plane)) {}

  /// The place at t of the edge from lattice point (i, j, k) along an axis.
  [[nodiscard]] Eigen::Vector3d world(std::int64_t i, std::int64_t j, std::int64_t k, int axis = 0,
                                      double t = 0.0) const {
    return plane(k, axis == 2 ? t : 0.0) + y_term(j, axis == 1 ? t : 0.0) +
           x_term(i, axis == 0 ? t : 0.0);
  }
  /// Terms of world() in their order of summation. Indices are moved before t is added, so that a
  /// lattice point has the same place in whatever part of the volume the lattice is.
  [[nodiscard]] Eigen::Vector3d plane(std::int64_t k, double t = 0.0) const {
    return origin_ + axes_.col(2) * ((static_cast<double>(k) - z_shift_) + t);
  }
  [[nodiscard]] Eigen::Vector3d y_term(std::int64_t j, double t = 0.0) const {
    return axes_.col(1) * ((static_cast<double>(j) - shift_) + t);
  }
  [[nodiscard]] Eigen::Vector3d x_term(std::int64_t i, double t = 0.0) const {
    return axes_.col(0) * ((static_cast<double>(i) - shift_) + t);
  }

  /// What these terms are made of: column d of axes is the step along lattice axis d, and lattice
  /// index and shift differ by the coordinate that it is multiplied by.
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  [[nodiscard]] const Eigen::Matrix3d& axes() const { return axes_; }
  [[nodiscard]] double shift(int axis) const { return axis == 2 ? z_shift_ : shift_; }

  /// The axes form a left-handed frame, so that triangles must be turned over.
  [[nodiscard]] bool mirrored() const { return axes_.determinant() < 0.0; }

  /// World place of a surface vertex (as in CellPatches) of cell (i, j, k).
  template <class Magnitude>
  [[nodiscard]] Eigen::Vector3d surface_vertex(const Magnitude& magnitude, std::int64_t i,
                                               std::int64_t j, std::int64_t k, int vertex) const {
    const auto& low = kCellVertices[vertex >= 12 ? vertex - 12 : lower_end(vertex)];
    i += low[0], j += low[1], k += low[2];
    if (vertex >= 12) return world(i, j, k);
    const int axis = edge_axis(vertex);
    return world(i, j, k, axis, magnitude.crossing(i, j, k, axis));
  }

  /// Direction of a cell edge, 0 … 2.
  static int edge_axis(int edge) {
    if (edge >= 8) return 2;
    return edge % 2;  // edges 0, 2, 4, 6 along x; 1, 3, 5, 7 along y
  }
  /// The end of a cell edge with the smaller coordinate.
  static int lower_end(int edge) {
    const auto& e = kCellEdges[edge];
    const int axis = edge_axis(edge);
    return kCellVertices[e[0]][axis] < kCellVertices[e[1]][axis] ? e[0] : e[1];
  }

 private:
  Eigen::Vector3d origin_;
  Eigen::Matrix3d axes_;
  double shift_;
  double z_shift_;
};

}  // namespace shape3d::zmc::detail
