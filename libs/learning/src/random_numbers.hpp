#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace shape3d::learning::detail {

/// Random numbers that are the same on every platform: std::mt19937_64 is fixed by the standard,
/// its distributions are not, so the mappings are here.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1), 53 bits.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

  /// Uniform in 0 … bound − 1, without bias: values above the last whole multiple are thrown away.
  std::uint64_t below(std::uint64_t bound) {
    const std::uint64_t rest = (std::uint64_t{0} - bound) % bound;  // 2⁶⁴ mod bound
    std::uint64_t bits = engine_();
    while (bits < rest) bits = engine_();
    return bits % bound;
  }

  /// Of the standard normal distribution, by Box and Muller.
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
  }

  /// Every order equally likely (Fisher, Yates).
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace shape3d::learning::detail
