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
#include "sphere_problem.hpp"
#include "untangle.hpp"

namespace shape3d::mapping {
namespace {

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
  SphereProblem problem(S, F);
  for (std::size_t t = 0; t < costs.size(); ++t) problem.add(costs[t], nullptr, t);
  for (std::size_t t = 0; t < area_costs.size(); ++t) problem.add(area_costs[t], nullptr, t);
  for (const Eigen::Index pin : pins(S)) problem.hold(pin);

  Iterations iterations(settings);
  outcome = problem.solve(settings, iterations);
  return iterations.cancelled() ? Ending::cancelled
         : iterations.stuck()   ? Ending::stuck
                                : Ending::converged;
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
