#include "som_search.hpp"

#include <cmath>
#include <limits>

#include "checks.hpp"
#include "parallel.hpp"

namespace shape3d::learning {
namespace detail {
namespace {

// Items of a matrix product; which blocks there are does not depend on threads.
constexpr Eigen::Index kBlock = 128;

// The least value of a row and the next.
std::array<double, 2> two_least(const double* values, Eigen::Index count) {
  double least = std::numeric_limits<double>::infinity();
  double next = least;
  for (Eigen::Index u = 0; u < count; ++u) {
    next = std::min(next, std::max(least, values[u]));
    least = std::min(least, values[u]);
  }
  return {least, next};
}

}  // namespace

BestUnits search_units(const Features& prototypes, const Features& scaled, bool both, int threads) {
  const Eigen::Index n = scaled.rows();
  BestUnits best;
  best.first.resize(static_cast<std::size_t>(n));
  if (both) best.second.resize(static_cast<std::size_t>(n));
  best.distance.resize(n);

  // ‖x − M‖² − ‖x‖² = ‖M‖² − 2 x·M by a matrix product. Its rounding error is below
  // (d + 3) ε (‖x‖ + ‖M‖)² on either side, so the nearest unit by the plain sum is among those that
  // are within four times that of the least.
  const Eigen::VectorXd squares = prototypes.rowwise().squaredNorm();
  const double largest = std::sqrt(squares.maxCoeff());
  const double unit =
      4.0 * static_cast<double>(prototypes.cols() + 3) * std::numeric_limits<double>::epsilon();
  parallel_blocks(n, kBlock, threads, [&](std::int64_t first, std::int64_t last) {
    const auto items = scaled.middleRows(first, last - first);
    Features scores = -2.0 * items * prototypes.transpose();
    scores.rowwise() += squares.transpose();
    for (Eigen::Index i = first; i < last; ++i) {
      const auto row = scores.row(i - first);
      const auto [least, next] = two_least(row.data(), row.size());
      const double reach = scaled.row(i).norm() + largest;
      const double limit = (both ? next : least) + unit * reach * reach;
      std::array<double, 2> distance{std::numeric_limits<double>::infinity(),
                                     std::numeric_limits<double>::infinity()};
      std::array<int, 2> found{0, 0};
      for (Eigen::Index u = 0; u < row.size(); ++u) {
        if (row(u) > limit) continue;
        const double exact = (scaled.row(i) - prototypes.row(u)).squaredNorm();
        if (exact < distance[0]) {
          distance[1] = distance[0];
          found[1] = found[0];
          distance[0] = exact;
          found[0] = static_cast<int>(u);
        } else if (exact < distance[1]) {
          distance[1] = exact;
          found[1] = static_cast<int>(u);
        }
      }
      best.first[static_cast<std::size_t>(i)] = found[0];
      if (both) best.second[static_cast<std::size_t>(i)] = found[1];
      best.distance(i) = std::sqrt(distance[0]);
    }
  });
  return best;
}

}  // namespace detail

BestUnits best_units(const Som& som, const FeaturesView& X, int threads) {
  return detail::search_units(som.prototypes, som.scaling.apply(X), true,
                              detail::resolve_threads(threads));
}

}  // namespace shape3d::learning
