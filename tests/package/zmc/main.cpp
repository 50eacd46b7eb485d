// Extracts a sphere and prints its size. Fails unless it is closed and of genus 0: V - F/2 = 2.
#include <cstdint>
#include <cstdio>
#include <vector>

#include <shape3d/zmc/extract.hpp>

int main() {
  constexpr int kSide = 17;
  std::vector<float> samples;
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const int dx = x - 8, dy = y - 8, dz = z - 8;
        samples.push_back(static_cast<float>(dx * dx + dy * dy + dz * dz));
      }
    }
  }
  const auto view = shape3d::zmc::make_view(samples.data(), {kSide, kSide, kSide});
  const auto surface = shape3d::zmc::extract(view, 30.5);
  const std::int64_t vertices = surface.V().rows(), triangles = surface.F().rows();
  std::printf("V = %lld, F = %lld\n", static_cast<long long>(vertices),
              static_cast<long long>(triangles));
  return triangles > 0 && 2 * vertices - triangles == 4 ? 0 : 1;
}
