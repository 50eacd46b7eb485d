#include "statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Dense>

namespace shape3d::bench {
namespace {

double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const std::size_t below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75)};
}

std::vector<double> pairwise_ratios(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios(std::min(a.size(), b.size()));
  for (std::size_t i = 0; i < ratios.size(); ++i) ratios[i] = a[i] / b[i];
  return ratios;
}

Plane fit_plane(const std::vector<double>& x, const std::vector<double>& y,
                const std::vector<double>& t) {
  Eigen::MatrixX2d rows(static_cast<Eigen::Index>(t.size()), 2);
  for (std::size_t i = 0; i < t.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) << x[i] / t[i], y[i] / t[i];
  }
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(rows.rows());
  const Eigen::Vector2d ab = rows.colPivHouseholderQr().solve(ones);
  return {ab[0], ab[1], (rows * ab - ones).cwiseAbs().maxCoeff()};
}

double fit_exponent(const std::vector<double>& x, const std::vector<double>& t) {
  double mean_x = 0, mean_t = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]);
    mean_t += std::log(t[i]);
  }
  mean_x /= static_cast<double>(x.size());
  mean_t /= static_cast<double>(x.size());
  double xx = 0, xt = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double d = std::log(x[i]) - mean_x;
    xx += d * d;
    xt += d * (std::log(t[i]) - mean_t);
  }
  return xt / xx;
}

}  // namespace shape3d::bench
