// Time of the mesh functions of `mapping` but the spherical map: pose, inspection, curvature, and
// progressive meshes, by size. The body is a sphere with bumps of 20 · 4^level triangles, or a
// file: SHAPE3D_BENCH_MESH names an OFF file of triangles, which stands for level 0.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <shape3d/mapping/align.hpp>
#include <shape3d/mapping/curvature.hpp>
#include <shape3d/mapping/inspect.hpp>
#include <shape3d/mapping/progressive.hpp>

namespace {
using namespace shape3d::mapping;

struct Body {
  Points V;
  Triangles F;
};

Body icosahedron() {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  Body body;
  body.V.resize(12, 3);
  body.V << -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, 0, 0, -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, g, 0,
      -1, g, 0, 1, -g, 0, -1, -g, 0, 1;
  body.V.rowwise().normalize();
  body.F.resize(20, 3);
  body.F << 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6,
      7, 1, 8, 3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9,
      8, 1;
  return body;
}

// Cuts each triangle in four; new vertices go to the unit sphere.
Body refined(const Body& body) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  std::vector<Eigen::RowVector3d> points;
  for (Eigen::Index v = 0; v < body.V.rows(); ++v) points.emplace_back(body.V.row(v));
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const auto [found, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(points.size()));
    if (is_new)
      points.emplace_back(
          (points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)]).normalized());
    return found->second;
  };
  Body result;
  result.F.resize(4 * body.F.rows(), 3);
  for (Eigen::Index t = 0; t < body.F.rows(); ++t) {
    const std::int32_t a = body.F(t, 0), b = body.F(t, 1), c = body.F(t, 2);
    const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    result.F.row(4 * t) << a, ab, ca;
    result.F.row(4 * t + 1) << b, bc, ab;
    result.F.row(4 * t + 2) << c, ca, bc;
    result.F.row(4 * t + 3) << ab, bc, ca;
  }
  result.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v)
    result.V.row(static_cast<Eigen::Index>(v)) = points[v];
  return result;
}

Body read_off(const char* path) {
  std::ifstream file(path);
  std::string magic;
  Eigen::Index vertices = 0, triangles = 0, edges = 0;
  file >> magic >> vertices >> triangles >> edges;
  if (!file || magic != "OFF")
    throw std::runtime_error(std::string(path) + ": expected an OFF file");
  Body body;
  body.V.resize(vertices, 3);
  body.F.resize(triangles, 3);
  for (Eigen::Index v = 0; v < vertices; ++v) file >> body.V(v, 0) >> body.V(v, 1) >> body.V(v, 2);
  for (Eigen::Index t = 0; t < triangles; ++t) {
    int corners = 0;
    file >> corners >> body.F(t, 0) >> body.F(t, 1) >> body.F(t, 2);
    if (corners != 3) throw std::runtime_error(std::string(path) + ": expected triangles alone");
  }
  if (!file) throw std::runtime_error(std::string(path) + ": it ends early");
  return body;
}

const Body& body_of(std::int64_t level) {
  static std::map<std::int64_t, Body> bodies;
  const auto found = bodies.find(level);
  if (found != bodies.end()) return found->second;
  if (level == 0)
    return bodies.emplace(level, read_off(std::getenv("SHAPE3D_BENCH_MESH"))).first->second;
  Body body = icosahedron();
  for (std::int64_t i = 0; i < level; ++i) body = refined(body);
  for (Eigen::Index v = 0; v < body.V.rows(); ++v) {
    const Eigen::RowVector3d u = body.V.row(v);
    body.V.row(v) *=
        1 + 0.2 * std::sin(5 * u[0] + 1) * std::cos(4 * u[1]) + 0.1 * std::sin(9 * u[2]);
  }
  return bodies.emplace(level, std::move(body)).first->second;
}

void set_counters(benchmark::State& state, const Body& body, std::int64_t items) {
  state.SetItemsProcessed(state.iterations() * items);
  state.SetComplexityN(body.F.rows());
  state.counters["triangles"] = static_cast<double>(body.F.rows());
}

