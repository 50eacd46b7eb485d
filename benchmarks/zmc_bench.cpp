// Time of zmc::extract by size, kind of volume, number of threads and reuse of memory. The volume
// is made outside the timed loop. "reused" 0: surface and working memory are allocated within it;
// 1: those of the extraction before are filled again.
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <shape3d/zmc/extractor.hpp>

#include "ct_volume.hpp"

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

void run(benchmark::State& state, const Volume& volume, double isovalue, int threads, bool reused,
         Triangulation triangulation = Triangulation::compact) {
  const VolumeView view = make_view(volume.samples.data(), volume.dims);
  Options options;
  options.threads = threads;
  options.triangulation = triangulation;
  std::int64_t triangles = 0;
  Extractor extractor;
  Surface<float, std::int32_t> kept;
  if (reused) extractor.extract(view, isovalue, options, kept);
  for (auto _ : state) {  // NOLINT(clang-analyzer-deadcode.DeadStores): the library's loop
    if (reused) {
      benchmark::DoNotOptimize(extractor.extract(view, isovalue, options, kept));
      triangles = kept.triangle_count();
    } else {
      Surface<float, std::int32_t> surface;
      benchmark::DoNotOptimize(extract(view, isovalue, options, surface));
      triangles = surface.triangle_count();
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(volume.samples.size()));
  state.SetComplexityN(static_cast<std::int64_t>(volume.samples.size()));
  state.counters["triangles"] = static_cast<double>(triangles);
  state.counters["triangles/s"] = benchmark::Counter(
      static_cast<double>(triangles * state.iterations()), benchmark::Counter::kIsRate);
}

int threads_of(const benchmark::State& state) { return static_cast<int>(state.range(1)); }
bool reused_of(const benchmark::State& state) { return state.range(2) != 0; }

void extract_sphere(benchmark::State& state) {
  run(state, sphere(state.range(0)), 700.0, threads_of(state), reused_of(state));
}

void extract_gyroid(benchmark::State& state) {
  run(state, sampled(cube(state.range(0)), Gyroid{16}), 1000.0, threads_of(state),
      reused_of(state));
}

/// Samples drawn from {-1, 0, 1}: a patch in almost every cell, and zero vertices, edges and faces.
void extract_random(benchmark::State& state) {
  std::mt19937 random(1);
  const Volume volume = sampled(
      cube(state.range(0)), [&](auto, auto, auto) { return static_cast<int>(random() % 3) - 1; });
  run(state, volume, 0.0, threads_of(state), reused_of(state));
}

/// A size of Table 3.1, numbered from 0. The last one made is kept for the next benchmark.
const Volume& ct_volume(std::int64_t number) {
  static std::map<std::int64_t, Volume> last;
  if (last.count(number) == 0) {
    const shape3d::bench::CtSize& size = shape3d::bench::kCtSizes[static_cast<std::size_t>(number)];
    last.clear();
    last[number] = {shape3d::bench::make_ct_volume(size.dims, size.wavelength), size.dims};
  }
  return last[number];
}

void extract_ct(benchmark::State& state) {
  state.SetLabel(
      std::string(shape3d::bench::kCtSizes[static_cast<std::size_t>(state.range(0))].name));
  run(state, ct_volume(state.range(0)), shape3d::bench::kCtIsovalue, threads_of(state),
      reused_of(state));
}

void extract_ct_centroid(benchmark::State& state) {
  state.SetLabel(
      std::string(shape3d::bench::kCtSizes[static_cast<std::size_t>(state.range(0))].name));
  run(state, ct_volume(state.range(0)), shape3d::bench::kCtIsovalue, threads_of(state),
      reused_of(state), Triangulation::centroid);
}

void by_side(benchmark::internal::Benchmark* benchmark, std::vector<std::int64_t> sides) {
  benchmark->ArgNames({"side", "threads", "reused"})
      ->ArgsProduct({std::move(sides), {1, 2}, {0, 1}})
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}
void large(benchmark::internal::Benchmark* benchmark) { by_side(benchmark, {64, 128, 256}); }
void small(benchmark::internal::Benchmark* benchmark) { by_side(benchmark, {32, 64, 128}); }
void by_size(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"size", "threads", "reused"})
      ->ArgsProduct({{0, 1, 2, 3, 4}, {1, 2}, {0, 1}})
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}

/// One thread, fresh, over sizes: the order of growth is fitted.
void growth(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"side", "threads", "reused"})
      ->ArgsProduct({{32, 64, 128, 256}, {1}, {0}})
      ->Unit(benchmark::kMillisecond)
      ->Complexity(benchmark::oN);
}

BENCHMARK(extract_sphere)->Apply(large);
BENCHMARK(extract_gyroid)->Apply(large);
BENCHMARK(extract_gyroid)->Name("extract_gyroid_growth")->Apply(growth);
BENCHMARK(extract_random)->Apply(small);
BENCHMARK(extract_ct)->Apply(by_size);
BENCHMARK(extract_ct_centroid)->Apply(by_size);
}  // namespace
