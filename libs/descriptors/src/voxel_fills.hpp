#pragma once

#include <cstdint>
#include <vector>

#include "grid_triangles.hpp"

namespace shape3d::descriptors::detail {

/// Fill::binary: 1 where the closed cube of a voxel meets a triangle. x fastest.
std::vector<std::uint8_t> meets_surface(const std::vector<GridTriangle>& triangles, int side,
                                        int threads);

/// Fill::area.
std::vector<float> area_splat(const std::vector<GridTriangle>& triangles, int side, int threads);

/// Fill::gedt from the result of meets_surface(); `reach` is where the result becomes 0.
std::vector<float> gaussian_of_voxels(const std::vector<std::uint8_t>& set, int side, double sigma,
                                      double reach, int threads);

/// Fill::distance. Voxels that no part of lies in the ball are 0.
std::vector<float> gaussian_of_surface(const std::vector<GridTriangle>& triangles, int side,
                                       double sigma, double reach, int threads);

}  // namespace shape3d::descriptors::detail
