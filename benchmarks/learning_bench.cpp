// Time of self-organizing maps, support vector machines and clustering.
#include <benchmark/benchmark.h>

#include "generated.hpp"
#include "shape3d/learning/clustering.hpp"
#include "shape3d/learning/som_maps.hpp"
#include "shape3d/learning/svm.hpp"

namespace {
using namespace shape3d::learning;

const GeneratedSet& items(int count, int dimension) {
  static GeneratedSet set;
  if (set.X.rows() != count || set.X.cols() != dimension) {
    set = gaussian_clouds(count, dimension, 12, 1.0, 1);
  }
  return set;
}

// 10 000 vectors of 306 numbers: amplitudes of three components up to degree 16, twice.
void som(benchmark::State& state, SomTraining training) {
  const GeneratedSet& set =
      items(static_cast<int>(state.range(1)), static_cast<int>(state.range(2)));
  SomOptions options;
  options.scaling = ScalingKind::standard;
  options.training = training;
  for (auto _ : state) {
    benchmark::DoNotOptimize(train_som(set.X, options, static_cast<int>(state.range(0))));
  }
}
BENCHMARK_CAPTURE(som, batch, SomTraining::batch)
    ->ArgNames({"threads", "items", "numbers"})
    ->Args({1, 10000, 306})
    ->Args({2, 10000, 306})
    ->Args({2, 1000, 306})
    ->Args({2, 10000, 45})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(som, sequential, SomTraining::sequential)
    ->ArgNames({"threads", "items", "numbers"})
    ->Args({1, 1000, 306})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void units(benchmark::State& state) {
  const GeneratedSet& set = items(10000, 306);
  SomOptions options;
  options.epochs = 1;
  const Som map = train_som(set.X, options);
  for (auto _ : state) {
    benchmark::DoNotOptimize(best_units(map, set.X, static_cast<int>(state.range(0))));
  }
}
BENCHMARK(units)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void agglomerate_units(benchmark::State& state) {
  const GeneratedSet& set = items(static_cast<int>(state.range(0)), 306);
  for (auto _ : state) benchmark::DoNotOptimize(agglomerate(set.X, Linkage::ward));
}
BENCHMARK(agglomerate_units)->ArgName("items")->Arg(72)->Arg(1000)->Unit(benchmark::kMillisecond);

SvmOptions svm_options(bool probabilities) {
  SvmOptions options;
  options.C = 8.0;
  options.gamma = 0.02;
  options.probabilities = probabilities;
  return options;
}

void svm_training(benchmark::State& state, bool probabilities) {
  const GeneratedSet& set = items(907, 45);
  for (auto _ : state) {
    benchmark::DoNotOptimize(Svm::train(set.X, set.labels, svm_options(probabilities),
                                        static_cast<int>(state.range(0))));
  }
}
BENCHMARK_CAPTURE(svm_training, plain, false)
    ->ArgName("threads")
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(svm_training, with_probabilities, true)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void svm_prediction(benchmark::State& state) {
  const GeneratedSet& set = items(907, 45);
  const Svm svm = Svm::train(set.X, set.labels, svm_options(false));
  for (auto _ : state) {
    benchmark::DoNotOptimize(svm.predict(set.X, static_cast<int>(state.range(0))));
  }
}
BENCHMARK(svm_prediction)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
