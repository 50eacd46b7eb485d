#include "shape3d/mapping/align.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "mesh_arguments.hpp"

namespace shape3d::mapping {
namespace {

using Corners = Eigen::Matrix3d;  // one corner a column

/// Triangles in a frame of extent about 1, where squares of coordinates neither overflow nor
/// vanish.
class Surface {
 public:
  Surface(const ConstPoints& V, const ConstTriangles& F)
      : V_(V), F_(F), frame_(detail::frame_of(V, F)) {}

  [[nodiscard]] const detail::Frame& frame() const { return frame_; }

  template <class Visit>
  void for_each_triangle(const Visit& visit) const {
    const double inverse = 1.0 / frame_.unit;
    for (Eigen::Index t = 0; t < F_.rows(); ++t) {
      Corners p;
      for (Eigen::Index i = 0; i < 3; ++i) {
        p.col(i) = ((V_.row(F_(t, i)) - frame_.centre) * inverse).transpose();
      }
      const double area = 0.5 * (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).norm();
      visit(p, area);
    }
  }

 private:
  const ConstPoints& V_;
  const ConstTriangles& F_;
  detail::Frame frame_;
};

// ∫ sign(x) x² over a triangle of unit area whose corners have the coordinates a, b, c.
//
// ∫ x² = (a² + b² + c² + ab + bc + ca) / 6. When the plane x = 0 cuts a corner p off the corners q
// and r, what it cuts off has the share p² / ((p − q)(p − r)) of the area and ∫ x² = share · p²
// / 6.
double signed_square(double a, double b, double c) {
  const double whole = (a * a + b * b + c * c + a * b + b * c + c * a) / 6.0;
  if (a >= 0.0 && b >= 0.0 && c >= 0.0) return whole;
  if (a <= 0.0 && b <= 0.0 && c <= 0.0) return -whole;
  double p = a, q = b, r = c;
  if ((a > 0.0) == (c > 0.0)) {
    p = b;
    q = a;
  } else if ((a > 0.0) == (b > 0.0)) {
    p = c;
    r = a;
  }
  const double part = p * p / ((p - q) * (p - r)) * p * p / 6.0;
  return p > 0.0 ? 2.0 * part - whole : whole - 2.0 * part;
}

// Fixes the signs of the axes (rows) by the moments, and the margin of that choice.
void fix_signs(const Eigen::Vector3d& skew, const PoseOptions& options, Pose& pose) {
  pose.skew = skew;
  for (int axis = 0; axis < 3; ++axis) {
    if (skew[axis] >= 0.0) continue;
    pose.rotation.row(axis) *= -1.0;
    pose.skew[axis] = -skew[axis];
  }
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return pose.skew[a] < pose.skew[b]; });
  const double smallest = pose.skew[order[0]], middle = pose.skew[order[1]];
  if (options.allow_reflection) {
    pose.sign_margin = smallest;
  } else if (pose.rotation.determinant() > 0.0) {
    pose.sign_margin = middle + smallest;
  } else {
    pose.reversed_axis = order[0];
    pose.rotation.row(order[0]) *= -1.0;
    pose.skew[order[0]] *= -1.0;
    pose.sign_margin = middle - smallest;
  }
}

}  // namespace

Pose align(const ConstPoints& V, const ConstTriangles& F, const PoseOptions& options) {
  if (!(options.ambiguity_tolerance > 0.0 && options.ambiguity_tolerance < 1.0)) {
    throw std::invalid_argument(
        "options.ambiguity_tolerance: expected a number between 0 and 1, got " +
        std::to_string(options.ambiguity_tolerance));
  }
  detail::check_indices(V, F);
  detail::check_finite(V);
  const Surface surface(V, F);

  double area = 0.0;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  surface.for_each_triangle([&](const Corners& p, double a) {
    area += a;
    centroid += a / 3.0 * p.rowwise().sum();
  });
  if (!(area > 0.0)) {
    throw std::invalid_argument("F: the total area of the " + std::to_string(F.rows()) +
                                " triangles is zero, so they have no pose");
  }
  centroid /= area;

  // ∫ u uᵀ over a triangle with corners p_i and sum s: area / 12 · (Σ p_i p_iᵀ + s sᵀ).
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
  surface.for_each_triangle([&](Corners p, double a) {
    p.colwise() -= centroid;
    const Eigen::Vector3d sum = p.rowwise().sum();
    C += a / 12.0 * (p * p.transpose() + sum * sum.transpose());
  });
  C /= area;

  Pose pose;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(C);
  const Eigen::Vector3d values = eigen.eigenvalues().reverse().cwiseMax(0.0);
  pose.rotation = eigen.eigenvectors().rowwise().reverse().transpose();

  Eigen::Vector3d moments = Eigen::Vector3d::Zero();
  surface.for_each_triangle([&](Corners p, double a) {
    p.colwise() -= centroid;
    const Corners q = pose.rotation * p;
    for (int axis = 0; axis < 3; ++axis)
      moments[axis] += a * signed_square(q(axis, 0), q(axis, 1), q(axis, 2));
  });
  moments /= area;
  // Where an eigenvalue is nothing but rounding, so is the moment.
  const double nothing = 1e-14 * values[0];
  Eigen::Vector3d skew = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (values[axis] > nothing) skew[axis] = moments[axis] / values[axis];
  fix_signs(skew, options, pose);

  pose.gaps = {(values[0] - values[1]) / values[0], (values[1] - values[2]) / values[0]};
  pose.ambiguous = std::min(pose.gaps.minCoeff(), pose.sign_margin) < options.ambiguity_tolerance;
  const double unit = surface.frame().unit;
  pose.centroid = surface.frame().centre.transpose() + unit * centroid;
  pose.scale = 1.0 / (std::sqrt(values.sum()) * unit);
  pose.area = area * unit * unit;
  pose.eigenvalues = values * (unit * unit);
  return pose;
}

Points posed(const ConstPoints& V, const Pose& pose) {
  return ((V.rowwise() - pose.centroid.transpose()) * pose.rotation.transpose()) * pose.scale;
}

}  // namespace shape3d::mapping
