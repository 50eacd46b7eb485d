#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "shape3d/descriptors/surface.hpp"

namespace shape3d::descriptors {

/// Where a direction lies in a triangulation of the sphere: P = (uA + vB + wC) / |…| (4.8).
struct SpherePlace {
  std::int32_t triangle = -1;
  double u = 0.0, v = 0.0, w = 0.0;  ///< ≥ 0, sum 1.
};

/// The place of each pixel of an image of n rows and 2n columns, row by row.
///
/// @param S  Unit vectors. @param F  Triangles that cover the sphere once, counter-clockwise seen
/// from outside.
[[nodiscard]] std::vector<SpherePlace> locate_pixels(const Eigen::Ref<const Points>& S,
                                                     const Eigen::Ref<const Triangles>& F,
                                                     int size);

}  // namespace shape3d::descriptors
