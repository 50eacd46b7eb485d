// Prints the time and the memory that zmc::extract takes for a volume of the size of a clinical CT,
// at one thread.
//
//   shape3d_zmc_cost [float|double]
//
// Memory is the growth of the peak resident set (ru_maxrss) by the first extraction.

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <shape3d/zmc/extract.hpp>

namespace {
using namespace shape3d::zmc;

constexpr std::array<std::int64_t, 3> kDims{512, 512, 150};

/// 400 (sin x cos y + sin y cos z + sin z cos x), a gyroid of period 64, and noise of ±24.
std::vector<std::int16_t> make_samples() {
  const double step = 2 * std::acos(-1.0) / 64;
  std::vector<std::int16_t> samples;
  samples.reserve(static_cast<std::size_t>(kDims[0] * kDims[1] * kDims[2]));
  std::mt19937 random(1);
  for (std::int64_t k = 0; k < kDims[2]; ++k) {
    const double c = step * static_cast<double>(k);
    for (std::int64_t j = 0; j < kDims[1]; ++j) {
      const double b = step * static_cast<double>(j);
      for (std::int64_t i = 0; i < kDims[0]; ++i) {
        const double a = step * static_cast<double>(i);
        const double smooth = 400 * (std::sin(a) * std::cos(b) + std::sin(b) * std::cos(c) +
                                     std::sin(c) * std::cos(a));
        samples.push_back(
            static_cast<std::int16_t>(std::lround(smooth) + static_cast<long>(random() % 49) - 24));
      }
    }
  }
  return samples;
}

std::int64_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{1024} * usage.ru_maxrss;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <class Real>
int run(const char* name) {
  const std::vector<std::int16_t> samples = make_samples();
  const VolumeView view = make_view(samples.data(), kDims);
  Options options;
  options.threads = 1;
  constexpr double kMiB = 1 << 20;
  const auto voxels = static_cast<double>(samples.size());
  const std::int64_t before = peak_bytes();
  std::int64_t after = 0, triangles = 0;
  double output = 0.0;
  const auto timed = [&](Surface<Real, std::int32_t>& surface) {
    const auto start = std::chrono::steady_clock::now();
    const Status status = extract(view, 0.0, options, surface);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    if (status != Status::ok) throw std::runtime_error(std::string(to_string(status)));
    return passed.count();
  };
  std::vector<double> fresh, reused;
  for (int i = 0; i < 5; ++i) {
    Surface<Real, std::int32_t> surface;
    fresh.push_back(timed(surface));
    if (i > 0) continue;
    after = peak_bytes();
    triangles = surface.triangle_count();
    output = static_cast<double>(sizeof(Real) * surface.positions.size() +
                                 sizeof(std::int32_t) * surface.indices.size());
  }
  Surface<Real, std::int32_t> kept;
  timed(kept);
  for (int i = 0; i < 5; ++i) reused.push_back(timed(kept));
  const double taken = static_cast<double>(after - before);
  std::printf("volume               512 x 512 x 150 int16, %.1f MiB\n", 2 * voxels / kMiB);
  std::printf("surface              %lld triangles, %s positions, %.1f MiB\n",
              static_cast<long long>(triangles), name, output / kMiB);
  std::printf("seconds, 1 thread    %.3f (median of 5), %.3f into a surface used before\n",
              median(fresh), median(reused));
  std::printf("peak beyond input    %.1f MiB = output + %.2f bytes a voxel\n", taken / kMiB,
              (taken - output) / voxels);
  std::printf("allowed              %.1f MiB = output + 2 bytes a voxel\n",
              (output + 2 * voxels) / kMiB);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view real = argc > 1 ? argv[1] : "double";
  try {
    if (argc <= 2 && real == "float") return run<float>("float");
    if (argc <= 2 && real == "double") return run<double>("double");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  std::fputs("usage: shape3d_zmc_cost [float|double]\n", stderr);
  return 2;
}
