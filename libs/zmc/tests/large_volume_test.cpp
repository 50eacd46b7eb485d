#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/zmc/extract.hpp"

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

}  // namespace
