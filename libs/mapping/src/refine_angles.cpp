// The angles' part of minimise.hpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include <ceres/ceres.h>

#include "angle_residual.hpp"
#include "minimise.hpp"
#include "rest_shape.hpp"
#include "sphere_problem.hpp"
#include "triangle.hpp"
#include "untangle.hpp"

namespace shape3d::mapping {
namespace {

/// Changes of angles from which on their norm counts, not its square, in radians.
constexpr double kBend = 0.03;
/// Weight of σ1/σ2 + σ2/σ1 − 2 beside them.
constexpr double kBarrier = 0.03;

/// Changes of the three angles of a triangle. They are the same for a flipped one.
class AngleCost final : public ceres::SizedCostFunction<3, 3, 3, 3> {
 public:
  explicit AngleCost(const std::array<Eigen::Vector3d, 3>& corners)
      : angles_(corner_angles(corners, nullptr)) {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> p(x[0]), q(x[1]), r(x[2]);
    std::array<RowMatrix3, 3> J;
    const bool wanted = jacobians != nullptr;
    const Eigen::Vector3d change = corner_angles({p, q, r}, wanted ? &J : nullptr) - angles_;
    for (int k = 0; k < 3; ++k) residuals[k] = change[k];
    for (int k = 0; wanted && k < 3; ++k) {
      if (jacobians[k] != nullptr) Eigen::Map<RowMatrix3>{jacobians[k]} = J[k];
    }
    return change.allFinite();
  }

 private:
  Eigen::Vector3d angles_;
};

/// ρ(s) = 2 w δ (√(s + δ²) − δ): the norm instead of its square, smoothed at 0. The second
/// derivative is given as 0, so that Ceres re-weights the squares: their sum lies above that of ρ.
class NormLoss final : public ceres::LossFunction {
 public:
  NormLoss(double weight, double delta) : weight_(weight), delta_(delta) {}
  void Evaluate(double s, double rho[3]) const override {
    const double root = std::sqrt(s + delta_ * delta_);
    rho[0] = 2 * weight_ * delta_ * (root - delta_);
    rho[1] = weight_ * delta_ / root;
    rho[2] = 0;
  }

 private:
  double weight_, delta_;
};

/// Of a least height under a fiftieth of the longest edge: its angles turn over within less than
/// the step that others take. The barrier alone holds its shape.
bool is_needle(const std::array<Eigen::Vector3d, 3>& corners) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    longest = std::max(longest, (corners[(k + 1) % 3] - corners[k]).squaredNorm());
  }
  return !(2 * plane_triangle(corners[0], corners[1], corners[2]).area() > 0.02 * longest);
}

/// One run of Ceres.
/// @param smoothing  Of det J in the barrier, as a share of its first value; 0 for a strict one.
ceres::Solver::Summary run(const ConstPoints& V, const ConstTriangles& F, double smoothing,
                           const MinimiseSettings& settings, Iterations& iterations, Points& S) {
  const double share = 1 / static_cast<double>(F.rows());
  double total_area = 0;
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    total_area += plane_triangle(row(V, F(f, 0)), row(V, F(f, 1)), row(V, F(f, 2))).area();
  }
  NormLoss loss(share, kBend);
  std::deque<AngleCost> angles;  // they are neither copied nor moved
  std::deque<TriangleCost> barriers;
  SphereProblem problem(S, F);
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const std::array<Eigen::Vector3d, 3> corners{row(V, F(f, 0)), row(V, F(f, 1)), row(V, F(f, 2))};
    RestShape shape = rest_shape(corners[0], corners[1], corners[2]);
    const Eigen::Vector3d p = row(S, F(f, 0));
    const double image = 0.5 * (row(S, F(f, 1)) - p).cross(row(S, F(f, 2)) - p).norm();
    const double epsilon = smoothing * image / shape.area;
    // A needle by its area, as in the conformal energy: alike with others it would hold them up.
    const bool needle = is_needle(corners);
    shape.area = kBarrier * (needle ? shape.area / total_area : share);
    const auto t = static_cast<std::size_t>(f);
    problem.add(barriers.emplace_back(shape, Energy::conformal, epsilon), nullptr, t);
    if (!needle) {
      problem.add(angles.emplace_back(corners), &loss, t);
    }
  }
  problem.hold(pins(S)[0]);
  return problem.solve(settings, iterations);
}

}  // namespace

bool refine_angles(const ConstPoints& V, const ConstTriangles& F, const Twins& twins,
                   const MinimiseSettings& settings, Points& S, MinimisationSummary& summary) {
  const Points start = S;
  summary.used = true;
  bool stuck = false;
  const auto refined = [&](double smoothing) {
    Iterations iterations(settings);
    MinimiseSettings left = settings;
    left.max_iterations = std::max(1, settings.max_iterations - summary.iterations);
    const ceres::Solver::Summary outcome = run(V, F, smoothing, left, iterations, S);
    if (summary.iterations == 0) summary.initial_cost = outcome.initial_cost;
    summary.final_cost = outcome.final_cost;
    summary.iterations += iteration_count(outcome);
    summary.termination = ceres::TerminationTypeToString(outcome.termination_type);
    summary.message = outcome.message;
    stuck = iterations.stuck();
    return !iterations.cancelled();
  };
  constexpr double kSmall = 0.05, kLarge = 0.5;
  if (!refined(kSmall)) return false;
  if (stuck && !refined(kLarge)) return false;
  if (flipped_count(F, S) == 0) return true;
  if (untangle(V, F, twins, S).left > 0) S = start;
  return refined(0);
}

}  // namespace shape3d::mapping
