#pragma once

#include <array>
#include <cmath>

#include <ceres/ceres.h>

#include "minimise.hpp"
#include "residual.hpp"
#include "rest_shape.hpp"
#include "shape3d/mapping/mesh.hpp"
#include "triangle.hpp"

namespace shape3d::mapping {

constexpr double kInitialRadius = 1e4;  ///< Of the trust region.

/// conformal_residual() for Ceres.
class TriangleCost final : public ceres::SizedCostFunction<3, 3, 3, 3> {
 public:
  /// @param epsilon  Smooths det J; 0 refuses triangles that are not positive.
  TriangleCost(const RestShape& shape, Energy energy, double epsilon)
      : shape_(shape), energy_(energy), epsilon_(epsilon) {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> p(x[0]), q(x[1]), r(x[2]);
    if (epsilon_ == 0 && !(orientation_determinant(p, q, r) > kSmallestDeterminant)) return false;
    std::array<RowMatrix3, 3> J;
    const bool wanted = jacobians != nullptr;
    const Eigen::Vector3d value =
        conformal_residual(shape_, energy_, epsilon_, {p, q, r}, wanted ? &J : nullptr);
    for (int k = 0; k < 3; ++k) residuals[k] = value[k];
    for (int k = 0; wanted && k < 3; ++k) {
      if (jacobians[k] != nullptr) Eigen::Map<RowMatrix3>{jacobians[k]} = J[k];
    }
    return value.allFinite();
  }

 private:
  RestShape shape_;
  Energy energy_;
  double epsilon_;
};

/// Ends the minimisation: when the caller cancels, and when a step that the trust region did not
/// cut short changed the cost by no more than the tolerance. A short step says nothing of how near
/// the minimum is.
class Iterations final : public ceres::IterationCallback {
 public:
  explicit Iterations(const MinimiseSettings& settings) : settings_(settings) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (settings_.iterate && !settings_.iterate(summary.iteration)) {
      cancelled_ = true;
      return ceres::SOLVER_ABORT;
    }
    // Dozens of refused steps later: the trust region has shrunk around some needle.
    if (summary.trust_region_radius < 1) {
      stuck_ = true;
      return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    }
    const bool long_step = summary.iteration > 0 && summary.step_is_successful &&
                           summary.trust_region_radius >= kInitialRadius;
    return long_step && summary.cost_change <= settings_.function_tolerance * summary.cost
               ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
               : ceres::SOLVER_CONTINUE;
  }
  [[nodiscard]] bool cancelled() const { return cancelled_; }
  [[nodiscard]] bool stuck() const { return stuck_; }

 private:
  const MinimiseSettings& settings_;
  bool cancelled_ = false, stuck_ = false;
};

/// Points on the sphere as the unknowns of a Ceres problem. All of it is referred to, not copied.
class SphereProblem {
 public:
  SphereProblem(Points& S, const ConstTriangles& F);
  /// @param cost  Of the three corners of triangle t.
  /// @param loss  Null: the square.
  void add(ceres::CostFunction& cost, ceres::LossFunction* loss, std::size_t t);
  void hold(Eigen::Index vertex);
  /// Levenberg-Marquardt, each step by a sparse Cholesky factorisation of the normal equations in
  /// settings.order.
  ceres::Solver::Summary solve(const MinimiseSettings& settings, Iterations& iterations);

 private:
  Points& S_;
  const ConstTriangles& F_;
  ceres::SphereManifold<3> sphere_;
  ceres::Problem problem_;
};

/// Three vertices far from one another on a great circle.
std::array<Eigen::Index, 3> pins(const Points& S);

/// Steps that Ceres tried.
int iteration_count(const ceres::Solver::Summary& outcome);

}  // namespace shape3d::mapping
