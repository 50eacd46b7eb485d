#pragma once

#include <algorithm>
#include <cmath>

namespace shape3d::zmc::detail {

/// Stands for an infinite |sample − isovalue|: a quarter of the largest double, so that sums of two
/// stay finite.
inline constexpr double kHugeMagnitude = 0x1p1022;

/// |sample − isovalue|, positive whenever the two differ and never infinite.
inline double magnitude_between(double sample, double isovalue) {
  return std::min(std::abs(sample - isovalue), kHugeMagnitude);
}

/// Crossings keep this share of their edge away from its ends.
inline constexpr double kCrossingMargin = 0x1p-20;

/// Place of the crossing on a lattice edge, as a share of the edge from its lower end: linear
/// interpolation, kept off both ends.
inline double crossing_parameter(double lower_magnitude, double upper_magnitude) {
  return std::clamp(lower_magnitude / (lower_magnitude + upper_magnitude), kCrossingMargin,
                    1.0 - kCrossingMargin);
}

}  // namespace shape3d::zmc::detail
