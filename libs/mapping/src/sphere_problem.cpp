#include "sphere_problem.hpp"

#include <algorithm>
#include <memory>

namespace shape3d::mapping {
namespace {

ceres::Problem::Options ownership() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

}  // namespace

SphereProblem::SphereProblem(Points& S, const ConstTriangles& F)
    : S_(S), F_(F), problem_(ownership()) {
  for (Eigen::Index i = 0; i < S.rows(); ++i) {
    problem_.AddParameterBlock(S.data() + 3 * i, 3, &sphere_);
  }
}

void SphereProblem::add(ceres::CostFunction& cost, ceres::LossFunction* loss, std::size_t t) {
  const auto f = static_cast<Eigen::Index>(t);
  problem_.AddResidualBlock(&cost, loss, S_.data() + 3 * F_(f, 0), S_.data() + 3 * F_(f, 1),
                            S_.data() + 3 * F_(f, 2));
}

void SphereProblem::hold(Eigen::Index vertex) {
  problem_.SetParameterBlockConstant(S_.data() + 3 * vertex);
}

ceres::Solver::Summary SphereProblem::solve(const MinimiseSettings& settings,
                                            Iterations& iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  // Groups of one: Ceres orders inside of groups only.
  auto order = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t k = 0; k < settings.order.size(); ++k) {
    order->AddElementToGroup(S_.data() + 3 * settings.order[k], static_cast<int>(k));
  }
  options.linear_solver_ordering = std::move(order);
  options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  options.initial_trust_region_radius = kInitialRadius;
  options.max_trust_region_radius = settings.largest_radius;
  options.max_num_iterations = settings.max_iterations;
  options.max_num_consecutive_invalid_steps = 30;
  options.function_tolerance = 0.01 * settings.function_tolerance;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.num_threads = 1;  // sums of costs and gradients keep their order
  options.logging_type = ceres::SILENT;
  options.callbacks.push_back(&iterations);
  ceres::Solver::Summary outcome;
  ceres::Solve(options, &problem_, &outcome);
  return outcome;
}

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

int iteration_count(const ceres::Solver::Summary& outcome) {
  // The first entry is the evaluation of the start.
  return std::max(0, static_cast<int>(outcome.iterations.size()) - 1);
}

}  // namespace shape3d::mapping
