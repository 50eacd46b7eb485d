#include "ball_voxels.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace shape3d::descriptors::detail {

double cube_below_plane(const double normal[3], double distance) {
  // Inclusion and exclusion of the corners below the plane; a component of 0 would divide by it.
  const double a = std::max(normal[0], 1e-3), b = std::max(normal[1], 1e-3),
               c = std::max(normal[2], 1e-3);
  const double height = distance + 0.5 * (a + b + c);  // above the lowest corner
  if (height <= 0.0) return 0.0;
  if (height >= a + b + c) return 1.0;
  const auto cube = [](double x) { return x > 0.0 ? x * x * x : 0.0; };
  const double sum = cube(height) - cube(height - a) - cube(height - b) - cube(height - c) +
                     cube(height - a - b) + cube(height - a - c) + cube(height - b - c);
  return std::clamp(sum / (6.0 * a * b * c), 0.0, 1.0);
}

BallVoxels::BallVoxels(int grid_side) : side(grid_side) {
  struct OctantVoxel {
    int square;  // of the distance, in half voxel edges
    int x, y, z;
  };
  std::vector<OctantVoxel> octant;
  const double ball = 0.5 * side;
  for (int z = (side + 1) % 2; z < side; z += 2) {
    for (int y = (side + 1) % 2; y < side; y += 2) {
      for (int x = (side + 1) % 2; x < side; x += 2) {
        const int square = x * x + y * y + z * z;
        const double radius = 0.5 * std::sqrt(static_cast<double>(square));
        const double normal[3] = {0.5 * x / radius, 0.5 * y / radius, 0.5 * z / radius};
        if (square == 0 || cube_below_plane(normal, ball - radius) > 0.0) {
          octant.push_back({square, x, y, z});
        }
      }
    }
  }
  std::stable_sort(octant.begin(), octant.end(),
                   [](const OctantVoxel& a, const OctantVoxel& b) { return a.square < b.square; });

  int square = -1;
  for (const OctantVoxel& voxel : octant) {
    const double radius = 0.5 * std::sqrt(static_cast<double>(voxel.square));
    if (voxel.square != square) {
      square = voxel.square;
      shell_begin.push_back(column.size());
      shell_rho.push_back(radius / ball);
    }
    column.push_back(static_cast<std::uint16_t>((voxel.x + side - 1) / 2));
    row.push_back(static_cast<std::uint16_t>((voxel.y + side - 1) / 2));
    plane.push_back(static_cast<std::uint16_t>((voxel.z + side - 1) / 2));
    const double flat = 0.5 * std::hypot(voxel.x, voxel.y);
    cos_theta.push_back(radius > 0.0 ? 0.5 * voxel.z / radius : 1.0);
    sin_theta.push_back(radius > 0.0 ? flat / radius : 0.0);
    cos_phi.push_back(flat > 0.0 ? 0.5 * voxel.x / flat : 1.0);
    sin_phi.push_back(flat > 0.0 ? 0.5 * voxel.y / flat : 0.0);
    double part = 1.0;
    if (radius > 0.0) {
      const double normal[3] = {0.5 * voxel.x / radius, 0.5 * voxel.y / radius,
                                0.5 * voxel.z / radius};
      part = cube_below_plane(normal, ball - radius);
    }
    for (const int coordinate : {voxel.x, voxel.y, voxel.z}) {
      if (coordinate == 0) part *= 0.5;
    }
    share.push_back(part);
  }
  shell_begin.push_back(column.size());
}

}  // namespace shape3d::descriptors::detail
