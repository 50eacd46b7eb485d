#include "minimise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

#include <ceres/ceres.h>

#include "residual.hpp"
#include "rest_shape.hpp"
#include "untangle.hpp"

namespace shape3d::mapping {
namespace {

constexpr double kInitialRadius = 1e4;

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

class AreaCost final : public ceres::SizedCostFunction<1, 3, 3, 3> {
 public:
  AreaCost(const RestShape& shape, double weight) : shape_(shape), weight_(weight) {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> p(x[0]), q(x[1]), r(x[2]);
    std::array<Eigen::RowVector3d, 3> J;
    const bool wanted = jacobians != nullptr;
    residuals[0] = area_residual(shape_, weight_, {p, q, r}, wanted ? &J : nullptr);
    for (int k = 0; wanted && k < 3; ++k) {
      if (jacobians[k] != nullptr) Eigen::Map<Eigen::RowVector3d>{jacobians[k]} = J[k];
    }
    return std::isfinite(residuals[0]);
  }

 private:
  RestShape shape_;
  double weight_;
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

/// Three vertices far from one another on a great circle.
std::array<Eigen::Index, 3> pins(const Points& S) {
  const std::array<Eigen::Vector3d, 3> corners{Eigen::Vector3d(1, 0, 0),
                                               Eigen::Vector3d(-0.5, 0.8660254037844386, 0),
                                               Eigen::Vector3d(-0.5, -0.8660254037844386, 0)};
  std::array<Eigen::Index, 3> chosen{-1, -1, -1};
  for (int k = 0; k < 3; ++k) {
    double best = -2;
    for (Eigen::Index i = 0; i < S.rows(); ++i) {
      const double along = S.row(i).dot(corners[k].transpose());
      if (along > best && i != chosen[0] && i != chosen[1]) {
        best = along;
        chosen[k] = i;
      }
    }
  }
  return chosen;
}

/// The triangles as domains, scaled to a total area of 1: the cost is then the mean excess of
/// σ1/σ2 + σ2/σ1 over 2, halved.
std::vector<RestShape> unit_shapes(const ConstPoints& V, const ConstTriangles& F) {
  std::vector<RestShape> shapes;
  shapes.reserve(F.rows());
  double area = 0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    shapes.push_back(rest_shape(row(V, F(t, 0)), row(V, F(t, 1)), row(V, F(t, 2))));
    area += shapes.back().area;
  }
  const double length = std::sqrt(area);
  for (RestShape& shape : shapes) {
    shape.area /= area;
    for (double& d : shape.du) d *= length;
    for (double& d : shape.dv) d *= length;
  }
  return shapes;
}

/// A share of |det J| of each triangle.
std::vector<double> smoothing(double share, const std::vector<RestShape>& shapes,
                              const ConstTriangles& F, const Points& S) {
  std::vector<double> epsilon;
  epsilon.reserve(shapes.size());
  for (std::size_t t = 0; t < shapes.size(); ++t) {
    const auto f = static_cast<Eigen::Index>(t);
    const Eigen::Vector3d p = row(S, F(f, 0));
    const double twice_area = (row(S, F(f, 1)) - p).cross(row(S, F(f, 2)) - p).norm();
    epsilon.push_back(share * twice_area / (2 * shapes[t].area));
  }
  return epsilon;
}

/// What Ceres minimises, without smoothing.
double cost(const std::vector<RestShape>& shapes, const ConstTriangles& F,
            const MinimiseSettings& settings, const Points& S) {
  double sum = 0;
  for (std::size_t t = 0; t < shapes.size(); ++t) {
    const auto f = static_cast<Eigen::Index>(t);
    const std::array<Eigen::Vector3d, 3> corners{row(S, F(f, 0)), row(S, F(f, 1)), row(S, F(f, 2))};
    sum += conformal_residual(shapes[t], settings.energy, 0, corners, nullptr).squaredNorm();
    if (settings.area_weight > 0) {
      const double area = area_residual(shapes[t], settings.area_weight, corners, nullptr);
      sum += area * area;
    }
  }
  return 0.5 * sum;
}

enum class Ending { converged, stuck, cancelled };

/// One run of Ceres. `epsilon` is empty for a strict one.
Ending run(const std::vector<RestShape>& shapes, const std::vector<double>& epsilon,
           const ConstTriangles& F, const MinimiseSettings& settings, Points& S,
           ceres::Solver::Summary& outcome) {
  std::deque<TriangleCost> costs;  // they are neither copied nor moved
  std::deque<AreaCost> area_costs;
  for (std::size_t t = 0; t < shapes.size(); ++t) {
    costs.emplace_back(shapes[t], settings.energy, epsilon.empty() ? 0 : epsilon[t]);
    if (settings.area_weight > 0) area_costs.emplace_back(shapes[t], settings.area_weight);
  }
  ceres::SphereManifold<3> sphere;
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.disable_all_safety_checks = true;
  ceres::Problem problem(ownership);
  for (Eigen::Index i = 0; i < S.rows(); ++i) {
    problem.AddParameterBlock(S.data() + 3 * i, 3, &sphere);
  }
  const auto add = [&](ceres::CostFunction& cost, std::size_t t) {
    const auto f = static_cast<Eigen::Index>(t);
    problem.AddResidualBlock(&cost, nullptr, S.data() + 3 * F(f, 0), S.data() + 3 * F(f, 1),
                             S.data() + 3 * F(f, 2));
  };
  for (std::size_t t = 0; t < costs.size(); ++t) add(costs[t], t);
  for (std::size_t t = 0; t < area_costs.size(); ++t) add(area_costs[t], t);
  for (const Eigen::Index pin : pins(S)) problem.SetParameterBlockConstant(S.data() + 3 * pin);

  Iterations iterations(settings);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  options.initial_trust_region_radius = kInitialRadius;
  options.max_trust_region_radius = 1e16;
  options.max_num_iterations = settings.max_iterations;
  options.max_num_consecutive_invalid_steps = 30;
  options.function_tolerance = 0.01 * settings.function_tolerance;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.num_threads = 1;  // sums of costs and gradients keep their order
  options.logging_type = ceres::SILENT;
  options.callbacks.push_back(&iterations);
  ceres::Solve(options, &problem, &outcome);
  return iterations.cancelled() ? Ending::cancelled
         : iterations.stuck()   ? Ending::stuck
                                : Ending::converged;
}

int iteration_count(const ceres::Solver::Summary& outcome) {
  // The first entry is the evaluation of the start.
  return std::max(0, static_cast<int>(outcome.iterations.size()) - 1);
}

}  // namespace

bool minimise(const ConstPoints& V, const ConstTriangles& F, const Twins& twins,
              const MinimiseSettings& settings, Points& S, MinimisationSummary& summary) {
  const std::vector<RestShape> shapes = unit_shapes(V, F);
  const Points start = S;
  summary.used = true;
  summary.initial_cost = summary.final_cost = cost(shapes, F, settings, S);
  Ending ending = Ending::converged;
  const auto minimised = [&](const std::vector<double>& epsilon) {
    ceres::Solver::Summary outcome;
    MinimiseSettings left = settings;
    left.max_iterations = std::max(1, settings.max_iterations - summary.iterations);
    ending = run(shapes, epsilon, F, left, S, outcome);
    summary.iterations += iteration_count(outcome);
    summary.termination = ceres::TerminationTypeToString(outcome.termination_type);
    summary.message = outcome.message;
    return ending != Ending::cancelled;
  };
  constexpr double kSmall = 0.05, kLarge = 0.5;
  if (!minimised(smoothing(kSmall, shapes, F, S))) return false;
  if (ending == Ending::stuck) {
    if (!minimised(smoothing(kLarge, shapes, F, S))) return false;
    if (!minimised(smoothing(kSmall, shapes, F, S))) return false;
  }
  if (flipped_count(F, S) > 0) {
    if (untangle(V, F, twins, S).left > 0) S = start;
    if (!minimised({})) return false;
  }
  const double final_cost = cost(shapes, F, settings, S);
  if (final_cost < summary.initial_cost) {
    summary.final_cost = final_cost;
  } else {
    S = start;
  }
  return true;
}

}  // namespace shape3d::mapping
