#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "shape3d/descriptors/voxels.hpp"

namespace shape3d::descriptors::detail {

/// Trilinear interpolation between voxel centres at a point of the frame, [−1, 1]³; towards the
/// border of the grid and beyond, the outermost voxels count.
inline double trilinear(const Voxels& voxels, const Eigen::Vector3d& point) {
  int cell[3];
  double part[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double u =
        std::clamp(0.5 * (point[axis] + 1.0) * voxels.side - 0.5, 0.0, voxels.side - 1.0);
    cell[axis] = std::min(static_cast<int>(u), voxels.side - 2);
    part[axis] = u - cell[axis];
  }
  const auto n = static_cast<std::size_t>(voxels.side);
  const float* const f = voxels.values.data() + voxels.index(cell[0], cell[1], cell[2]);
  const auto along_x = [&](std::size_t offset) {
    return (1.0 - part[0]) * f[offset] + part[0] * f[offset + 1];
  };
  const auto along_y = [&](std::size_t offset) {
    return (1.0 - part[1]) * along_x(offset) + part[1] * along_x(offset + n);
  };
  return (1.0 - part[2]) * along_y(0) + part[2] * along_y(n * n);
}

}  // namespace shape3d::descriptors::detail
