#pragma once

#include <vector>

#include <Eigen/Core>

#include "shape3d/descriptors/surface.hpp"

namespace shape3d::descriptors::detail {

/// A triangle in grid coordinates: voxel (i, j, k) is the cube from (i, j, k) to (i+1, j+1, k+1).
struct GridTriangle {
  Eigen::Vector3d a, b, c;

  [[nodiscard]] Eigen::Vector3d low() const { return a.cwiseMin(b).cwiseMin(c); }
  [[nodiscard]] Eigen::Vector3d high() const { return a.cwiseMax(b).cwiseMax(c); }
};

/// The triangles whose box comes within `margin` of the grid [0, side]³, in the order of F.
std::vector<GridTriangle> grid_triangles(const Eigen::Ref<const Points>& V,
                                         const Eigen::Ref<const Triangles>& F, const Frame& frame,
                                         int side, double margin);

}  // namespace shape3d::descriptors::detail
