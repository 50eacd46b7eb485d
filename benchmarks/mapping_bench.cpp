// Time of spherical_map() by size: one star-shaped body of 5k to 330k triangles, and the same two
// meshes of SHAPE3D_DATA/genus0 when they are there.
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include <benchmark/benchmark.h>
#include <shape3d/mapping/spherical_map.hpp>

#include "support/closed_meshes.hpp"
#include "support/off_file.hpp"

namespace {
using namespace shape3d::mapping;
using shape3d::test::ClosedMesh;

void map(benchmark::State& state, const ClosedMesh& mesh, bool linear) {
  SphericalMapOptions options;
  options.linear = linear;
  int iterations = 0;
  for (auto _ : state) {
    const SphericalMap result = spherical_map(mesh.V, mesh.F, options);
    if (result.status != Status::certified) state.SkipWithError(to_string(result.status).data());
    iterations = result.minimisation.iterations;
    benchmark::DoNotOptimize(result.S.data());
  }
  state.SetComplexityN(mesh.F.rows());
  state.counters["triangles"] = static_cast<double>(mesh.F.rows());
  state.counters["iterations"] = iterations;
  state.counters["s_per_100k"] = benchmark::Counter(
      static_cast<double>(mesh.F.rows()) * 1e-5,
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const ClosedMesh& body(int levels) {
  static std::map<int, ClosedMesh> made;
  const auto place = made.find(levels);
  return place != made.end()
             ? place->second
             : made.emplace(levels, shape3d::test::star_shaped(levels, 1)).first->second;
}

void BM_linear(benchmark::State& state) {
  map(state, body(static_cast<int>(state.range(0))), true);
}
void BM_ceres(benchmark::State& state) {
  map(state, body(static_cast<int>(state.range(0))), false);
}

BENCHMARK(BM_linear)->DenseRange(4, 7)->Unit(benchmark::kMillisecond)->Complexity();
BENCHMARK(BM_ceres)->DenseRange(4, 7)->Unit(benchmark::kMillisecond)->Complexity();

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::map<std::string, ClosedMesh> meshes;
  if (const char* data = std::getenv("SHAPE3D_DATA")) {
    const std::filesystem::path folder = std::filesystem::path(data) / "genus0";
    for (const char* name : {"brain_choi_97k", "lion_choi_100k"}) {
      const std::filesystem::path file = folder / (std::string(name) + ".off");
      if (std::filesystem::exists(file)) meshes[name] = shape3d::test::read_off(file);
    }
    // 60k triangles divided once: 240k.
    const std::filesystem::path bunny = folder / "bunny_60k.off";
    if (std::filesystem::exists(bunny)) {
      meshes["bunny_60k_subdivided"] = shape3d::test::subdivided(shape3d::test::read_off(bunny));
    }
  }
  for (const auto& [name, mesh] : meshes) {
    for (const bool linear : {true, false}) {
      benchmark::RegisterBenchmark(
          ((linear ? "linear/" : "ceres/") + name).c_str(),
          [&mesh = mesh, linear](benchmark::State& state) { map(state, mesh, linear); })
          ->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
