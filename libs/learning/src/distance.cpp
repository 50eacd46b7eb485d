#include "shape3d/learning/distance.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "parallel.hpp"

namespace shape3d::learning {
namespace {

constexpr std::array<std::pair<Distance, std::string_view>, 5> kNames{
    {{Distance::L1, "L1"},
     {Distance::L2, "L2"},
     {Distance::L2_squared, "L2_squared"},
     {Distance::chi_squared, "chi_squared"},
     {Distance::cosine, "cosine"}}};

template <class X, class Y>
double chi_squared(const X& x, const Y& y) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double size = std::abs(x[i]) + std::abs(y[i]), difference = x[i] - y[i];
    if (size > 0.0) sum += difference * (difference / size);
  }
  return sum;
}

template <class X, class Y>
double cosine(const X& x, const Y& y) {
  const double a = x.stableNorm(), b = y.stableNorm();
  if (a == 0.0 || b == 0.0) return a == b ? 0.0 : 1.0;
  const double product = (x / a).dot(y / b);
  return 1.0 - std::min(1.0, std::max(-1.0, product));
}

template <class X, class Y>
double of_two(const X& x, const Y& y, Distance kind) {
  switch (kind) {
    case Distance::L1:
      return (x - y).template lpNorm<1>();
    case Distance::L2:
      return (x - y).norm();
    case Distance::L2_squared:
      return (x - y).squaredNorm();
    case Distance::chi_squared:
      return chi_squared(x, y);
    case Distance::cosine:
      return cosine(x, y);
  }
  throw std::invalid_argument("distance is " + std::to_string(static_cast<int>(kind)) +
                              ", expected " + std::string(kDistanceNames));
}

void require_finite(const char* name, const FeaturesView& X) {
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    if (!X.row(i).allFinite()) {
      throw std::invalid_argument("row " + std::to_string(i) + " of " + name +
                                  " has a number that is not finite, expected finite ones");
    }
  }
}

}  // namespace

std::string_view to_string(Distance distance) {
  for (const auto& [kind, name] : kNames) {
    if (kind == distance) return name;
  }
  return "unknown";
}

std::optional<Distance> distance_named(std::string_view name) {
  for (const auto& [kind, text] : kNames) {
    if (text == name) return kind;
  }
  return std::nullopt;
}

double distance(const Eigen::Ref<const Eigen::VectorXd>& x,
                const Eigen::Ref<const Eigen::VectorXd>& y, Distance kind) {
  if (x.size() != y.size()) {
    throw std::invalid_argument("y has " + std::to_string(y.size()) + " numbers, expected " +
                                std::to_string(x.size()) + " as x has");
  }
  return of_two(x, y, kind);
}

Eigen::MatrixXd distances(const FeaturesView& X, const FeaturesView& Y, Distance kind,
                          int threads) {
  if (X.cols() != Y.cols()) {
    throw std::invalid_argument("Y has " + std::to_string(Y.cols()) + " columns, expected " +
                                std::to_string(X.cols()) + " as X has");
  }
  require_finite("X", X);
  require_finite("Y", Y);
  Eigen::MatrixXd D(X.rows(), Y.rows());
  detail::parallel_blocks(Y.rows(), 8, detail::resolve_threads(threads),
                          [&](std::int64_t first, std::int64_t last) {
                            for (std::int64_t j = first; j < last; ++j) {
                              for (Eigen::Index i = 0; i < X.rows(); ++i)
                                D(i, j) = of_two(X.row(i), Y.row(j), kind);
                            }
                          });
  return D;
}

}  // namespace shape3d::learning
