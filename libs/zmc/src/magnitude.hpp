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

/// Place of the crossing on a lattice edge, as a share of the edge from its lower end: linear
/// interpolation, kept 2⁻²⁰ away from both ends.
inline double crossing_parameter(double lower_magnitude, double upper_magnitude) {
  constexpr double kMargin = 0x1p-20;
  return std::clamp(lower_magnitude / (lower_magnitude + upper_magnitude), kMargin, 1.0 - kMargin);
}

}  // namespace shape3d::zmc::detail
