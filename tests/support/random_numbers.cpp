#include "support/random_numbers.hpp"

#include <cmath>

namespace shape3d::test {

double RandomNumbers::uniform() {
  // 53 bits, in the middle of their interval.
  return (static_cast<double>(generator_() >> 11) + 0.5) * 0x1p-53;
}

double RandomNumbers::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  while (true) {
    const double x = uniform(-1.0, 1.0), y = uniform(-1.0, 1.0), squared = x * x + y * y;
    if (squared >= 1.0 || squared == 0.0) continue;
    const double factor = std::sqrt(-2.0 * std::log(squared) / squared);
    spare_ = y * factor;
    has_spare_ = true;
    return x * factor;
  }
}

double RandomNumbers::rayleigh(double scale) {
  return scale * std::sqrt(-2.0 * std::log(uniform()));
}

std::int64_t RandomNumbers::poisson(double mean) {
  if (mean <= 0.0) return 0;
  if (mean < 10.0) {
    const double limit = std::exp(-mean);
    std::int64_t count = 0;
    for (double product = uniform(); product > limit; product *= uniform()) ++count;
    return count;
  }
  const double b = 0.931 + 2.53 * std::sqrt(mean), a = -0.059 + 0.02483 * b;
  const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4), v_r = 0.9277 - 3.6224 / (b - 2.0);
  while (true) {
    const double u = uniform() - 0.5, v = uniform(), us = 0.5 - std::abs(u);
    const double k = std::floor((2.0 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= v_r) return static_cast<std::int64_t>(k);
    if (k < 0.0 || (us < 0.013 && v > us)) continue;
    if (std::log(v * inverse_alpha / (a / (us * us) + b)) <=
        k * std::log(mean) - mean - std::lgamma(k + 1.0))
      return static_cast<std::int64_t>(k);
  }
}

}  // namespace shape3d::test
