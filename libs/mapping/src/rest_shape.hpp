#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "triangle.hpp"

namespace shape3d::mapping {

/// det(p, q, r) of spherical triangles from which on their orientation is beyond the rounding of
/// unit vectors: 2^-100. Smaller ones count as degenerate.
constexpr double kSmallestDeterminant = 0x1p-100;

/// A triangle of the surface as the domain of a linear map x: ∂x/∂u = Σ du_k x_k and
/// ∂x/∂v = Σ dv_k x_k for orthonormal u, v.
struct RestShape {
  double area = 0;
  std::array<double, 3> du{}, dv{};
};

/// A triangle whose height is under 1e-4 of its base is fattened to that, so that its derivatives
/// stay finite and it weighs no more than its neighbours can bear.
inline RestShape rest_shape(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                            const Eigen::Vector3d& r) {
  PlaneTriangle t = plane_triangle(p, q, r);
  const double longest = std::max({t.a, (r - p).norm(), (r - q).norm()});
  const double least = 1e-4 * longest + std::numeric_limits<double>::min();
  if (t.a < least) t = {least, 0, longest};
  t.c = std::max(t.c, least);
  RestShape shape;
  shape.area = t.area();
  shape.du = {-1 / t.a, 1 / t.a, 0};
  shape.dv = {(t.b / t.a - 1) / t.c, -t.b / (t.a * t.c), 1 / t.c};
  return shape;
}

}  // namespace shape3d::mapping
