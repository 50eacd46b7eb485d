#include "shape3d/descriptors/surface.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "meshes.hpp"

namespace {
using namespace shape3d::descriptors;
using namespace shape3d::descriptors::test;
using Eigen::Vector3d;

TEST_CASE("the frame of a box has its closed form", "[descriptors][analytic]") {
  // Faces of a cube of half side 1: RMS² = mean over x² + y² + 1 on a face = 2/3 + 1.
  const Soup cube = box({4, 5, 6}, {6, 7, 8});
  CHECK(surface_area(cube.V, cube.F) == Approx(24).epsilon(1e-14));
  const Frame frame = surface_frame(cube.V, cube.F);
  CHECK((frame.centre - Vector3d(5, 6, 7)).norm() < 1e-13);
  CHECK(frame.radius == Approx(2 * std::sqrt(5.0 / 3)).epsilon(1e-14));
  CHECK(surface_frame(cube.V, cube.F, Centre::area, Scale::maximum, 1).radius ==
        Approx(std::sqrt(3)).epsilon(1e-14));
  // ∫ √(1 + x² + y²) over [0,1]²: 1.2807892 (by series; the quadrature is good to 1e-5).
  double mean = 0;
  for (int i = 0; i < 2000; ++i) {
    for (int j = 0; j < 2000; ++j) {
      mean += std::sqrt(1 + std::pow((i + 0.5) / 2000, 2) + std::pow((j + 0.5) / 2000, 2)) / 4e6;
    }
  }
  CHECK(surface_frame(cube.V, cube.F, Centre::area, Scale::mean, 1).radius ==
        Approx(mean).epsilon(1e-6));
  const Soup lopsided = joined(cube, box({6, 5, 6}, {10, 7, 8}));
  CHECK(surface_frame(lopsided.V, lopsided.F, Centre::box).centre.x() == Approx(7));
}

TEST_CASE("the frame follows rotation, offset and scale of the mesh", "[descriptors][property]") {
  const Soup body = bumpy(6);
  const Scale scale = GENERATE(Scale::rms, Scale::mean, Scale::maximum);
  const Frame frame = surface_frame(body.V, body.F, Centre::area, scale);
  for (const double size : {1e-9, 1e-3, 1.0, 1e9}) {
    const Eigen::Matrix3d turn = random_rotation(3);
    const Vector3d offset = size * Vector3d(10, -20, 30);
    const Soup moved = transformed(body, size * turn, offset);
    const Frame other = surface_frame(moved.V, moved.F, Centre::area, scale);
    INFO("size " << size);
    CHECK(other.radius == Approx(size * frame.radius).epsilon(1e-12));
    CHECK((other.centre - (size * turn * frame.centre + offset)).norm() < 1e-12 * size);
  }
  // At an offset of 1e9 a coordinate is known to 2⁻²³ = 1.2e-7.
  const Soup far = transformed(body, Eigen::Matrix3d::Identity(), Vector3d::Constant(1e9));
  CHECK(surface_frame(far.V, far.F, Centre::area, scale).radius ==
        Approx(frame.radius).epsilon(1e-6));
}

TEST_CASE("quadrature points integrate quadratics exactly", "[descriptors][analytic]") {
  const Soup cube = box({-1, -1, -1}, {1, 1, 1});
  for (const double edge : {10.0, 1.0, 0.21}) {
    const SurfacePoints sample = surface_points(cube.V, cube.F, edge);
    CHECK(sample.weights.sum() == Approx(24).epsilon(1e-13));
    CHECK(sample.weights.dot(sample.points.rowwise().squaredNorm()) ==
          Approx(24 * 5.0 / 3).epsilon(1e-13));
    CHECK(std::abs(sample.weights.dot(sample.points.col(0).cwiseProduct(sample.points.col(1)))) <
          1e-12);
    CHECK(sample.points.rows() ==
          12 * 3 * static_cast<Eigen::Index>(std::pow(std::ceil(std::sqrt(8) / edge), 2)));
  }
}

TEST_CASE("meshes that are not surfaces are refused in one sentence", "[descriptors][contract]") {
  const Soup good = box({0, 0, 0}, {1, 1, 1});
  const Points none(0, 3);
  const Triangles no_triangles(0, 3);
  CHECK_THROWS_WITH(surface_frame(none, good.F), "the mesh has no vertices");
  CHECK_THROWS_WITH(surface_frame(good.V, no_triangles), "the mesh has no triangles");
  Soup bad = good;
  bad.V(3, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(surface_frame(bad.V, bad.F),
                    "coordinate y of vertex 3 is nan, expected a finite number");
  bad.V(3, 1) = -std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(surface_area(bad.V, bad.F),
                    "coordinate y of vertex 3 is -inf, expected a finite number");
  bad = good;
  bad.F(5, 2) = 8;
  CHECK_THROWS_WITH(check_surface(bad.V, bad.F), "triangle 5 names vertex 8, expected 0 … 7");
  bad.F(5, 2) = -1;
  CHECK_THROWS_WITH(check_surface(bad.V, bad.F), "triangle 5 names vertex -1, expected 0 … 7");
  bad = good;
  bad.V.col(0).setZero();
  bad.V.col(1).setZero();
  CHECK_THROWS_WITH(surface_frame(bad.V, bad.F),
                    "the mesh has no area: all 12 triangles are degenerate");
  bad.V.setOnes();
  CHECK(surface_area(bad.V, bad.F) == 0.0);
  const Triangles one = good.F.topRows(1);
  CHECK_THROWS_WITH(surface_frame(bad.V, one),
                    "the mesh has no area: all 1 triangle is degenerate");
  CHECK_THROWS_WITH(surface_frame(good.V, good.F, Centre::area, Scale::rms, 0.0),
                    "factor is 0, expected a positive finite number");
  CHECK_THROWS_WITH(surface_points(good.V, good.F, -1.0),
                    "max_edge is -1, expected a positive finite number");
  CHECK_THROWS_WITH(surface_points(good.V, good.F, 1e-5),
                    Catch::StartsWith("max_edge is 1e-05, expected an edge that gives fewer"));
  Soup huge = good;
  huge.V *= 1e308;
  CHECK_THROWS_WITH(surface_frame(huge.V, huge.F, Centre::area, Scale::rms, 1e6),
                    Catch::StartsWith("the radius of the ball round the mesh is inf"));
}

}  // namespace
