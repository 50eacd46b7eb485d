#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/mapping/spherical_map.hpp"
#include "support/closed_meshes.hpp"

namespace {
using namespace shape3d::mapping;
using namespace shape3d::test;

std::string refusal(const ClosedMesh& mesh, const SphericalMapOptions& options = {}) {
  try {
    (void)spherical_map(mesh.V, mesh.F, options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

/// Two meshes side by side.
ClosedMesh both(const ClosedMesh& a, const ClosedMesh& b) {
  ClosedMesh mesh{Points(a.V.rows() + b.V.rows(), 3), Triangles(a.F.rows() + b.F.rows(), 3)};
  mesh.V << a.V, b.V;
  mesh.F.topRows(a.F.rows()) = a.F;
  mesh.F.bottomRows(b.F.rows()) = (b.F.array() + static_cast<std::int32_t>(a.V.rows())).matrix();
  return mesh;
}

ClosedMesh torus(int around) {
  ClosedMesh mesh{Points(around * around, 3), Triangles(2 * around * around, 3)};
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < around; ++j) {
      const double u = 6.283185307179586 * i / around, v = 6.283185307179586 * j / around;
      mesh.V.row(i * around + j) << (2 + std::cos(v)) * std::cos(u),
          (2 + std::cos(v)) * std::sin(u), std::sin(v);
      const int a = i * around + j, b = (i + 1) % around * around + j;
      const int c = (i + 1) % around * around + (j + 1) % around, d = i * around + (j + 1) % around;
      mesh.F.row(2 * a) << a, b, c;
      mesh.F.row(2 * a + 1) << a, c, d;
    }
  }
  return mesh;
}

TEST_CASE("meshes that are no closed surface of genus 0 are refused by what they are") {
  ClosedMesh mesh = icosphere(1);
  mesh.F.conservativeResize(77, 3);
  CHECK(refusal(mesh) == "F: 5 edges belong to one triangle only; expected a closed surface");

  mesh = icosphere(1);
  mesh.F.row(5).reverseInPlace();
  CHECK(refusal(mesh) ==
        "F: 3 edges are run the same way by both triangles; expected one orientation");

  mesh = icosphere(1);
  mesh.F.conservativeResize(81, 3);
  mesh.F.row(80) = mesh.F.row(4);
  CHECK(refusal(mesh) == "F: 3 edges belong to more than two triangles; expected a manifold");

  CHECK(refusal(both(icosphere(1), icosphere(0))) == "F: 2 connected components; expected one");
  CHECK(refusal(torus(8)) == "F: genus 1 (Euler characteristic 0); expected genus 0, no handles");

  mesh = icosphere(0);
  mesh.V.conservativeResize(14, 3);
  mesh.V.bottomRows(2).setZero();
  CHECK(refusal(mesh) == "F: 2 vertices belong to no triangle; expected all to be used");

  // Two icosahedra that share a vertex.
  mesh = both(icosphere(0), icosphere(0));
  mesh.F = (mesh.F.array() == 23).select(11, mesh.F);
  mesh.V.conservativeResize(23, 3);
  CHECK(refusal(mesh) == "F: 1 vertices join several fans of triangles; expected one fan at each");

  mesh = icosphere(0);
  mesh.F(3, 1) = mesh.F(3, 0);
  CHECK(refusal(mesh) == "F: 1 triangles repeat a vertex; expected three different ones");
  mesh.F(3, 1) = 12;
  CHECK(refusal(mesh) == "F: row 3 names vertex 12; expected 0 to 11");
  mesh.F.conservativeResize(3, 3);
  CHECK(refusal(mesh) == "F: 3 triangles; expected at least 4, a tetrahedron");
  mesh.F.resize(0, 3);
  mesh.V.resize(0, 3);
  CHECK(refusal(mesh) == "F: 0 triangles; expected at least 4, a tetrahedron");
}

TEST_CASE("coordinates that are none, or no surface, are refused") {
  ClosedMesh mesh = icosphere(1);
  mesh.V(7, 2) = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal(mesh) == "V: row 7 holds nan; expected finite coordinates");
  mesh.V(7, 2) = -std::numeric_limits<double>::infinity();
  CHECK(refusal(mesh) == "V: row 7 holds -inf; expected finite coordinates");
  mesh.V.setConstant(0.25);
  CHECK(refusal(mesh) == "V: all vertices are in one place; expected a surface with area");
  mesh = icosphere(1);
  mesh.V.rightCols(2).setZero();
  CHECK(refusal(mesh) == "V, F: all triangles have zero area; expected a surface with area");
}

TEST_CASE("coordinates of any size are mapped") {
  const ClosedMesh mesh = star_shaped(2, 1);
  const SphericalMap map = spherical_map(mesh.V, mesh.F);
  for (const double scale : {1e-300, 1e30, 1e300}) {
    const SphericalMap scaled = spherical_map(scale * mesh.V, mesh.F);
    INFO("scale = " << scale);
    REQUIRE(scaled.status == Status::certified);
    CHECK((scaled.S - map.S).cwiseAbs().maxCoeff() < 1e-4);
  }
}

TEST_CASE("options out of range are refused") {
  const ClosedMesh mesh = icosphere(0);
  SphericalMapOptions options;
  options.max_iterations = 0;
  CHECK(refusal(mesh, options) == "options.max_iterations is 0; expected 1 or more");
  options = {};
  options.function_tolerance = 0;
  CHECK(refusal(mesh, options) ==
        "options.function_tolerance is 0.000000; expected a number between 0 and 1");
  options = {};
  options.area_balance = -1;
  CHECK(refusal(mesh, options) ==
        "options.area_balance is -1.000000; expected 0 or a positive number");
  options = {};
  options.pose(0, 0) = -1;
  CHECK(refusal(mesh, options) ==
        "options.pose is no rotation (determinant -1.000000); expected an orthogonal matrix of "
        "determinant 1");
  options.pose(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal(mesh, options).find("options.pose is no rotation") == 0);
}

TEST_CASE("each status has a sentence of its own") {
  std::vector<std::string> sentences;
  for (const Status status : {Status::certified, Status::tangled, Status::wrong_degree,
                              Status::crowded, Status::solver_failed, Status::cancelled}) {
    sentences.emplace_back(to_string(status));
    CHECK_FALSE(sentences.back().empty());
    CHECK(std::count(sentences.begin(), sentences.end(), sentences.back()) == 1);
  }
}

}  // namespace