void align_body(benchmark::State& state) {
  const Body& body = body_of(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(align(body.V, body.F));
  set_counters(state, body, body.F.rows());
}

void inspect_body(benchmark::State& state) {
  const Body& body = body_of(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(inspect(body.V, body.F));
  set_counters(state, body, body.F.rows());
}

void curvature_of_body(benchmark::State& state) {
  const Body& body = body_of(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(curvature(body.V, body.F));
  set_counters(state, body, body.V.rows());
}

// Items are collapses, down to a hundredth of the triangles.
void collapse(benchmark::State& state, CollapseCost cost) {
  const Body& body = body_of(state.range(0));
  ProgressiveOptions options;
  options.cost = cost;
  options.coarsest = body.F.rows() / 100;
  std::int64_t collapses = 0;
  for (auto _ : state) {
    const ProgressiveMesh mesh(body.V, body.F, options);
    collapses = mesh.collapses();
  }
  set_counters(state, body, collapses);
}

ProgressiveMesh levels_of(const Body& body) {
  ProgressiveOptions options;
  options.coarsest = body.F.rows() / 100;
  return ProgressiveMesh(body.V, body.F, options);
}

// Items are vertex splits: from the coarsest level to the finest.
void refine(benchmark::State& state) {
  const Body& body = body_of(state.range(0));
  ProgressiveMesh mesh = levels_of(body);
  for (auto _ : state) {
    state.PauseTiming();
    mesh.set_triangle_count(mesh.coarsest());
    state.ResumeTiming();
    mesh.set_triangle_count(mesh.finest());
  }
  set_counters(state, body, mesh.collapses());
}

// The same with the level as matrices.
void refine_and_copy(benchmark::State& state) {
  const Body& body = body_of(state.range(0));
  ProgressiveMesh mesh = levels_of(body);
  for (auto _ : state) {
    state.PauseTiming();
    mesh.set_triangle_count(mesh.coarsest());
    state.ResumeTiming();
    mesh.set_triangle_count(mesh.finest());
    benchmark::DoNotOptimize(mesh.V());
    benchmark::DoNotOptimize(mesh.F());
  }
  set_counters(state, body, mesh.collapses());
}

void encode(benchmark::State& state) {
  const Body& body = body_of(state.range(0));
  const ProgressiveMesh mesh = levels_of(body);
  std::size_t size = 0;
  for (auto _ : state) size = mesh.to_bytes().size();
  set_counters(state, body, mesh.collapses());
  state.counters["bytes/vertex"] = static_cast<double>(size) / static_cast<double>(body.V.rows());
}

void decode(benchmark::State& state) {
  const Body& body = body_of(state.range(0));
  const std::vector<std::byte> bytes = levels_of(body).to_bytes();
  for (auto _ : state)
    benchmark::DoNotOptimize(ProgressiveMesh::from_bytes(bytes.data(), bytes.size()));
  set_counters(state, body, levels_of(body).collapses());
}

// Levels 4 (5 120 triangles) to `last`, 20 · 4^level triangles; or the file when there is one.
void sizes(benchmark::internal::Benchmark* bench, std::int64_t last) {
  bench->ArgName("level")->Unit(benchmark::kMillisecond);
  if (std::getenv("SHAPE3D_BENCH_MESH") != nullptr) {
    bench->Arg(0);
  } else {
    bench->DenseRange(4, last)->Complexity();
  }
}
void all_sizes(benchmark::internal::Benchmark* bench) { sizes(bench, 6); }
void small_sizes(benchmark::internal::Benchmark* bench) { sizes(bench, 5); }

BENCHMARK(align_body)->Apply(all_sizes);
BENCHMARK(inspect_body)->Apply(all_sizes);
BENCHMARK(curvature_of_body)->Apply(all_sizes);
BENCHMARK_CAPTURE(collapse, quadrics, CollapseCost::quadrics)->Apply(all_sizes)->Iterations(1);
BENCHMARK_CAPTURE(collapse, lindstrom_turk, CollapseCost::lindstrom_turk)
    ->Apply(all_sizes)
    ->Iterations(1);
BENCHMARK_CAPTURE(collapse, hoppe, CollapseCost::hoppe)->Apply(small_sizes)->Iterations(1);
BENCHMARK(refine)->Apply(all_sizes);
BENCHMARK(refine_and_copy)->Apply(all_sizes);
BENCHMARK(encode)->Apply(all_sizes);
BENCHMARK(decode)->Apply(all_sizes);

}  // namespace
