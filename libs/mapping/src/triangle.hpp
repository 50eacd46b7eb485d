#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

inline Eigen::Vector3d row(const ConstPoints& P, Eigen::Index i) { return P.row(i).transpose(); }

/// A plane triangle in its own frame: (0, 0), (a, 0), (b, c), so that c ≥ 0.
struct PlaneTriangle {
  double a = 0, b = 0, c = 0;
  [[nodiscard]] double area() const { return 0.5 * a * c; }
};

inline PlaneTriangle plane_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                                    const Eigen::Vector3d& r) {
  const Eigen::Vector3d e = q - p, g = r - p;
  const double a = e.norm();
  return {a, a > 0 ? e.dot(g) / a : 0.0, a > 0 ? e.cross(g).norm() / a : 0.0};
}

/// det(p, q, r), from differences of the points: accurate for small triangles far from the origin.
inline double orientation_determinant(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                                      const Eigen::Vector3d& r) {
  return p.dot((q - p).cross(r - p));
}

/// Signed solid angle of a triangle of unit vectors (van Oosterom, Strackee 1983, eq. 8).
inline double solid_angle(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                          const Eigen::Vector3d& r) {
  return 2 * std::atan2(orientation_determinant(p, q, r), 1 + p.dot(q) + q.dot(r) + r.dot(p));
}

}  // namespace shape3d::mapping
