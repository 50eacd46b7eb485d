#pragma once

#include <algorithm>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace shape3d::mapping::detail {

/// The point of a triangle nearest to another point.
struct Foot {
  Eigen::Vector3d weights = Eigen::Vector3d(1, 0, 0);  ///< Of the corners; ≥ 0, sum 1.
  double squared_distance = 0.0;
};

/// The nearest point of the segment a b: weights of a and b in the first two places.
inline Foot nearest_on_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                               const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = b - a;
  const double length = d.squaredNorm();
  const double t = length > 0.0 ? std::clamp((p - a).dot(d) / length, 0.0, 1.0) : 0.0;
  return {{1.0 - t, t, 0.0}, (a + t * d - p).squaredNorm()};
}

/// The nearest point of the triangle a b c, which may have no area: inside it by the normal
/// equations, else the nearest of its three sides.
inline Foot nearest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d u = b - a, v = c - a, w = p - a;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  if (determinant > 0.0) {
    const double s = (vv * uw - uv * vw) / determinant, t = (uu * vw - uv * uw) / determinant;
    if (s >= 0.0 && t >= 0.0 && s + t <= 1.0)
      return {{1.0 - s - t, s, t}, (w - s * u - t * v).squaredNorm()};
  }
  const Foot ab = nearest_on_segment(p, a, b), bc = nearest_on_segment(p, b, c),
             ca = nearest_on_segment(p, c, a);
  Foot best = ab;
  if (bc.squared_distance < best.squared_distance)
    best = {{0.0, bc.weights[0], bc.weights[1]}, bc.squared_distance};
  if (ca.squared_distance < best.squared_distance)
    best = {{ca.weights[1], 0.0, ca.weights[0]}, ca.squared_distance};
  return best;
}

}  // namespace shape3d::mapping::detail
