#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

/// Random integer samples with a given share of zeros. The generator is used without the standard
/// distributions, which differ between implementations.
namespace shape3d::test {

/// nx * ny * nz samples: zero with probability zero_percent / 100, otherwise -m or +m with m
/// uniform in 1 ... magnitude.
[[nodiscard]] inline std::vector<int> random_samples(const std::array<std::int64_t, 3>& dims,
                                                     int magnitude, int zero_percent,
                                                     std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<int> result(dims[0] * dims[1] * dims[2]);
  for (int& sample : result) {
    if (static_cast<int>(random() % 100) < zero_percent) continue;
    const int m = 1 + static_cast<int>(random() % static_cast<std::uint64_t>(magnitude));
    sample = random() % 2 == 0 ? m : -m;
  }
  return result;
}

}  // namespace shape3d::test
