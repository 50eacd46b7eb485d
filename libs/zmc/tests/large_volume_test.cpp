#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/zmc/extract.hpp"
#include "shape3d/zmc/stream.hpp"

namespace {
using namespace shape3d::zmc;

TEST_CASE("a volume of more than 2^31 samples", "[zmc][slow]") {
  // f = i + j + k by strides of 1 over one short array, cut near the far corner, where linear
  // indices exceed 32 bits: with m = 3 (n − 1) − c the plane f = c + 1/2 crosses 3 · (1 + 2 + … +
  // m) edges.
  constexpr std::int64_t kN = 1300;
  static_assert(kN * kN * kN > (std::int64_t{1} << 31));
  std::vector<std::int16_t> sums(static_cast<std::size_t>(3 * kN));
  std::iota(sums.begin(), sums.end(), std::int16_t{0});
  VolumeView view = make_view(sums.data(), {kN, kN, kN});
  view.strides = {1, 1, 1};
  const std::int64_t m = 10, c = 3 * (kN - 1) - m;
  const double isovalue = static_cast<double>(c) + 0.5;
  Surface<double, std::int32_t> surface;
  REQUIRE(extract(view, isovalue, Options{}, surface) == Status::ok);
  CHECK(surface.vertex_count() == 3 * m * (m + 1) / 2);
  for (std::int64_t v = 0; v < surface.vertex_count(); ++v) {
    CHECK(surface.V().row(v).sum() == Approx(isovalue).epsilon(1e-14));
    CHECK(surface.V().row(v).maxCoeff() <= static_cast<double>(kN - 1));
  }
  // At an isovalue of the lattice the vertices are its (m + 1)(m + 2) / 2 samples on the plane.
  REQUIRE(extract(view, static_cast<double>(c), Options{}, surface) == Status::ok);
  CHECK(surface.vertex_count() == (m + 1) * (m + 2) / 2);
  CHECK(surface.counts.zero_vertices == surface.vertex_count());
  CHECK(surface.triangle_count() == m * m);
}

TEST_CASE("a volume of more than 2^31 samples in slabs", "[zmc][slow][stream]") {
  // The same samples, plane by plane: 4.4 GB that are never in memory together. The plane
  // f = c + 1/2 passes through the slabs of the last 60 planes; it also does at f = c, where it
  // goes through samples.
  constexpr std::int64_t kN = 1300;
  static_assert(kN * kN * kN > (std::int64_t{1} << 31));
  std::vector<std::int16_t> sums(static_cast<std::size_t>(3 * kN));
  std::iota(sums.begin(), sums.end(), std::int16_t{0});
  PlaneSource source;
  source.type = SampleType::int16;
  source.dims = {kN, kN, kN};
  source.read = [&sums](std::int64_t first, std::int64_t count, void* out) {
    auto* row = static_cast<std::int16_t*>(out);
    for (std::int64_t k = first; k < first + count; ++k) {
      for (std::int64_t j = 0; j < kN; ++j, row += kN) std::copy_n(sums.data() + j + k, kN, row);
    }
  };
  const std::int64_t m = 60, c = 3 * (kN - 1) - m;
  for (const double isovalue : {static_cast<double>(c), static_cast<double>(c) + 0.5}) {
    INFO("isovalue " << isovalue);
    std::vector<double> positions;
    std::vector<std::int64_t> indices;
    int slabs_with_triangles = 0;
    const Status status = stream<double>(
        source, isovalue, Options{}, StreamOptions{},
        [&](const Surface<double, std::int64_t>& slab, std::int64_t first_id) {
          CHECK(first_id == static_cast<std::int64_t>(positions.size() / 3));
          positions.insert(positions.end(), slab.positions.begin(), slab.positions.end());
          indices.insert(indices.end(), slab.indices.begin(), slab.indices.end());
          if (slab.triangle_count() > 0) ++slabs_with_triangles;
          return true;
        });
    REQUIRE(status == Status::ok);
    CHECK(slabs_with_triangles > 2);
    VolumeView view = make_view(sums.data(), {kN, kN, kN});
    view.strides = {1, 1, 1};
    Surface<double, std::int64_t> whole;
    REQUIRE(extract(view, isovalue, Options{}, whole) == Status::ok);
    CHECK(whole.vertex_count() ==
          (isovalue == static_cast<double>(c) ? (m + 1) * (m + 2) / 2 : 3 * m * (m + 1) / 2));
    CHECK(std::equal(positions.begin(), positions.end(), whole.positions.begin(),
                     whole.positions.end()));
    // Patches alone: they are in the order of the whole surface.
    CHECK(std::equal(indices.begin(), indices.end(), whole.indices.begin(), whole.indices.end()));
  }
}

}  // namespace
