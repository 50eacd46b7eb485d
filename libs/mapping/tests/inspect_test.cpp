#include "shape3d/mapping/inspect.hpp"

#include <limits>
#include <random>

#include <catch2/catch.hpp>

#include "bodies.hpp"

namespace {
using namespace shape3d::mapping;
using namespace shape3d::mapping::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

const Finding* find(const Inspection& inspection, Defect defect) {
  for (const Finding& finding : inspection.findings)
    if (finding.defect == defect) return &finding;
  return nullptr;
}

Body tetrahedron() {
  Body body;
  body.V.resize(4, 3);
  body.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  body.F.resize(4, 3);
  body.F << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3;
  return body;
}

Triangles without_rows(const Triangles& F, Eigen::Index first, Eigen::Index count) {
  Triangles rest(F.rows() - count, 3);
  rest << F.topRows(first), F.bottomRows(F.rows() - first - count);
  return rest;
}

// Two bodies in one, the second moved by `offset`.
Body together(const Body& a, const Body& b, const Eigen::RowVector3d& offset) {
  Body both;
  both.V.resize(a.V.rows() + b.V.rows(), 3);
  both.V << a.V, b.V.rowwise() + offset;
  both.F.resize(a.F.rows() + b.F.rows(), 3);
  both.F << a.F, b.F.array() + static_cast<std::int32_t>(a.V.rows());
  return both;
}

TEST_CASE("closed surfaces of each genus", "[mapping][inspect]") {
  const Body ball = sphere(2);
  const Inspection sphere_found = inspect(ball.V, ball.F);
  CHECK(sphere_found.spherical());
  CHECK(sphere_found.findings.empty());
  CHECK(sphere_found.why_not_spherical().empty());
  CHECK(sphere_found.edges == 480);
  CHECK(sphere_found.euler == 2);
  CHECK(sphere_found.genus == 0);
  CHECK(sphere_found.components == 1);
  CHECK(*sphere_found.volume == Approx(4.18879).epsilon(0.05));
  CHECK(sphere_found.area == Approx(12.566).epsilon(0.05));

  const Body ring = torus(2, 0.5, 12, 7);
  const Inspection torus_found = inspect(ring.V, ring.F);
  CHECK_FALSE(torus_found.spherical());
  CHECK(torus_found.genus == 1);
  CHECK(torus_found.euler == 0);
  CHECK_THAT(torus_found.why_not_spherical("--repair", "--wrap"),
             Equals("genus 1: the body has 1 handle, and only genus 0 can be mapped to a sphere; "
                    "--wrap makes a surface of genus 0 round it"));
}

TEST_CASE("the smallest closed surface is accepted, three triangles are not",
          "[mapping][inspect]") {
  const Body body = tetrahedron();
  CHECK(inspect(body.V, body.F).spherical());
  const Inspection open = inspect(body.V, body.F.topRows(3));
  CHECK_FALSE(open.spherical());
  CHECK_THAT(open.why_not_spherical(),
             Contains("3 triangles: a closed surface has 4 at least, as the tetrahedron") &&
                 Contains("1 boundary loop of 3 edges in all"));
  const Inspection nothing = inspect(Points(0, 3), Triangles(0, 3));
  CHECK_FALSE(nothing.spherical());
  CHECK_FALSE(nothing.closed());
  CHECK_THAT(nothing.why_not_spherical(), Contains("0 triangles: a closed surface has 4 at least"));
}

TEST_CASE("boundary loops are counted, also those that touch", "[mapping][inspect]") {
  const Body ball = sphere(2);
  const Inspection one = inspect(ball.V, without_rows(ball.F, 7, 1));
  CHECK(one.boundary_loops == 1);
  CHECK(one.boundary_edges == 3);
  CHECK(one.genus == 0);
  CHECK_THAT(find(one, Defect::boundary_loop)->sentence,
             Contains("the surface is open: 1 boundary loop of 3 edges in all, the first between"));
  // Two triangles that share a vertex alone: two loops there, each of its own fan of triangles.
  const auto touching = [&ball] {
    for (Eigen::Index t = 1; t < ball.F.rows(); ++t) {
      int shared = 0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) shared += ball.F(0, i) == ball.F(t, j) ? 1 : 0;
      if (shared == 1) return t;
    }
    return Eigen::Index{-1};
  }();
  REQUIRE(touching > 0);
  const Inspection two = inspect(ball.V, without_rows(without_rows(ball.F, touching, 1), 0, 1));
  CHECK(two.boundary_edges == 6);
  CHECK(two.nonmanifold_vertices == 1);
  CHECK(two.boundary_loops == 1);  // the two fans at the vertex link them in a figure of eight
  const Inspection tube = [] {
    Body ring = torus(2, 0.5, 12, 7);
    return inspect(ring.V, without_rows(without_rows(ring.F, 100, 1), 3, 1));
  }();
  CHECK(tube.boundary_loops == 2);
  CHECK(tube.genus == 1);
}

