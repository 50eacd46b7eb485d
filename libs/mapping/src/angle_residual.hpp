#pragma once

#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "triangle.hpp"

namespace shape3d::mapping {

using RowMatrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Angles of the plane triangle of three points, at each of them.
/// @param jacobians  (*jacobians)[k] is the derivative of the three angles by corner k; not
/// computed
///                   when null.
inline Eigen::Vector3d corner_angles(const std::array<Eigen::Vector3d, 3>& corners,
                                     std::array<RowMatrix3, 3>* jacobians) {
  const Eigen::Vector3d N = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double twice_area = N.norm();
  Eigen::Vector3d angles;
  if (jacobians != nullptr) {
    for (RowMatrix3& J : *jacobians) J.setZero();
  }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Eigen::Vector3d a = corners[i] - corners[k], b = corners[j] - corners[k];
    angles[k] = std::atan2(twice_area, a.dot(b));
    if (jacobians == nullptr) continue;
    // The angle grows as its legs turn away from one another.
    const Eigen::RowVector3d by_i = a.cross(N) / (twice_area * a.squaredNorm());
    const Eigen::RowVector3d by_j = N.cross(b) / (twice_area * b.squaredNorm());
    (*jacobians)[i].row(k) += by_i;
    (*jacobians)[j].row(k) += by_j;
    (*jacobians)[k].row(k) -= by_i + by_j;
  }
  return angles;
}

}  // namespace shape3d::mapping
