#pragma once

#include <cstddef>
#include <vector>

#include "shape3d/descriptors/surface.hpp"

namespace shape3d::descriptors {

/// Smallest and largest number of voxels along an axis.
inline constexpr int kMinSide = 8, kMaxSide = 256;

/// A cubic grid of voxels round the unit ball of a frame.
///
/// Voxel (i, j, k), 0 ≤ i, j, k < side, is the cube [i, i+1] × [j, j+1] × [k, k+1] of grid
/// coordinates, and grid coordinate u along an axis is 2u/side − 1 in the frame: the ball touches
/// the six faces of the grid, its centre is a corner of eight voxels when side is even.
struct Voxels {
  int side = 0;
  Frame frame;
  std::vector<float> values;  ///< side³, x fastest: voxel (i, j, k) is i + side · (j + side · k).

  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    const auto n = static_cast<std::size_t>(side);
    return static_cast<std::size_t>(i) +
           n * (static_cast<std::size_t>(j) + n * static_cast<std::size_t>(k));
  }
  [[nodiscard]] float at(int i, int j, int k) const { return values[index(i, j, k)]; }
  /// Edge of a voxel in the unit of the surface.
  [[nodiscard]] double spacing() const { return 2.0 * frame.radius / side; }
};

}  // namespace shape3d::descriptors
