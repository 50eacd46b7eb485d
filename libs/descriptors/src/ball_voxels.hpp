#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shape3d::descriptors::detail {

/// The voxels of the unit ball of a grid, by their exact distance from the centre.
///
/// A voxel and its mirror images in the three middle planes share |x|, |y|, |z|: one *octant voxel*
/// with x, y, z ≥ 0 stands for up to eight. Voxels at exactly the same distance (an integer in
/// units of half a voxel edge, squared) are a shell.
struct BallVoxels {
  explicit BallVoxels(int side);

  int side;
  std::vector<double> shell_rho;         ///< Radius of each shell in units of the ball's.
  std::vector<std::size_t> shell_begin;  ///< First octant voxel of each shell, and the end.
  std::vector<std::uint16_t> column, row, plane;  ///< i, j, k of each octant voxel; the mirror
                                                  ///< image of i is side − 1 − i.
  std::vector<double> cos_theta, sin_theta, cos_phi, sin_phi;  ///< Its direction.
  std::vector<double> share;  ///< Part of the voxel inside the ball, 0 … 1; halved for each
                              ///< coordinate that is 0, whose mirror image is the voxel itself.

  [[nodiscard]] std::size_t shells() const { return shell_rho.size(); }
};

/// Volume of the part of the unit cube round the origin in { x : normal · x ≤ distance }, for a
/// unit normal of components ≥ 0.
double cube_below_plane(const double normal[3], double distance);

}  // namespace shape3d::descriptors::detail
