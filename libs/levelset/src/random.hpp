#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace shape3d::levelset::detail {

/// Random numbers that are the same with every standard library, whose distributions are not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  double normal() {
    constexpr double kTwoPi = 6.283185307179586;
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(kTwoPi * uniform());
  }

  /// Number of successes among n trials of probability p. By inversion where few are expected on
  /// one side, else the normal approximation, rounded: its error is under that of 1/√(n p (1 − p))
  /// < 0.2 standard deviations in the third moment only.
  double binomial(double n, double p) {
    if (n <= 0.0 || p <= 0.0) return 0.0;
    if (p >= 1.0) return n;
    if (p > 0.5) return n - binomial(n, 1.0 - p);
    if (n * p > 30.0) {
      const double draw = n * p + std::sqrt(n * p * (1.0 - p)) * normal();
      return std::clamp(std::floor(draw + 0.5), 0.0, n);
    }
    const double odds = p / (1.0 - p);
    double probability = std::exp(n * std::log1p(-p));
    double remaining = uniform(), successes = 0.0;
    while (remaining > probability && successes < n) {
      remaining -= probability;
      probability *= odds * (n - successes) / (successes + 1.0);
      successes += 1.0;
    }
    return successes;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace shape3d::levelset::detail
