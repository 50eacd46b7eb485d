#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace shape3d::zmc::detail {

/// The largest magnitude; stands for infinite ones.
inline constexpr double kHugeMagnitude = 0x1p1022;

/// |sample − isovalue|, positive whenever the two differ and never infinite.
inline double magnitude_between(double sample, double isovalue) {
  return std::min(std::abs(sample - isovalue), kHugeMagnitude);
}

/// Crossings keep this share of their edge away from its ends.
inline constexpr double kCrossingMargin = 0x1p-20;

/// Place of the crossing on a lattice edge between two samples on either side of the isovalue, as a
/// share of the edge from its lower end: linear interpolation, kept off both ends.
/// @tparam T  Type of the samples; only differences of doubles can overflow.
template <class T>
inline __attribute__((always_inline)) double crossing_parameter(double lower, double upper,
                                                                double isovalue) {
  double a = std::abs(lower - isovalue);
  double b = std::abs(upper - isovalue);
  if constexpr (std::is_same_v<T, double>) {
    const bool overflow = !(a + b <= std::numeric_limits<double>::max());
    a = overflow ? std::abs(0.25 * lower - 0.25 * isovalue) : a;
    b = overflow ? std::abs(0.25 * upper - 0.25 * isovalue) : b;
  }
  double t = a / (a + b);
  t = t < kCrossingMargin ? kCrossingMargin : t;
  return t > 1.0 - kCrossingMargin ? 1.0 - kCrossingMargin : t;
}

}  // namespace shape3d::zmc::detail
