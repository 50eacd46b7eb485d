#include "shape3d/zmc/extractor.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/zmc/instruction_set.hpp"
#include "support/random_volume.hpp"

namespace {

using namespace shape3d::zmc;
using shape3d::test::random_samples;
using Dims = std::array<std::int64_t, 3>;

template <class Real, class Index>
void check_same(const Surface<Real, Index>& a, const Surface<Real, Index>& b) {
  CHECK(a.positions == b.positions);
  CHECK(a.indices == b.indices);
  CHECK(a.normals == b.normals);
  CHECK(a.gradients == b.gradients);
  CHECK(a.first_zero_face == b.first_zero_face);
  CHECK(a.first_closing == b.first_closing);
  CHECK(a.counts.faces_by_case == b.counts.faces_by_case);
  CHECK(a.counts.nonmanifold_edges == b.counts.nonmanifold_edges);
}

TEST_CASE("an extractor used again gives what a new one gives", "[zmc][extractor]") {
  Extractor extractor;
  Surface<double, std::int32_t> reused;
  for (const Dims& dims : {Dims{20, 21, 22}, Dims{70, 5, 9}, Dims{3, 3, 3}, Dims{33, 40, 12}}) {
    for (const int density : {0, 30, 90}) {
      const std::vector<int> random = random_samples(dims, 3, density, 7 + density);
      const std::vector<std::int32_t> samples(random.begin(), random.end());
      const VolumeView view = make_view(samples.data(), dims);
      Options options;
      options.border = density == 30 ? Border::capped : Border::open;
      options.count_nonmanifold = density == 90;
      const Status status = extractor.extract(view, 0.0, options, reused);
      Surface<double, std::int32_t> fresh;
      CHECK(extract(view, 0.0, options, fresh) == status);
      check_same(reused, fresh);
    }
  }
}

TEST_CASE("several isovalues in one pass equal one at a time", "[zmc][extractor]") {
  const Dims dims{31, 17, 19};
  const std::vector<int> random = random_samples(dims, 20, 5, 99);
  std::vector<float> samples(random.begin(), random.end());
  samples[100] = std::numeric_limits<float>::quiet_NaN();
  const VolumeView view = make_view(samples.data(), dims);
  Options options;
  options.non_finite = NonFinite::mask;
  options.normals = true;
  const std::vector<double> isovalues{0.0, -3.0, 7.5, 1000.0, 0.0};
  std::vector<Surface<float, std::int32_t>> surfaces;
  const std::vector<Status> statuses = Extractor().extract(view, isovalues, options, surfaces);
  REQUIRE(surfaces.size() == isovalues.size());
  for (std::size_t n = 0; n < isovalues.size(); ++n) {
    INFO("isovalue " << isovalues[n]);
    Surface<float, std::int32_t> single;
    CHECK(extract(view, isovalues[n], options, single) == statuses[n]);
    check_same(surfaces[n], single);
  }
  CHECK(statuses[3] == Status::empty);
  CHECK_THROWS_WITH(Extractor().extract(view, std::vector<double>{}, options, surfaces),
                    Catch::Contains("isovalues"));
}

/// Extraction with each instruction set that the processor has must give the same bytes.
template <class T>
void check_instruction_sets(const Dims& dims, int density, std::uint64_t seed) {
  const std::vector<int> random = random_samples(dims, 40, density, seed);
  std::vector<T> samples;
  for (const int v : random) {
    samples.push_back(std::is_signed_v<T> ? static_cast<T>(v) : static_cast<T>(v + 60));
  }
  const double zero = std::is_signed_v<T> ? 0.0 : 60.0;
  const InstructionSet best = active_instruction_set();
  for (const double isovalue : {zero, zero + 0.5, zero - 7.0}) {
    for (const Inside inside : {Inside::below, Inside::above}) {
      Options options;
      options.inside = inside;
      options.threads = 1;
      options.triangulation = isovalue < zero ? Triangulation::centroid : Triangulation::compact;
      options.normals = options.gradients = true;
      Surface<float, std::int32_t> expected;
      use_instruction_set(InstructionSet::portable);
      extract(make_view(samples.data(), dims), isovalue, options, expected);
      for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
        if (use_instruction_set(set) != set) continue;  // not on this processor
        INFO(to_string(set) << ", row of " << dims[0] << ", isovalue " << isovalue);
        Surface<float, std::int32_t> surface;
        extract(make_view(samples.data(), dims), isovalue, options, surface);
        check_same(surface, expected);
      }
      use_instruction_set(best);
    }
  }
}

