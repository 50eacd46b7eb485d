// Segments a bright ball in noise and prints its volume. Fails unless it is right to 5 %.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <shape3d/levelset/segment.hpp>

int main() {
  constexpr int kSide = 40;
  std::vector<std::int16_t> samples;
  unsigned noise = 1;
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        noise = noise * 1664525u + 1013904223u;
        const double depth = 10.0 - std::hypot(x - 19.5, y - 19.5, z - 19.5);
        const double value = 500.0 * (1.0 + std::erf(depth)) + (noise >> 24) - 128.0;
        samples.push_back(static_cast<std::int16_t>(value));
      }
    }
  }
  const auto image = shape3d::levelset::make_view(samples.data(), {kSide, kSide, kSide});
  shape3d::levelset::SegmentOptions options;
  options.mixture.classes = 2;
  const auto result = shape3d::levelset::segment(image, options);
  const double exact = 4.0 / 3.0 * 3.14159265358979 * 1000.0;
  std::printf("volume = %.1f, exact = %.1f\n", result.volume, exact);
  return std::abs(result.volume - exact) < 0.05 * exact ? 0 : 1;
}
