// Time of descriptors on a body of the size of the median model of the Princeton Shape Benchmark,
// and growth with triangles, grid and degree.
#include <string>

#include <benchmark/benchmark.h>

#include "bumpy_body.hpp"
#include "shape3d/descriptors/descriptor.hpp"
#include "shape3d/descriptors/hsh_sampling.hpp"

namespace {
using namespace shape3d::bench;
using namespace shape3d::descriptors;

constexpr double kMedianTriangles = 2400;  // of the training half of the benchmark

void describe(benchmark::State& state, const char* spec, double triangles) {
  const Body body = bumpy(rows_for(triangles));
  const Descriptor descriptor = Descriptor::parse(spec);
  const auto threads = static_cast<int>(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(descriptor.compute(body.V, body.F, threads));
  }
  state.counters["triangles"] = static_cast<double>(body.F.rows());
}

#define SHAPE3D_DESCRIBE(name, spec)                        \
  BENCHMARK_CAPTURE(describe, name, spec, kMedianTriangles) \
      ->Arg(1)                                              \
      ->Arg(2)                                              \
      ->ArgName("threads")                                  \
      ->Unit(benchmark::kMillisecond)                       \
      ->UseRealTime()

SHAPE3D_DESCRIBE(hsh_45_binary, "hsh:fill=binary");
SHAPE3D_DESCRIBE(hsh_45_area, "hsh:fill=area");
SHAPE3D_DESCRIBE(hsh_45_gedt, "hsh:fill=gedt");
SHAPE3D_DESCRIBE(hsh_45_distance, "hsh:fill=distance");
SHAPE3D_DESCRIBE(hsh_496_distance, "hsh:K=30,fill=distance");
SHAPE3D_DESCRIBE(gram_816_distance, "hsh:K=15,invariants=gram,fill=distance");
SHAPE3D_DESCRIBE(csm_45_distance, "csm:R=5,K=8,fill=distance");
SHAPE3D_DESCRIBE(csm_512_binary, "csm:R=32,K=15,fill=binary");
SHAPE3D_DESCRIBE(csm_512_distance, "csm:R=32,K=15,fill=distance");
SHAPE3D_DESCRIBE(kazhdan_544_gedt, "csm:variant=kazhdan,R=32,K=15,fill=gedt");
SHAPE3D_DESCRIBE(d2_64, "d2");
SHAPE3D_DESCRIBE(egi_17, "egi");
SHAPE3D_DESCRIBE(hsh_45_separable, "hsh:quadrature=separable,fill=distance");
SHAPE3D_DESCRIBE(hsh_45_svd, "hsh:quadrature=svd,fill=distance");

/// The transform alone, voxels given: degrees.
void transform_degree(benchmark::State& state) {
  const Body body = bumpy(rows_for(kMedianTriangles));
  const Voxels voxels = voxelize(body.V, body.F);
  HshOptions options;
  options.K = static_cast<int>(state.range(0));
  const HshTransform transform(options, 64);
  for (auto _ : state) benchmark::DoNotOptimize(transform(voxels, 1));
}
BENCHMARK(transform_degree)
    ->Arg(4)
    ->Arg(8)
    ->Arg(15)
    ->Arg(30)
    ->ArgName("K")
    ->Unit(benchmark::kMillisecond);

/// The whole, one thread: sides of the grid.
void whole_side(benchmark::State& state, const char* fill) {
  const Body body = bumpy(rows_for(kMedianTriangles));
  const Descriptor descriptor = Descriptor::parse("hsh:K=3,fill=" + std::string(fill) +
                                                  ",voxels=" + std::to_string(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(descriptor.compute(body.V, body.F, 1));
  state.SetComplexityN(state.range(0));
}
BENCHMARK_CAPTURE(whole_side, binary, "binary")
    ->RangeMultiplier(2)
    ->Range(16, 256)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oNCubed);
BENCHMARK_CAPTURE(whole_side, distance, "distance")
    ->RangeMultiplier(2)
    ->Range(16, 256)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oNCubed);

/// Voxels alone, one thread: triangles.
void voxelize_triangles(benchmark::State& state, Fill fill) {
  const Body body = bumpy(rows_for(static_cast<double>(state.range(0))));
  VoxelizeOptions options;
  options.fill = fill;
  options.threads = 1;
  for (auto _ : state) benchmark::DoNotOptimize(voxelize(body.V, body.F, options));
  state.counters["triangles"] = static_cast<double>(body.F.rows());
}
BENCHMARK_CAPTURE(voxelize_triangles, binary, Fill::binary)
    ->RangeMultiplier(8)
    ->Range(64, 1 << 18)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(voxelize_triangles, area, Fill::area)
    ->RangeMultiplier(8)
    ->Range(64, 1 << 18)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(voxelize_triangles, gedt, Fill::gedt)
    ->RangeMultiplier(8)
    ->Range(64, 1 << 18)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(voxelize_triangles, distance, Fill::distance)
    ->RangeMultiplier(8)
    ->Range(64, 1 << 18)
    ->Unit(benchmark::kMillisecond);

/// Appendix D's preparation: the pseudo-inverse of 8000 × 285, which took 31 minutes in 2007.
void svd_preparation(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(HshSampling(8, Quadrature::svd, 20).size());
}
BENCHMARK(svd_preparation)->Unit(benchmark::kMillisecond)->Iterations(1);

/// What the sum over voxels prepares instead.
void voxel_preparation(benchmark::State& state) {
  HshOptions options;
  options.K = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(HshTransform(options, 64).side());
}
BENCHMARK(voxel_preparation)->Arg(8)->Arg(30)->ArgName("K")->Unit(benchmark::kMillisecond);

}  // namespace