TEST_CASE("all instruction sets give the same surface", "[zmc][extractor]") {
  std::uint64_t seed = 1;
  for (const std::int64_t nx : {2, 7, 8, 15, 16, 31, 32, 33, 63, 64, 65, 127, 128, 129, 200}) {
    for (const int density : {0, 10, 70}) {
      const Dims dims{nx, 6, 5};
      check_instruction_sets<std::int8_t>(dims, density, ++seed);
      check_instruction_sets<std::uint8_t>(dims, density, ++seed);
      check_instruction_sets<std::int16_t>(dims, density, ++seed);
      check_instruction_sets<std::uint16_t>(dims, density, ++seed);
      check_instruction_sets<std::int32_t>(dims, density, ++seed);
      check_instruction_sets<float>(dims, density, ++seed);
      check_instruction_sets<double>(dims, density, ++seed);
    }
  }
}

/// f = |p|² − r² on an anisotropic grid with one mirrored axis: ∇f = 2 p exactly by central
/// differences.
struct Ball {
  Dims dims;
  std::vector<double> samples;
  VolumeView view;

  Ball(std::int64_t n, double sign) : dims{n, n + 3, n + 5} {
    view.dims = dims;
    view.spacing = Eigen::Vector3d(2.4, 2.6, 3.0) / static_cast<double>(n);
    view.direction.col(0) *= -1.0;
    view.origin = {1.2, -1.3, -1.5};
    view.type = SampleType::float64;
    for (std::int64_t k = 0; k < dims[2]; ++k) {
      for (std::int64_t j = 0; j < dims[1]; ++j) {
        for (std::int64_t i = 0; i < dims[0]; ++i) {
          const Eigen::Vector3d lattice(static_cast<double>(i), static_cast<double>(j),
                                        static_cast<double>(k));
          samples.push_back(sign * (view.world(lattice).squaredNorm() - 0.8));
        }
      }
    }
    view.data = samples.data();
  }
};

TEST_CASE("gradients of a quadratic are exact at lattice points and linear between",
          "[zmc][gradient]") {
  for (const double sign : {1.0, -1.0}) {
    const Ball ball(24, sign);
    Options options;
    options.inside = sign > 0.0 ? Inside::below : Inside::above;
    options.gradients = options.normals = true;
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::centroid}) {
      options.triangulation = triangulation;
      const Surface<double> surface = extract(ball.view, 0.0, options);
      REQUIRE(surface.vertex_count() > 100);
      REQUIRE(surface.N().rows() == surface.vertex_count());
      REQUIRE(surface.G().rows() == surface.vertex_count());
      double worst_gradient = 0.0, worst_normal = 0.0;
      for (std::int64_t v = 0; v < surface.vertex_count(); ++v) {
        const Eigen::Vector3d p = surface.V().row(v).transpose();
        worst_gradient =
            std::max(worst_gradient, (surface.G().row(v).transpose() - sign * 2.0 * p).norm());
        worst_normal =
            std::max(worst_normal, (surface.N().row(v).transpose() - p.normalized()).norm());
      }
      CHECK(worst_gradient < 1e-12);
      // Of centroids, normals are averaged: their error is second order in the spacing of about
      // 0.1.
      CHECK(worst_normal < (triangulation == Triangulation::compact ? 1e-12 : 0.02));
    }
    options.normals = options.gradients = false;
    const Surface<double> bare = extract(ball.view, 0.0, options);
    CHECK(bare.N().rows() == 0);
    CHECK(bare.G().rows() == 0);
  }
}

