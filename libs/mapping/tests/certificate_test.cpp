#include "shape3d/mapping/certificate.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::mapping;

constexpr double kFourPi = 12.566370614359172954;

struct Mesh {
  Points V;
  Triangles F;
};

Mesh octahedron() {
  Mesh mesh{Points(6, 3), Triangles(8, 3)};
  mesh.V << 1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1;
  mesh.F << 0, 1, 2, 1, 3, 2, 3, 4, 2, 4, 0, 2, 1, 0, 5, 3, 1, 5, 4, 3, 5, 0, 4, 5;
  return mesh;
}

TEST_CASE("the octahedron is a bijection of degree 1") {
  const Mesh mesh = octahedron();
  const Certificate c = certify(mesh.V, mesh.F);
  CHECK(c.bijective());
  CHECK(c.degree == 1);
  CHECK(c.total_solid_angle == Approx(kFourPi).epsilon(1e-14));
}

TEST_CASE("turned inside out, all triangles are flipped and the degree is -1") {
  Mesh mesh = octahedron();
  mesh.V *= -1;
  const Certificate c = certify(mesh.V, mesh.F);
  CHECK_FALSE(c.bijective());
  CHECK(c.flipped == 8);
  CHECK(c.degree == -1);
  CHECK(c.total_solid_angle == Approx(-kFourPi).epsilon(1e-14));
}

TEST_CASE("a vertex moved across an edge flips a triangle, onto it makes one degenerate") {
  // Vertex 6 divides triangle (0, 1, 2) in three.
  Mesh mesh = octahedron();
  mesh.V.conservativeResize(7, 3);
  mesh.V.row(6) << 1, 1, 1;
  mesh.F.conservativeResize(10, 3);
  mesh.F.row(0) << 0, 1, 6;
  mesh.F.row(8) << 1, 2, 6;
  mesh.F.row(9) << 2, 0, 6;
  CHECK(certify(mesh.V, mesh.F).bijective());
  mesh.V.row(6) << 0, 1, 1;  // on the edge from 1 to 2
  Certificate c = certify(mesh.V, mesh.F);
  CHECK(c.degenerate == 1);
  CHECK(c.flipped == 0);
  CHECK_FALSE(c.bijective());
  mesh.V.row(6) << 1e-300, 1, 1;  // a hair inside it: exact arithmetic tells
  CHECK(certify(mesh.V, mesh.F).bijective());
  mesh.V.row(6) << -1e-300, 1, 1;  // a hair beyond it
  c = certify(mesh.V, mesh.F);
  CHECK(c.degenerate == 0);
  CHECK(c.flipped == 1);
  CHECK(c.degree == 1);
  CHECK_FALSE(c.bijective());
}

TEST_CASE("a double cover has no flipped triangle and degree 2") {
  // z -> z^2 about the axis: 8 meridians wound round the sphere twice, with the poles as branch
  // points. Every triangle keeps its orientation.
  constexpr int kMeridians = 8;
  Mesh mesh{Points(kMeridians + 2, 3), Triangles(2 * kMeridians, 3)};
  for (int i = 0; i < kMeridians; ++i) {
    const double angle = kFourPi * i / kMeridians;
    mesh.V.row(i) << std::cos(angle), std::sin(angle), 0.1;
    const int next = (i + 1) % kMeridians;
    mesh.F.row(2 * i) << i, next, kMeridians;
    mesh.F.row(2 * i + 1) << next, i, kMeridians + 1;
  }
  mesh.V.row(kMeridians) << 0, 0, 1;
  mesh.V.row(kMeridians + 1) << 0, 0, -1;
  const Certificate c = certify(mesh.V, mesh.F);
  CHECK(c.flipped == 0);
  CHECK(c.degenerate == 0);
  CHECK(c.degree == 2);
  CHECK(c.total_solid_angle == Approx(2 * kFourPi));
  CHECK_FALSE(c.bijective());
}

TEST_CASE("the certificate refuses what has no direction") {
  Mesh mesh = octahedron();
  mesh.V.row(3).setZero();
  CHECK_THROWS_WITH(certify(mesh.V, mesh.F), "S: row 3 is zero; expected a direction");
  mesh.V(3, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(certify(mesh.V, mesh.F), "S: row 3 holds nan; expected finite coordinates");
  mesh = octahedron();
  mesh.F(2, 1) = 6;
  CHECK_THROWS_WITH(certify(mesh.V, mesh.F), "F: row 2 names vertex 6; expected 0 to 5");
}

}  // namespace
