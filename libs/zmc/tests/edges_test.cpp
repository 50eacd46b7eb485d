// Lattice edges of vertices, and arrays handed over.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/zmc/extract.hpp"
#include "support/random_volume.hpp"

namespace {
using namespace shape3d::zmc;
using shape3d::test::random_samples;

Eigen::Vector3d position(const Surface<double>& mesh, std::int64_t vertex) {
  return mesh.V().row(vertex).transpose();
}

/// The lattice point of an edge's lower end.
Eigen::Vector3d lower_end(std::int64_t edge, const VolumeView& view) {
  const std::int64_t sample = edge / 3;
  return {static_cast<double>(sample % view.dims[0]),
          static_cast<double>(sample / view.dims[0] % view.dims[1]),
          static_cast<double>(sample / (view.dims[0] * view.dims[1]))};
}

TEST_CASE("edges and their parameters say where every vertex lies", "[zmc][extract]") {
  const std::array<std::int64_t, 3> dims{67, 5, 6};
  const int range = GENERATE(1, 2, 1000);
  const std::vector<int> samples = random_samples(dims, range, 20, 4711U + range);
  VolumeView view = make_view(samples.data(), dims, {0.5, 0.75, 2.0}, {-3.0, 4.0, 5.0});
  view.direction.col(0).swap(view.direction.col(1));
  Options options;
  options.edges = true;
  options.triangulation = GENERATE(Triangulation::compact, Triangulation::centroid);
  options.zero_faces = GENERATE(ZeroFaces::boundary, ZeroFaces::mating);
  options.border = GENERATE(Border::open, Border::capped);
  Surface<double> mesh;
  REQUIRE(extract(view, 0.0, options, mesh) == Status::ok);
  REQUIRE(mesh.edges.size() == static_cast<std::size_t>(mesh.vertex_count()));
  REQUIRE(mesh.edge_parameters.size() == mesh.edges.size());

  // A cap lies 2^-20 of a spacing off its border sample.
  const double off = options.border == Border::capped ? std::ldexp(2.0, -20) : 1e-12;
  std::map<std::int64_t, std::set<std::int64_t>> around;  // of centroids
  for (std::int64_t t = 0; t < mesh.triangle_count(); ++t) {
    for (int n = 0; n < 3; ++n) {
      const std::int64_t vertex = mesh.F()(t, n);
      if (mesh.edges[vertex] >= 0) continue;
      around[vertex].insert(mesh.F()(t, (n + 1) % 3));
      around[vertex].insert(mesh.F()(t, (n + 2) % 3));
    }
  }
  CHECK(static_cast<std::int64_t>(around.size()) == mesh.counts.centroids);
  double worst = 0.0;
  std::set<std::pair<std::int64_t, double>> places;
  for (std::int64_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    const std::int64_t edge = mesh.edges[vertex];
    const double t = mesh.edge_parameters[vertex];
    Eigen::Vector3d expected = Eigen::Vector3d::Zero();
    if (edge < 0) {
      CHECK(t == 0.0);
      for (const std::int64_t other : around.at(vertex)) {
        REQUIRE(mesh.edges[other] >= 0);
        expected += position(mesh, other);
      }
      expected /= static_cast<double>(around.at(vertex).size());
      worst = std::max(worst, (position(mesh, vertex) - expected).norm() - 1e-12);
      continue;
    }
    REQUIRE(edge / 3 < static_cast<std::int64_t>(samples.size()));
    Eigen::Vector3d place = lower_end(edge, view);
    const auto axis = static_cast<Eigen::Index>(edge % 3);
    place[axis] += t;
    worst = std::max(worst, (position(mesh, vertex) - view.world(place)).norm() - off);
    const int lower = samples[static_cast<std::size_t>(edge / 3)];
    if (t == 0.0) {
      CHECK(axis == 0);
      if (options.border == Border::open) CHECK(lower == 0);
    } else {
      const std::array<std::int64_t, 3> strides = view.effective_strides();
      const int upper = samples[static_cast<std::size_t>(edge / 3 + strides[axis])];
      REQUIRE(static_cast<double>(lower) * upper < 0.0);
      CHECK((1.0 - t) * lower + t * upper == Approx(0.0).margin(1e-9));
    }
    if (options.border == Border::open) CHECK(places.insert({edge, t}).second);
  }
  CHECK(worst <= 0.0);

  options.edges = false;
  REQUIRE(extract(view, 0.0, options, mesh) == Status::ok);
  CHECK(mesh.edges.empty());
  CHECK(mesh.edge_parameters.empty());
}

TEST_CASE("a released array keeps its address and contents", "[zmc][surface]") {
  detail::Buffer<float> buffer(3 << 20, 2.5F);  // large enough for huge pages
  const float* address = buffer.data();
  float* array = detail::release_array(std::move(buffer));
  CHECK(array == address);
  CHECK(std::all_of(array, array + (3 << 20), [](float x) { return x == 2.5F; }));
  detail::free_array(array);
  CHECK(detail::release_array(detail::Buffer<int>()) == nullptr);
}
}  // namespace
