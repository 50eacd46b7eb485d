#pragma once

#include <array>
#include <vector>

namespace shape3d::bench {

/// Middle and middle half of a series.
struct Spread {
  double median = 0.0, lower = 0.0, upper = 0.0;  ///< Lower and upper quartile.
};

/// Quantiles by linear interpolation between order statistics.
/// @param values  At least one.
[[nodiscard]] Spread spread(std::vector<double> values);

/// a[i] / b[i] over the entries that both have.
[[nodiscard]] std::vector<double> pairwise_ratios(const std::vector<double>& a,
                                                  const std::vector<double>& b);

/// Time as a·x + b·y.
struct Plane {
  double a = 0.0, b = 0.0;
  double largest_error = 0.0;  ///< max |a·x + b·y − t| / t.
};

/// Least squares of the relative residual (a·x + b·y − t) / t.
/// @param x, y, t  Of equal length, at least 2; t positive.
[[nodiscard]] Plane fit_plane(const std::vector<double>& x, const std::vector<double>& y,
                              const std::vector<double>& t);

/// Exponent e of t ∝ x^e: least squares of log t over log x.
[[nodiscard]] double fit_exponent(const std::vector<double>& x, const std::vector<double>& t);

}  // namespace shape3d::bench
