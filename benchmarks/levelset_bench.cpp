// Time of the segmentation by stage, on the phantom of a chest CT (290 × 380 × 62) and, when
// SHAPE3D_DATA is set, on the region x 110:400, y 120:500 of the CT that is as large. Volumes are
// made and read outside the timed loop. Beside it what the memory can do: the rate of a copy.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <shape3d/levelset/segment.hpp>

#include "support/lung_phantom.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::levelset;

struct Scene {
  std::vector<std::int16_t> samples;
  ImageView roi;
  std::string missing;  ///< Why there is nothing to measure.
};

Scene phantom() {
  test::LungPhantomOptions options;  // Gaussian noise of 25 HU
  Scene scene;
  test::LungPhantom made = test::make_lung_phantom(options);
  scene.samples = std::move(made.samples);
  scene.roi = make_view(scene.samples.data(), made.dims, made.spacing);
  return scene;
}

Scene real() {
  Scene scene;
  const char* folder = std::getenv("SHAPE3D_DATA");
  if (folder == nullptr) {
    scene.missing = "SHAPE3D_DATA is not set";
    return scene;
  }
  const std::string path = std::string(folder) + "/table31/T3_512x512x62_lungpetctdx-A0001.raw";
  scene.samples.resize(std::size_t{512} * 512 * 62);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(scene.samples.data()),
            static_cast<std::streamsize>(scene.samples.size() * sizeof(std::int16_t)));
  if (!file) {
    scene.missing = path + " cannot be read";
    return scene;
  }
  const ImageView whole =
      make_view(scene.samples.data(), {512, 512, 62}, {0.841796875, 0.841796875, 5.0});
  scene.roi = subvolume(whole, {{110, 120, 0}, {400, 500, 62}});
  return scene;
}

const Scene* scene_of(benchmark::State& state, bool is_real) {
  static std::map<bool, Scene> scenes;
  auto place = scenes.find(is_real);
  if (place == scenes.end()) place = scenes.emplace(is_real, is_real ? real() : phantom()).first;
  if (!place->second.missing.empty()) {
    state.SkipWithError(place->second.missing.c_str());
    return nullptr;
  }
  return &place->second;
}

void run(benchmark::State& state, bool is_real, const SegmentOptions& options, bool evolution) {
  const Scene* scene = scene_of(state, is_real);
  if (scene == nullptr) return;
  SegmentTimings sum;
  double iterations = 0.0, nodes = 0.0;
  for (auto _ : state) {
    const Segmentation s = segment(scene->roi, options);
    state.SetIterationTime(evolution ? s.timings.evolution : s.timings.estimation());
    sum.histogram += s.timings.histogram;
    sum.mixture += s.timings.mixture;
    sum.gradient += s.timings.gradient;
    sum.calibration += s.timings.calibration;
    sum.speed += s.timings.speed;
    iterations = static_cast<double>(s.evolution.iterations.size());
    nodes = 0.0;
    for (const FrontStatistics& at : s.evolution.iterations)
      nodes += static_cast<double>(at.computed_nodes);
  }
  using benchmark::Counter;
  if (evolution) {
    state.counters["iterations"] = Counter(iterations);
    state.counters["nodes"] = Counter(nodes);
    return;
  }
  state.counters["histogram"] = Counter(sum.histogram, Counter::kAvgIterations);
  state.counters["mixture"] = Counter(sum.mixture, Counter::kAvgIterations);
  state.counters["gradient"] = Counter(sum.gradient, Counter::kAvgIterations);
  state.counters["calibration"] = Counter(sum.calibration, Counter::kAvgIterations);
  state.counters["speed"] = Counter(sum.speed, Counter::kAvgIterations);
}

void estimation(benchmark::State& state, bool is_real) {
  SegmentOptions options;
  options.threads = static_cast<int>(state.range(0));
  options.evolution.max_iterations = 1;
  run(state, is_real, options, false);
}

void evolution(benchmark::State& state, bool is_real, double curvature) {
  SegmentOptions options;
  options.threads = static_cast<int>(state.range(0));
  options.evolution.curvature = curvature;
  run(state, is_real, options, true);
}

/// Bytes read and written a second by std::memcpy between arrays that no cache holds.
void copy(benchmark::State& state) {
  const std::vector<char> from(std::size_t{64} << 20, 1);
  std::vector<char> to(from.size());
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), from.size());
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * 2 * static_cast<std::int64_t>(from.size()));
}
BENCHMARK(copy);

void settings(benchmark::internal::Benchmark* b) {
  b->ArgName("threads")->Arg(1)->Arg(2)->UseManualTime()->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(estimation, phantom, false)->Apply(settings);
BENCHMARK_CAPTURE(estimation, real, true)->Apply(settings);
BENCHMARK_CAPTURE(evolution, phantom, false, 0.0)->Apply(settings);
BENCHMARK_CAPTURE(evolution, real, true, 0.0)->Apply(settings);
BENCHMARK_CAPTURE(evolution, phantom_curvature, false, 0.05)->Apply(settings);
BENCHMARK_CAPTURE(evolution, real_curvature, true, 0.05)->Apply(settings);

}  // namespace