TEST_CASE("attributes beside masked samples are those of the volume without", "[zmc][gradient]") {
  // A volume with a masked sample is worked on vertex by vertex, one without in blocks.
  const Dims dims{21, 9, 8};
  const std::vector<int> random = random_samples(dims, 40, 10, 5);
  std::vector<float> samples(random.begin(), random.end());
  VolumeView view = make_view(samples.data(), dims, {0.7, 1.1, 2.3}, {-3.0, 5.0, 0.1});
  view.direction << 0.0, 0.6, 0.8, 1.0, 0.0, 0.0, 0.0, 0.8, -0.6;
  Options options;
  options.normals = options.gradients = options.edges = true;
  options.non_finite = NonFinite::mask;
  Surface<float, std::int32_t> whole, masked;
  REQUIRE(extract(view, 0.0, options, whole) == Status::ok);
  samples[0] = std::numeric_limits<float>::quiet_NaN();
  REQUIRE(extract(view, 0.0, options, masked) == Status::ok);
  REQUIRE(masked.counts.masked_cells == 1);

  std::map<std::pair<std::int64_t, float>, std::size_t> places;  // on the lattice
  for (std::size_t v = 0; v < whole.edges.size(); ++v) {
    if (whole.edges[v] >= 0) places[{whole.edges[v], whole.edge_parameters[v]}] = v;
  }
  std::size_t compared = 0;
  for (std::size_t v = 0; v < masked.edges.size(); ++v) {
    const std::int64_t i = masked.edges[v] / 3 % dims[0], row = masked.edges[v] / 3 / dims[0];
    // Not one whose differences reach the masked sample.
    if (masked.edges[v] < 0 || (i < 3 && row % dims[1] < 3 && row / dims[1] < 3)) continue;
    const auto found = places.find({masked.edges[v], masked.edge_parameters[v]});
    REQUIRE(found != places.end());
    for (std::size_t d = 0; d < 3; ++d) {
      REQUIRE(masked.gradients[3 * v + d] == whole.gradients[3 * found->second + d]);
      REQUIRE(masked.normals[3 * v + d] == whole.normals[3 * found->second + d]);
    }
    ++compared;
  }
  CHECK(compared > 1500);
}

TEST_CASE("lengths of gradients that overflow or vanish when squared", "[zmc][gradient]") {
  // A plane x = 1.5 between samples whose difference is far from 1, in both directions.
  for (const double scale : {1e-200, 1e-160, 1.0, 1e160, 1e200}) {
    std::vector<double> samples;
    for (int n = 0; n < 4 * 9 * 9; ++n) samples.push_back(scale * (n % 4 - 1.5));
    Options options;
    options.normals = true;
    Surface<double, std::int32_t> surface;
    REQUIRE(extract(make_view(samples.data(), {4, 9, 9}), 0.0, options, surface) == Status::ok);
    INFO("scale " << scale);
    REQUIRE(surface.N().rows() == 81);
    CHECK((surface.N().col(0).array() == 1.0).all());
    CHECK((surface.N().rightCols<2>().array() == 0.0).all());
  }
}

TEST_CASE("normals vanish with the gradient and point out of caps", "[zmc][gradient]") {
  const Dims dims{5, 5, 5};
  std::vector<double> spike(125, 1.0);
  spike[62] = -1.0;  // the gradient at the neighbours of the middle is not 0, at the middle it is
  Options options;
  options.normals = options.gradients = true;
  const Surface<double> octahedron = extract(make_view(spike.data(), dims), 0.0, options);
  REQUIRE(octahedron.vertex_count() == 6);
  for (std::int64_t v = 0; v < 6; ++v) {
    const Eigen::Vector3d out = octahedron.V().row(v).transpose() - Eigen::Vector3d(2, 2, 2);
    CHECK((octahedron.N().row(v).transpose() - out.normalized()).norm() < 1e-12);
  }
  std::vector<double> flat(125, 1.0);
  for (std::size_t n = 50; n < 75; ++n) flat[n] = 0.0;  // a plane of zeros between equal signs
  for (std::size_t n = 75; n < 125; ++n) flat[n] = -1.0;
  for (std::size_t n = 0; n < 50; ++n) flat[n] = -1.0;
  options.zero_faces = ZeroFaces::mating;
  const Surface<double> mating = extract(make_view(flat.data(), dims), 0.0, options);
  REQUIRE(mating.vertex_count() == 25);
  CHECK(mating.N().norm() == 0.0);
  CHECK(mating.G().norm() == 0.0);

  const std::vector<double> full(125, -1.0);
  options.zero_faces = ZeroFaces::boundary;
  options.border = Border::capped;
  const Surface<double> box = extract(make_view(full.data(), dims), 0.0, options);
  REQUIRE(box.vertex_count() == 6 * 25);
  for (std::int64_t v = 0; v < box.vertex_count(); ++v) {
    const Eigen::Vector3d n = box.N().row(v).transpose();
    CHECK(n.norm() == Approx(1.0));
    CHECK(n.dot(box.V().row(v).transpose() - Eigen::Vector3d(2, 2, 2)) ==
          Approx(2.0).epsilon(1e-5));
  }
}

TEST_CASE("instruction sets have names", "[zmc][extractor]") {
  CHECK(to_string(InstructionSet::portable) == "portable");
  CHECK(to_string(InstructionSet::avx2) == "avx2");
  CHECK(to_string(InstructionSet::avx512) == "avx512");
}

}  // namespace
