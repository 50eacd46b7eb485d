#include "shape3d/mapping/distortion.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "support/closed_meshes.hpp"

namespace {
using namespace shape3d::mapping;
using namespace shape3d::test;

TEST_CASE("a similarity has no distortion, at any scale") {
  const ClosedMesh mesh = icosphere(2);
  const double scale = GENERATE(1e-200, 1e-6, 1.0, 1e6, 1e200);
  const Distortion d = measure_distortion(scale * mesh.V, mesh.F, mesh.V);
  CHECK(d.angle_change.max < 1e-10);
  CHECK(d.sigma_ratio.max == Approx(1).margin(1e-10));
  CHECK(d.energy_over_area == Approx(1).epsilon(1e-12));
  CHECK(d.starved_area_share == 0);
}

TEST_CASE("an affine map of a right triangle has the distortion of its matrix") {
  // (0,0) (1,0) (0,1) to (0,0) (2,0) (0,1): singular values 2 and 1; the angles 45° become
  // atan(1/2) and atan(2).
  Points V(3, 3), S(3, 3);
  V << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  S << 0, 0, 0, 2, 0, 0, 0, 1, 0;
  Triangles F(1, 3);
  F << 0, 1, 2;
  const Distortion d = measure_distortion(V, F, S);
  CHECK(d.sigma_ratio.max == Approx(2).epsilon(1e-14));
  CHECK(d.sigma_ratio.mean == Approx(2).epsilon(1e-14));
  const double change = (std::atan(2.0) - std::atan(1.0)) * 180 / std::acos(-1.0);
  CHECK(d.angle_change.mean == Approx(2 * change / 3).epsilon(1e-12));
  CHECK(d.angle_change.median == Approx(change).epsilon(1e-12));
  CHECK(d.angle_change.max == Approx(change).epsilon(1e-12));
  CHECK(d.energy_over_area == Approx(0.5 * (4 + 1) / 2).epsilon(1e-14));  // ½ |J|² / det J
  CHECK(d.shortest_edge == 1);
}

TEST_CASE("quantiles are those of the sorted values, by nearest rank") {
  // 100 triangles side by side; triangle i is stretched by 1 + i.
  constexpr int kCount = 100;
  Points V(3 * kCount, 3), S(3 * kCount, 3);
  Triangles F(kCount, 3);
  for (int i = 0; i < kCount; ++i) {
    V.block<3, 3>(3 * i, 0) << 0, 0, 0, 1, 0, 0, 0, 1, 0;
    S.block<3, 3>(3 * i, 0) << 0, 0, 0, 1.0 + i, 0, 0, 0, 1, 0;
    F.row(i) << 3 * i, 3 * i + 1, 3 * i + 2;
  }
  const Distortion d = measure_distortion(V, F, S);
  CHECK(d.sigma_ratio.median == Approx(50));
  CHECK(d.sigma_ratio.p95 == Approx(95));
  CHECK(d.sigma_ratio.p99 == Approx(99));
  CHECK(d.sigma_ratio.max == Approx(100));
  CHECK(d.sigma_ratio.mean == Approx(50.5));
  const TriangleDistortion t = triangle_distortion(V, F, S);
  for (int i = 0; i < kCount; ++i) CHECK(t.sigma_ratio[i] == Approx(1.0 + i));
}

TEST_CASE("the starved share is the area that gets under a hundredth of its part") {
  // The octahedron with vertex 0 pulled out: its four triangles keep half of the sphere, and the
  // share of the surface that has less than 1 % is none; squeezing them to the other side starves
  // them.
  ClosedMesh mesh = icosphere(3);
  Points S = mesh.V;
  // Stereographic scaling by 1/30 crowds all but a cap of the sphere around the south pole:
  // area scale (2k/(1+z + k²(1−z)))², k = 1/30; under 0.01 where 1 + z > (2k/0.1) − k²(1−z).
  const double k = 1.0 / 30;
  for (Eigen::Index i = 0; i < S.rows(); ++i) {
    const double x = mesh.V(i, 0), y = mesh.V(i, 1), z = mesh.V(i, 2);
    const double denominator = (1 + z) + k * k * (1 - z);
    S.row(i) << 2 * k * x / denominator, 2 * k * y / denominator,
        ((1 + z) - k * k * (1 - z)) / denominator;
  }
  const Distortion d = measure_distortion(mesh.V, mesh.F, S);
  const double limit = (2 * k / 0.1 - 2 * k * k) / (1 - k * k) - 1;  // z on that circle
  CHECK(d.starved_area_share == Approx((1 - limit) / 2).margin(0.02));
}

TEST_CASE("triangles without area in V are counted, and in S are infinitely stretched") {
  Points V(4, 3), S(4, 3);
  V << 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0;
  S = V;
  S.row(3) << 0.5, 0, 0;
  Triangles F(2, 3);
  F << 0, 1, 2, 0, 1, 3;
  const Distortion d = measure_distortion(V, F, S);
  CHECK(d.unmeasured_triangles == 1);
  CHECK(std::isinf(d.sigma_ratio.max));
  const TriangleDistortion t = triangle_distortion(V, F, S);
  CHECK(std::isnan(t.sigma_ratio[0]));
  CHECK(std::isinf(t.sigma_ratio[1]));
}

TEST_CASE("distortion refuses what does not fit") {
  Points V = icosphere(0).V, S = V;
  const Triangles F = icosphere(0).F;
  CHECK_THROWS_WITH(measure_distortion(V, F, S.topRows(11)),
                    "S: 11 rows; expected 12, one for each row of V");
  S(2, 2) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(measure_distortion(V, F, S), "S: row 2 holds inf; expected finite coordinates");
  CHECK_THROWS_WITH(triangle_distortion(S, F, V),
                    "V: row 2 holds inf; expected finite coordinates");
  Triangles G = F;
  G(0, 0) = -1;
  CHECK_THROWS_WITH(measure_distortion(V, G, V), "F: row 0 names vertex -1; expected 0 to 11");
}

}  // namespace