TEST_CASE("several components", "[mapping][inspect]") {
  const Body both = together(sphere(2), sphere(1), {5, 0, 0});
  const Inspection found = inspect(both.V, both.F);
  CHECK(found.components == 2);
  CHECK(found.euler == 4);
  CHECK(found.genus == 0);
  CHECK_THAT(found.why_not_spherical("--repair", "--wrap"),
             Equals("2 separate components, the largest of 320 triangles; --repair keeps the "
                    "largest"));
}

TEST_CASE("bodies that touch in a vertex or an edge are not manifold", "[mapping][inspect]") {
  const Body a = tetrahedron();
  Body both = together(a, a, {0, 0, 0});
  Triangles F = both.F;
  for (Eigen::Index t = 4; t < 8; ++t)
    for (int i = 0; i < 3; ++i)
      if (F(t, i) == 4) F(t, i) = 0;  // the vertices 0 are one
  Inspection found = inspect(both.V, F);
  CHECK(found.nonmanifold_vertices == 1);
  CHECK(found.nonmanifold_edges == 0);
  CHECK_FALSE(found.genus.has_value());
  CHECK_THAT(find(found, Defect::nonmanifold_vertex)->sentence,
             Equals("1 vertex joins more than one sheet of triangles, the first is row 0"));
  for (Eigen::Index t = 4; t < 8; ++t)
    for (int i = 0; i < 3; ++i)
      if (F(t, i) == 5) F(t, i) = 1;  // and the edge 0 1
  found = inspect(both.V, F);
  CHECK(found.nonmanifold_edges == 1);
  CHECK_THAT(find(found, Defect::nonmanifold_edge)->sentence,
             Equals("1 edge has more than two triangles, the first between vertices 0 and 1"));
  CHECK(find(found, Defect::isolated_vertex)->count == 2);
}

TEST_CASE("orientation", "[mapping][inspect]") {
  Body ball = sphere(1);
  ball.F.row(11).reverseInPlace();
  const Inspection one = inspect(ball.V, ball.F);
  CHECK(one.misoriented_edges == 3);
  CHECK(one.orientable);
  CHECK_THAT(one.why_not_spherical("--repair", "--wrap"),
             Contains("3 edges have two triangles that are oriented against each other") &&
                 Contains("--repair turns the triangles"));
  Body inside_out = sphere(1);
  inside_out.F.rowwise().reverseInPlace();
  const Inspection inside = inspect(inside_out.V, inside_out.F);
  CHECK(inside.spherical());  // a warning
  CHECK(*inside.volume < 0);
  REQUIRE(find(inside, Defect::inside_out) != nullptr);
  CHECK_FALSE(find(inside, Defect::inside_out)->blocking);
  CHECK_THAT(find(inside, Defect::inside_out)->sentence, Contains("clockwise seen from outside"));
}

TEST_CASE("a strip with one side cannot be oriented", "[mapping][inspect]") {
  // The Möbius strip of five triangles.
  Points V = Points::Random(5, 3);
  Triangles F(5, 3);
  F << 0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 0, 4, 4, 0, 1;
  const Inspection found = inspect(V, F);
  CHECK_FALSE(found.orientable);
  CHECK(found.boundary_loops == 1);
  CHECK(found.euler == 0);
  CHECK_FALSE(found.genus.has_value());
  CHECK_THAT(found.why_not_spherical("--repair", "--wrap"),
             Contains("has only one side") && Contains("--wrap makes a closed surface round it"));
}

TEST_CASE("degenerate and duplicate triangles, isolated vertices", "[mapping][inspect]") {
  const Body ball = sphere(1);
  Triangles F(ball.F.rows() + 4, 3);
  F.topRows(ball.F.rows()) = ball.F;
  F.row(ball.F.rows()) << 3, 3, 5;
  F.row(ball.F.rows() + 1) = ball.F.row(8);
  F.row(ball.F.rows() + 2) = ball.F.row(8).reverse();
  F.row(ball.F.rows() + 3) << ball.F(9, 1), ball.F(9, 2), ball.F(9, 0);
  Points V(ball.V.rows() + 2, 3);
  V << ball.V, Points::Random(2, 3);
  const Inspection found = inspect(V, F);
  CHECK(found.degenerate_triangles == 1);
  CHECK(found.duplicate_triangles == 3);
  CHECK(found.isolated_vertices == 2);
  CHECK(found.euler == 2);  // all else is as before
  CHECK(found.boundary_edges + found.nonmanifold_edges + found.nonmanifold_vertices == 0);
  CHECK_THAT(
      found.why_not_spherical("--repair", "--wrap"),
      Equals("1 degenerate triangle names a vertex twice, the first is row 80; --repair removes "
             "them; 3 triangles have the same three vertices as an earlier one, the first is row "
             "81; --repair removes them; 2 vertices are in no triangle, the first is row 42; "
             "--repair removes them"));
}

