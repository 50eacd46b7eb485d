// Which voxels a triangle meets, by separating axes as Schwarz and Seidel (2010) arrange them: the
// triangle's plane, and its three projections along the axes. Columns of voxels along the axis that
// the plane is steepest to are visited once, and in each only the voxels between the plane's lowest
// and highest point over the column.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include <Eigen/Geometry>

#include "parallel.hpp"
#include "voxel_fills.hpp"

namespace shape3d::descriptors::detail {
namespace {

using Eigen::Vector3d;

// First and last voxel of [0, side) whose closed extent meets [low, high].
std::array<int, 2> voxel_range(double low, double high, int side) {
  return {static_cast<int>(std::clamp(std::ceil(low - 1.0), 0.0, static_cast<double>(side))),
          static_cast<int>(std::clamp(std::floor(high), -1.0, side - 1.0))};
}

// The three half planes of a triangle projected along an axis, for unit squares by lower corner.
class Projection {
 public:
  Projection(const GridTriangle& t, const Vector3d& normal, int axis)
      : first_((axis + 1) % 3), second_((axis + 2) % 3) {
    const Vector3d* const corners[3] = {&t.a, &t.b, &t.c};
    const double sign = normal[axis] < 0.0 ? -1.0 : 1.0;
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const Vector3d& from = *corners[edge];
      const Vector3d& to = *corners[(edge + 1) % 3];
      const double nu = -sign * (to[second_] - from[second_]);
      const double nv = sign * (to[first_] - from[first_]);
      inward_[edge] = {nu, nv};
      offset_[edge] =
          std::max(nu, 0.0) + std::max(nv, 0.0) - (nu * from[first_] + nv * from[second_]);
    }
  }

  [[nodiscard]] bool meets(const std::array<int, 3>& voxel) const {
    const double u = voxel[static_cast<std::size_t>(first_)],
                 v = voxel[static_cast<std::size_t>(second_)];
    for (std::size_t edge = 0; edge < 3; ++edge) {
      if (inward_[edge][0] * u + inward_[edge][1] * v + offset_[edge] < 0.0) return false;
    }
    return true;
  }

 private:
  int first_, second_;
  std::array<std::array<double, 2>, 3> inward_{};
  std::array<double, 3> offset_{};
};

template <class Set>
void visit_voxels(const GridTriangle& t, int side, Set&& set) {
  const Vector3d low = t.low(), high = t.high();
  std::array<std::array<int, 2>, 3> range;
  int extents = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    range[axis] = voxel_range(low[i], high[i], side);
    if (range[axis][0] > range[axis][1]) return;
    extents += range[axis][0] != range[axis][1] ? 1 : 0;
  }
  std::array<int, 3> voxel{};
  const bool within = (low.array() >= 0.0).all() && (high.array() <= side).all();
  if (extents <= 1 && within) {
    // A row of voxels: the triangle lies in the row and reaches across all of its range.
    for (voxel[2] = range[2][0]; voxel[2] <= range[2][1]; ++voxel[2]) {
      for (voxel[1] = range[1][0]; voxel[1] <= range[1][1]; ++voxel[1]) {
        for (voxel[0] = range[0][0]; voxel[0] <= range[0][1]; ++voxel[0]) set(voxel);
      }
    }
    return;
  }
  const Vector3d normal = (t.b - t.a).cross(t.c - t.a);
  Eigen::Index steepest = 0;
  normal.cwiseAbs().maxCoeff(&steepest);
  const auto w = static_cast<std::size_t>(steepest), u = (w + 1) % 3, v = (w + 2) % 3;
  const auto iu = static_cast<Eigen::Index>(u), iv = static_cast<Eigen::Index>(v);
  const Projection along_w(t, normal, static_cast<int>(w)), along_u(t, normal, static_cast<int>(u)),
      along_v(t, normal, static_cast<int>(v));
  // The plane of a triangle that is lower than 1e-8 of its longest edge is known to worse than 1e-6
  // voxel edges; its projections bound it as closely.
  const double longest =
      std::max({(t.b - t.a).squaredNorm(), (t.c - t.b).squaredNorm(), (t.a - t.c).squaredNorm()});
  const bool has_plane = std::abs(normal[steepest]) > 1e-8 * longest;
  const double slope_u = has_plane ? -normal[iu] / normal[steepest] : 0.0;
  const double slope_v = has_plane ? -normal[iv] / normal[steepest] : 0.0;
  for (voxel[v] = range[v][0]; voxel[v] <= range[v][1]; ++voxel[v]) {
    for (voxel[u] = range[u][0]; voxel[u] <= range[u][1]; ++voxel[u]) {
      if (!along_w.meets(voxel)) continue;
      std::array<int, 2> column = range[w];
      if (has_plane) {
        const double at_corner =
            t.a[steepest] + slope_u * (voxel[u] - t.a[iu]) + slope_v * (voxel[v] - t.a[iv]);
        const double lowest = at_corner + std::min(slope_u, 0.0) + std::min(slope_v, 0.0);
        const double highest = at_corner + std::max(slope_u, 0.0) + std::max(slope_v, 0.0);
        const auto met = voxel_range(lowest, highest, side);
        column = {std::max(column[0], met[0]), std::min(column[1], met[1])};
      }
      for (voxel[w] = column[0]; voxel[w] <= column[1]; ++voxel[w]) {
        if (along_u.meets(voxel) && along_v.meets(voxel)) set(voxel);
      }
    }
  }
}

}  // namespace

std::vector<std::uint8_t> meets_surface(const std::vector<GridTriangle>& triangles, int side,
                                        int threads) {
  const auto n = static_cast<std::size_t>(side);
  // Several threads may set the same voxel, all to 1.
  std::vector<std::atomic<std::uint8_t>> marks(n * n * n);
  parallel_blocks(
      static_cast<std::int64_t>(triangles.size()), 256, threads,
      [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t i = first; i < last; ++i) {
          visit_voxels(
              triangles[static_cast<std::size_t>(i)], side, [&](const std::array<int, 3>& p) {
                marks[static_cast<std::size_t>(p[0]) +
                      n * (static_cast<std::size_t>(p[1]) + n * static_cast<std::size_t>(p[2]))]
                    .store(1, std::memory_order_relaxed);
              });
        }
      });
  return {marks.begin(), marks.end()};
}

}  // namespace shape3d::descriptors::detail
