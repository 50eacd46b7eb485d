// Time of spherical images by triangles, size and sampling, and of their harmonics by route, size
// and K. Meshes and maps are made outside the timed loops.
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include <benchmark/benchmark.h>
#include <Eigen/Geometry>
#include <shape3d/descriptors/sh.hpp>
#include <shape3d/descriptors/spherical_image.hpp>

namespace {
using namespace shape3d::descriptors;

struct Mapped {
  Points V, S;
  Triangles F;
};

// 8n² triangles of an octahedron on the sphere, crowded towards one side by x ↦ Ax / |Ax| as
// conformal maps crowd limbs; the surface is a bumpy ellipsoid.
Mapped mapped_body(int n) {
  std::map<std::tuple<int, int, int>, std::int32_t> ids;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  const auto id = [&](int x, int y, int z) {
    const auto [entry, added] =
        ids.emplace(std::tuple(x, y, z), static_cast<std::int32_t>(points.size()));
    if (added) points.push_back(Eigen::Vector3d(x, y, z).normalized());
    return entry->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const int sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
    const auto corner = [&](int i, int j) { return id(sx * (n - i - j), sy * i, sz * j); };
    const auto add = [&](int a, int b, int c) {
      triangles.push_back(sx * sy * sz > 0 ? Eigen::Vector3i(a, b, c) : Eigen::Vector3i(a, c, b));
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        add(corner(i, j), corner(i + 1, j), corner(i, j + 1));
        if (i + j + 1 < n) add(corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
      }
    }
  }
  Mapped body;
  body.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  body.S.resize(body.V.rows(), 3);
  body.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  const Eigen::Matrix3d A = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()) *
                            Eigen::Vector3d(1, 2, 8).asDiagonal();
  for (Eigen::Index i = 0; i < body.V.rows(); ++i) {
    const Eigen::Vector3d& p = points[static_cast<std::size_t>(i)];
    const double radius = 1 + 0.2 * std::sin(3 * p.x() + 2 * p.y()) + 0.1 * std::cos(5 * p.z());
    body.V.row(i) = radius * Eigen::Vector3d(1.5, 1, 0.7).cwiseProduct(p);
    body.S.row(i) = (A * p).normalized();
  }
  for (Eigen::Index t = 0; t < body.F.rows(); ++t) {
    body.F.row(t) = triangles[static_cast<std::size_t>(t)];
  }
  return body;
}

const Mapped& body_of(int n) {
  static std::map<int, Mapped> bodies;
  const auto [entry, added] = bodies.try_emplace(n);
  if (added) entry->second = mapped_body(n);
  return entry->second;
}

template <class Image>
void time_image(benchmark::State& state, Image&& image_of) {
  const Mapped& body = body_of(static_cast<int>(state.range(0)));
  SphericalImageOptions options;
  options.size = static_cast<int>(state.range(1));
  options.sampling = state.range(2) == 0 ? ImageSampling::point : ImageSampling::area;
  options.threads = static_cast<int>(state.range(3));
  for (auto _ : state) {
    benchmark::DoNotOptimize(image_of(body.V, body.F, body.S, options));
  }
  state.counters["triangles"] = static_cast<double>(body.F.rows());
}

void sni(benchmark::State& state) { time_image(state, spherical_normal_image); }
void sgi(benchmark::State& state) { time_image(state, spherical_geometry_image); }
void sci(benchmark::State& state) { time_image(state, spherical_curvature_image); }

void check_map(benchmark::State& state) {
  const Mapped& body = body_of(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(check_spherical_map(body.V, body.F, body.S));
  state.counters["triangles"] = static_cast<double>(body.F.rows());
}

// Three components, as of SNI.
void transform(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0)), K = static_cast<int>(state.range(1));
  const ShTransform sh(size, K, static_cast<ShRoute>(state.range(2)));
  const Eigen::MatrixXd samples = Eigen::MatrixXd::Random(Eigen::Index{2} * size * size, 3);
  for (auto _ : state) benchmark::DoNotOptimize(sh(samples));
}

void prepare_svd(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(ShTransform(static_cast<int>(state.range(0)),
                                         static_cast<int>(state.range(1)), ShRoute::svd));
  }
}

BENCHMARK(sni)
    ->ArgNames({"n", "size", "area", "threads"})
    ->ArgsProduct({{11, 27, 87}, {64}, {0, 1}, {1}})
    ->Args({27, 64, 1, 2})
    ->Args({27, 16, 1, 1})
    ->Args({27, 256, 1, 1})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(sgi)
    ->ArgNames({"n", "size", "area", "threads"})
    ->ArgsProduct({{27}, {64}, {0, 1}, {1, 2}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(sci)
    ->ArgNames({"n", "size", "area", "threads"})
    ->Args({27, 64, 1, 1})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(check_map)->ArgName("n")->Arg(27)->Unit(benchmark::kMillisecond);
BENCHMARK(transform)
    ->ArgNames({"size", "K", "route"})
    ->ArgsProduct({{64}, {1, 8, 16}, {0, 1, 2}})
    ->ArgsProduct({{128, 256}, {16}, {0, 1}})
    ->Args({256, 120, 1})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(prepare_svd)
    ->ArgNames({"size", "K"})
    ->Args({32, 8})
    ->Args({64, 8})
    ->Args({64, 16})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