TEST_CASE("bad numbers", "[mapping][inspect]") {
  const Body ball = sphere(1);
  Points V = ball.V;
  V(4, 2) = std::numeric_limits<double>::quiet_NaN();
  V(6, 0) = std::numeric_limits<double>::infinity();
  const Inspection broken = inspect(V, ball.F);
  CHECK_FALSE(broken.spherical());
  CHECK_THAT(broken.why_not_spherical(),
             Equals("2 vertices have a coordinate that is not a finite number, the first is row 4; "
                    "the mesh is damaged and has to be made anew"));
  Triangles F = ball.F;
  F(3, 1) = 42;
  F(5, 2) = -1;
  CHECK_THAT(inspect(ball.V, F).why_not_spherical(),
             Contains("2 triangles name a vertex that is not among the 42, the first is row 3"));
  const Inspection flat = inspect(0.0 * ball.V, ball.F);
  CHECK_FALSE(flat.spherical());
  CHECK_THAT(flat.why_not_spherical(), Contains("the area of all triangles together is zero"));
}

TEST_CASE("triangles without area are a warning", "[mapping][inspect]") {
  Body body = sphere(1);
  // A vertex on the middle of an edge, with two triangles there: one of them flat.
  Points V(body.V.rows() + 1, 3);
  const std::int32_t a = body.F(0, 0), b = body.F(0, 1), c = body.F(0, 2),
                     m = static_cast<std::int32_t>(body.V.rows());
  V << body.V, 0.5 * (body.V.row(a) + body.V.row(b));
  Triangles F(body.F.rows() + 2, 3);
  F << body.F.bottomRows(body.F.rows() - 1), Triangles::Zero(3, 3);
  F.bottomRows(3) << a, m, c, m, b, c, a, b, m;
  const Inspection found = inspect(V, F);
  CHECK(found.zero_area_triangles == 1);
  CHECK(found.spherical());
  const Finding* finding = find(found, Defect::zero_area_triangle);
  REQUIRE(finding != nullptr);
  CHECK_THAT(to_sentence(*finding, "--repair", "--wrap"),
             Equals("1 triangle has its corners on a line, the first is row 81; their angles "
                    "cannot be kept by any map"));
}

TEST_CASE("measures hold at all scales", "[mapping][inspect]") {
  const Body ball = sphere(3);
  const Inspection unit = inspect(ball.V, ball.F);
  for (const double scale : {1e-90, 1e-6, 1e6, 1e30, 1e90}) {
    INFO(scale);
    const Inspection found = inspect(scale * ball.V, ball.F);
    CHECK(found.spherical());
    CHECK(found.zero_area_triangles == 0);
    CHECK(found.area == Approx(unit.area * scale * scale));
    CHECK(*found.volume == Approx(*unit.volume * scale * scale * scale));
  }
}

TEST_CASE("counts do not depend on the order of vertices and triangles", "[mapping][inspect]") {
  std::mt19937 random(8);
  Body both = together(torus(2, 0.5, 20, 9), sphere(2), {0, 5, 0});
  both.F = without_rows(both.F, 33, 2);
  const Inspection before = inspect(both.V, both.F);
  const Body mixed = shuffled(both, random);
  const Inspection after = inspect(mixed.V, mixed.F);
  CHECK(before.edges == after.edges);
  CHECK(before.euler == after.euler);
  CHECK(before.genus == after.genus);
  CHECK(before.boundary_loops == after.boundary_loops);
  CHECK(before.components == after.components);
  CHECK(before.area == Approx(after.area));
}

TEST_CASE("self-intersections are pairs of triangles", "[mapping][inspect]") {
  const Body ball = sphere(2);
  InspectOptions options;
  options.self_intersections = true;
  CHECK(inspect(ball.V, ball.F, options).self_intersections == 0);
  CHECK_FALSE(inspect(ball.V, ball.F).self_intersections.has_value());
  // Two triangles that cross: one pair.
  Points V(6, 3);
  V << 0, 0, 0, 2, 0, 0, 0, 2, 0, 0.5, 0.5, -1, 0.5, 0.5, 1, 3, 3, 0.5;
  Triangles F(2, 3);
  F << 0, 1, 2, 3, 4, 5;
  CHECK(count_self_intersections(V, F) == 1);
  const Inspection found = inspect(V, F, options);
  REQUIRE(find(found, Defect::self_intersection) != nullptr);
  CHECK_THAT(to_sentence(*find(found, Defect::self_intersection), "--repair", "--wrap"),
             Equals("1 pair of triangles cuts through each other; --wrap makes a surface without "
                    "round it"));
  for (const double scale : {1e-30, 1e30}) CHECK(count_self_intersections(scale * V, F) == 1);
  V(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(count_self_intersections(V, F), Contains("V: 1 row is not finite"));
  F(0, 0) = 9;
  CHECK_THROWS_WITH(count_self_intersections(V, F), Contains("F: 1 row has an index outside"));
}

TEST_CASE("each defect has a name", "[mapping][inspect]") {
  for (int i = 0; i <= static_cast<int>(Defect::self_intersection); ++i) {
    const std::string name(to_string(static_cast<Defect>(i)));
    CHECK_FALSE(name.empty());
    CHECK(name != "unknown defect");
  }
}

}  // namespace
