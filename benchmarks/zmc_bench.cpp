// Time of zmc::extract by size, kind of volume and number of threads. The volume is made, and the
// storage of the surface grown, outside the timed loop.
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>
#include <shape3d/zmc/extract.hpp>

namespace {
using namespace shape3d::zmc;

struct Volume {
  std::vector<std::int16_t> samples;
  std::array<std::int64_t, 3> dims;
};

template <class Field>
Volume sampled(const std::array<std::int64_t, 3>& dims, Field&& field) {
  Volume volume{{}, dims};
  volume.samples.reserve(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]));
  for (std::int64_t z = 0; z < dims[2]; ++z) {
    for (std::int64_t y = 0; y < dims[1]; ++y) {
      for (std::int64_t x = 0; x < dims[0]; ++x) {
        volume.samples.push_back(static_cast<std::int16_t>(field(x, y, z)));
      }
    }
  }
  return volume;
}

std::array<std::int64_t, 3> cube(std::int64_t side) { return {side, side, side}; }

/// Few cells have a patch: the time is that of looking at the samples.
Volume sphere(std::int64_t side) {
  const double centre = 0.5 * static_cast<double>(side - 1);
  return sampled(cube(side), [=](auto x, auto y, auto z) {
    return 1000.0 / centre *
           std::hypot(static_cast<double>(x) - centre, static_cast<double>(y) - centre,
                      static_cast<double>(z) - centre);
  });
}

/// A periodic surface, curved everywhere, and its period in samples.
struct Gyroid {
  double period;
  double operator()(std::int64_t x, std::int64_t y, std::int64_t z) const;
};

double Gyroid::operator()(std::int64_t x, std::int64_t y, std::int64_t z) const {
  const double step = 2 * std::acos(-1.0) / period;
  const double a = step * static_cast<double>(x), b = step * static_cast<double>(y),
               c = step * static_cast<double>(z);
  return 1000 +
         400 * (std::sin(a) * std::cos(b) + std::sin(b) * std::cos(c) + std::sin(c) * std::cos(a));
}

void run(benchmark::State& state, const Volume& volume, double isovalue, int threads) {
  const VolumeView view = make_view(volume.samples.data(), volume.dims);
  Options options;
  options.threads = threads;
  Surface<float, std::int32_t> surface;
  for (auto _ : state) {  // NOLINT(clang-analyzer-deadcode.DeadStores): the library's loop
    benchmark::DoNotOptimize(extract(view, isovalue, options, surface));
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(volume.samples.size()));
  state.SetComplexityN(static_cast<std::int64_t>(volume.samples.size()));
  state.counters["triangles"] = static_cast<double>(surface.triangle_count());
}

void extract_sphere(benchmark::State& state) {
  run(state, sphere(state.range(0)), 700.0, static_cast<int>(state.range(1)));
}

void extract_gyroid(benchmark::State& state) {
  run(state, sampled(cube(state.range(0)), Gyroid{16}), 1000.0, static_cast<int>(state.range(1)));
}

/// Samples drawn from {-1, 0, 1}: a patch in almost every cell, and zero vertices, edges and faces.
void extract_random(benchmark::State& state) {
  std::mt19937 random(1);
  const Volume volume = sampled(
      cube(state.range(0)), [&](auto, auto, auto) { return static_cast<int>(random() % 3) - 1; });
  run(state, volume, 0.0, static_cast<int>(state.range(1)));
}

/// The size of a clinical CT, and about as many triangles as one has at bone.
void extract_ct_size(benchmark::State& state) {
  run(state, sampled({512, 512, 150}, Gyroid{64}), 1000.0, static_cast<int>(state.range(0)));
}

BENCHMARK(extract_sphere)
    ->ArgNames({"side", "threads"})
    ->ArgsProduct({{64, 128, 256}, {1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Complexity(benchmark::oN);
BENCHMARK(extract_gyroid)
    ->ArgNames({"side", "threads"})
    ->ArgsProduct({{64, 128, 256}, {1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Complexity(benchmark::oN);
BENCHMARK(extract_gyroid)
    ->Name("extract_gyroid_parallel")
    ->ArgNames({"side", "threads"})
    ->ArgsProduct({{256}, {2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(extract_random)
    ->ArgNames({"side", "threads"})
    ->ArgsProduct({{32, 64, 128}, {1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Complexity(benchmark::oN);
BENCHMARK(extract_ct_size)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
}  // namespace
