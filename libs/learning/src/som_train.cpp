#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "checks.hpp"
#include "parallel.hpp"
#include "principal_axes.hpp"
#include "random_numbers.hpp"
#include "shape3d/learning/som.hpp"
#include "som_search.hpp"
#include "text.hpp"

namespace shape3d::learning {
namespace {

constexpr Eigen::Index kUnitBlock = 64;

void check_options(const SomOptions& options) {
  check_grid(options.grid);
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  detail::require_between("epochs", options.epochs, 1, 1000000);
  detail::require(options.sigma_first == 0.0 || positive(options.sigma_first), "sigma_first",
                  options.sigma_first, "0 for half the longer side, or a positive number");
  detail::require(positive(options.sigma_last), "sigma_last", options.sigma_last,
                  "a positive number");
  detail::require(options.alpha_first > 0.0 && options.alpha_first <= 1.0, "alpha_first",
                  options.alpha_first, "0 < alpha_first <= 1");
  detail::require(options.alpha_last > 0.0 && options.alpha_last <= 1.0, "alpha_last",
                  options.alpha_last, "0 < alpha_last <= 1");
}

// From first to last in geometric steps; t is 0 … 1.
double decay(double first, double last, double t) { return first * std::pow(last / first, t); }

// −1 … 1 along a side of n units; 0 when there is one.
double along(int i, int n) { return n == 1 ? 0.0 : 2.0 * i / (n - 1.0) - 1.0; }

Features start_on_plane(const Features& X, const SomGrid& grid) {
  const detail::PrincipalAxes principal = detail::principal_axes(X, 2);
  Features M(grid.units(), X.cols());
  for (int i = 0; i < grid.units(); ++i) {
    double u = along(i / grid.columns, grid.rows);
    double v = along(i % grid.columns, grid.columns);
    if (grid.columns > grid.rows) std::swap(u, v);  // the longer side along the first axis
    M.row(i) = principal.mean + u * principal.deviation(0) * principal.axes.row(0) +
               v * principal.deviation(1) * principal.axes.row(1);
  }
  return M;
}

Features start_at_random(const Features& X, const SomGrid& grid, detail::RandomNumbers& random) {
  const Eigen::RowVectorXd least = X.colwise().minCoeff();
  const Eigen::RowVectorXd width = X.colwise().maxCoeff() - least;
  Features M(grid.units(), X.cols());
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    for (Eigen::Index j = 0; j < M.cols(); ++j) M(i, j) = least(j) + random.uniform() * width(j);
  }
  return M;
}

// (4.15) for all pairs of units.
Eigen::MatrixXd neighbourhood(const Eigen::MatrixXd& distances, double sigma) {
  return (-distances.array().square() / (2.0 * sigma * sigma)).exp();
}

// Sums of the items of each unit, in their order, whatever the number of threads.
void sum_by_unit(const Features& X, const std::vector<int>& units, Features& sums,
                 Eigen::VectorXd& counts, int threads) {
  std::vector<std::size_t> begin(static_cast<std::size_t>(sums.rows()) + 1, 0);
  for (const int unit : units) ++begin[static_cast<std::size_t>(unit) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Eigen::Index> items(units.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < units.size(); ++i) {
    items[next[static_cast<std::size_t>(units[i])]++] = static_cast<Eigen::Index>(i);
  }
  sums.setZero();
  detail::parallel_blocks(sums.rows(), 1, threads, [&](std::int64_t u, std::int64_t) {
    const auto unit = static_cast<std::size_t>(u);
    counts(u) = static_cast<double>(begin[unit + 1] - begin[unit]);
    for (std::size_t i = begin[unit]; i < begin[unit + 1]; ++i) sums.row(u) += X.row(items[i]);
  });
}

void batch_epoch(const Features& X, const Eigen::MatrixXd& h, Features& M, int threads) {
  const std::vector<int> units = detail::search_units(M, X, false, threads).first;
  Features sums(M.rows(), M.cols());
  Eigen::VectorXd counts(M.rows());
  sum_by_unit(X, units, sums, counts, threads);
  detail::parallel_blocks(M.rows(), kUnitBlock, threads, [&](std::int64_t a, std::int64_t b) {
    const auto part = h.middleRows(a, b - a);
    const Features moved = part * sums;
    const Eigen::VectorXd weight = part * counts;
    for (Eigen::Index i = a; i < b; ++i) {
      if (weight(i - a) < std::numeric_limits<double>::min()) continue;  // nothing reaches it
      M.row(i) = moved.row(i - a) / weight(i - a);
    }
  });
}

// One item moves all prototypes, (4.13) to (4.15).
void show(const Eigen::RowVectorXd& x, const Eigen::MatrixXd& squares, double sigma, double alpha,
          Features& M) {
  Eigen::Index best = 0;
  (M.rowwise() - x).rowwise().squaredNorm().minCoeff(&best);
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    const double h = std::exp(-squares(best, i) / (2.0 * sigma * sigma));
    M.row(i) += (alpha * h) * (x - M.row(i));
  }
}

}  // namespace

Som train_som(const FeaturesView& items, const SomOptions& options, int threads) {
  detail::require_features(items);
  check_options(options);
  threads = detail::resolve_threads(threads);
  Som som;
  som.grid = options.grid;
  som.scaling = fit_scaling(items, options.scaling);
  const Features X = som.scaling.apply(items);
  detail::RandomNumbers random(options.seed);
  Features& M = som.prototypes;
  M = options.start == SomStart::pca ? start_on_plane(X, som.grid)
                                     : start_at_random(X, som.grid, random);
  const double longer = std::max(som.grid.rows, som.grid.columns);
  const double sigma_first =
      options.sigma_first > 0.0 ? options.sigma_first : std::max(1.0, 0.5 * longer);
  const Eigen::MatrixXd distances = som_distances(som.grid);
  const Eigen::MatrixXd squares = distances.cwiseAbs2();

  std::vector<Eigen::Index> order(static_cast<std::size_t>(X.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const double steps = static_cast<double>(options.epochs) * static_cast<double>(X.rows());
  double step = 0.0;
  for (int epoch = 0; epoch < options.epochs; ++epoch) {
    if (options.training == SomTraining::batch) {
      const double t = options.epochs == 1 ? 0.0 : epoch / (options.epochs - 1.0);
      batch_epoch(X, neighbourhood(distances, decay(sigma_first, options.sigma_last, t)), M,
                  threads);
    } else {
      random.shuffle(order);
      for (const Eigen::Index i : order) {
        const double t = steps == 1.0 ? 0.0 : step / (steps - 1.0);
        show(X.row(i), squares, decay(sigma_first, options.sigma_last, t),
             decay(options.alpha_first, options.alpha_last, t), M);
        step += 1.0;
      }
    }
    if (options.progress && !options.progress((epoch + 1.0) / options.epochs)) {
      som.cancelled = epoch + 1 < options.epochs;
      break;
    }
  }
  return som;
}

Features Som::unscaled_prototypes() const { return scaling.undo(prototypes); }

}  // namespace shape3d::learning
