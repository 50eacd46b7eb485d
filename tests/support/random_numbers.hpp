#pragma once

#include <cstdint>
#include <random>

namespace shape3d::test {

inline constexpr double kPi = 3.14159265358979323846;

/// Seeded numbers of the common distributions. The generator is used without the standard
/// distributions, which differ between implementations.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : generator_(seed) {}

  /// 0 < u < 1.
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Mean 0, variance 1; the polar method of Marsaglia.
  double normal();
  /// Density x/c² exp(−x²/2c²).
  double rayleigh(double scale);
  /// By products of uniform numbers below a mean of 10 (Knuth), by transformed rejection above
  /// (W. Hörmann, "The transformed rejection method for generating Poisson random variables",
  /// Insurance: Mathematics and Economics 12 (1993), algorithm PTRS).
  std::int64_t poisson(double mean);

 private:
  std::mt19937_64 generator_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace shape3d::test
