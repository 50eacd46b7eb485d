#include "shape3d/mapping/repair.hpp"

#include <array>
#include <limits>
#include <random>
#include <set>

#include <catch2/catch.hpp>

#include "bodies.hpp"

namespace {
using namespace shape3d::mapping;
using namespace shape3d::mapping::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

Triangles without_rows(const Triangles& F, Eigen::Index first, Eigen::Index count) {
  Triangles rest(F.rows() - count, 3);
  rest << F.topRows(first), F.bottomRows(F.rows() - first - count);
  return rest;
}

using Position = std::array<double, 3>;
std::set<Position> positions(const Points& V) {
  std::set<Position> result;
  for (Eigen::Index v = 0; v < V.rows(); ++v) result.insert({V(v, 0), V(v, 1), V(v, 2)});
  return result;
}

TEST_CASE("a whole mesh stays as it is", "[mapping][repair]") {
  const Body ball = sphere(2);
  const Repaired result = repair(ball.V, ball.F);
  CHECK(result.after.spherical());
  CHECK_FALSE(result.cancelled);
  CHECK(result.F.rows() == ball.F.rows());
  CHECK(positions(result.V) == positions(ball.V));
  CHECK_THAT(to_sentence(result.summary), Equals("nothing had to be repaired"));
}

TEST_CASE("holes are filled, whatever the scale", "[mapping][repair]") {
  for (const double scale : {1e-100, 1.0, 1e30, 1e100}) {
    INFO(scale);
    const Body ball = sphere(2);
    const Points V = scale * ball.V;
    const Triangles F = without_rows(without_rows(ball.F, 200, 4), 10, 1);
    const Repaired result = repair(V, F);
    CHECK(result.after.spherical());
    CHECK(result.summary.filled_holes == 2);
    CHECK(result.summary.unfilled_holes == 0);
    CHECK(result.F.rows() == F.rows() + result.summary.filling_triangles);
    for (const Position& p : positions(result.V)) CHECK(positions(V).count(p) == 1);  // to the bit
    CHECK_THAT(to_sentence(result.summary), Contains("filled 2 holes with "));
  }
}

TEST_CASE("all defects of a soup at once", "[mapping][repair]") {
  // A ball of which each triangle has vertices of its own, some turned, some double, one
  // degenerate, with a small second ball, a hole and loose vertices.
  std::mt19937 random(2);
  const Body ball = sphere(2), small = sphere(0);
  const Triangles open = without_rows(ball.F, 48, 4);  // four in a triangle
  const Eigen::Index n = open.rows();
  Points V(3 * n + small.V.rows() + 2, 3);
  Triangles F(n + small.F.rows() + 3, 3);
  for (Eigen::Index t = 0; t < n; ++t) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      V.row(3 * t + i) = ball.V.row(open(t, i));
      F(t, i) = static_cast<std::int32_t>(3 * t + i);
    }
    if (random() % 3 == 0) F.row(t).reverseInPlace();
  }
  V.middleRows(3 * n, small.V.rows()) = small.V.rowwise() + Eigen::RowVector3d(9, 0, 0);
  V.bottomRows(2).setRandom();
  F.middleRows(n, small.F.rows()) = small.F.array() + static_cast<std::int32_t>(3 * n);
  F.row(n + small.F.rows()) = F.row(4);
  F.row(n + small.F.rows() + 1) << F(6, 2), F(6, 1), F(6, 0);
  F.row(n + small.F.rows() + 2) << 8, 8, 9;
  const Repaired result = repair(V, F);
  CHECK(result.after.spherical());
  CHECK(result.after.volume.value_or(-1) > 0);
  CHECK(result.V.rows() == ball.V.rows());
  CHECK(result.F.rows() == ball.F.rows());
  const RepairSummary& summary = result.summary;
  CHECK(summary.merged_vertices == 3 * n - ball.V.rows());
  CHECK(summary.removed_vertices == 2);
  CHECK(summary.removed_degenerate == 1);
  CHECK(summary.removed_duplicates == 2);
  CHECK(summary.removed_components == 1);
  CHECK(summary.removed_component_triangles == 20);
  CHECK(summary.filled_holes == 1);
  CHECK(summary.filling_triangles == 4);
  CHECK(summary.turned_triangles > 0);
  CHECK_THAT(to_sentence(summary),
             Contains("removed 2 isolated vertices, removed 1 degenerate triangle, removed 2 "
                      "duplicate triangles") &&
                 Contains("removed 1 component of 20 triangles, filled 1 hole with 4 triangles"));
}

TEST_CASE("sheets that meet in a vertex are parted", "[mapping][repair]") {
  const Body ball = sphere(1);
  Points V(2 * ball.V.rows() - 1, 3);
  Triangles F(2 * ball.F.rows(), 3);
  const Points mirrored = (-ball.V).rowwise() + Eigen::RowVector3d(2.0 * ball.V.row(0));
  V << ball.V, mirrored.bottomRows(ball.V.rows() - 1);
  F.topRows(ball.F.rows()) = ball.F;
  for (Eigen::Index t = 0; t < ball.F.rows(); ++t) {
    for (Eigen::Index i = 0; i < 3; ++i) {  // mirrored at vertex 0
      const std::int32_t v = ball.F(t, 2 - i);
      F(ball.F.rows() + t, i) = v == 0 ? 0 : v + static_cast<std::int32_t>(ball.V.rows()) - 1;
    }
  }
  REQUIRE(inspect(V, F).nonmanifold_vertices == 1);
  const Repaired result = repair(V, F);
  CHECK(result.after.spherical());
  CHECK(result.summary.separated_vertices == 1);
  CHECK(result.summary.removed_components == 1);
  RepairOptions options;
  options.keep_largest = false;
  const Repaired both = repair(V, F, options);
  CHECK(both.after.components == 2);
  CHECK(both.after.nonmanifold_vertices == 0);
  CHECK_THAT(to_sentence(both.summary), Contains("made 1 copy of a vertex to part sheets"));
}

TEST_CASE("a surface that is inside out is turned", "[mapping][repair]") {
  Body ball = sphere(1);
  ball.F.rowwise().reverseInPlace();
  const Repaired result = repair(ball.V, ball.F);
  CHECK(*result.after.volume > 0);
  CHECK(result.summary.turned_inside_out);
  CHECK_THAT(to_sentence(result.summary), Equals("turned the surface inside out"));
}

TEST_CASE("repair leaves what it is told to leave, and handles", "[mapping][repair]") {
  const Body ring = torus(2, 0.5, 24, 11);
  const Triangles open = without_rows(ring.F, 4, 2);
  RepairOptions options;
  options.fill_holes = false;
  CHECK(repair(ring.V, open, options).after.boundary_loops == 1);
  const Repaired closed = repair(ring.V, open);
  CHECK(closed.after.closed());
  CHECK(closed.after.genus == 1);
  CHECK_FALSE(closed.after.spherical());
  CHECK_THAT(closed.after.why_not_spherical("--repair", "--wrap"), Contains("--wrap makes"));
}

TEST_CASE("repair can be cancelled", "[mapping][repair]") {
  const Body ball = sphere(1);
  int calls = 0;
  double last = -1.0;
  RepairOptions options;
  options.progress = [&](double share) {
    CHECK(share >= last);
    CHECK(share <= 1.0);
    last = share;
    return ++calls < 3;
  };
  const Repaired result = repair(ball.V, ball.F, options);
  CHECK(result.cancelled);
  CHECK(calls == 3);
  CHECK(result.V.rows() + result.F.rows() == 0);
}

TEST_CASE("repair refuses what is no mesh", "[mapping][repair][contract]") {
  const Body ball = sphere(0);
  Triangles wrong = ball.F;
  wrong(2, 2) = 12;
  CHECK_THROWS_WITH(repair(ball.V, wrong), Contains("F: 1 row has an index outside 0 to 11"));
  Points hole = ball.V;
  hole(1, 1) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(repair(hole, ball.F), Contains("V: 1 row is not finite"));
  Triangles flat(2, 3);
  flat << 0, 0, 1, 2, 3, 3;
  CHECK_THROWS_WITH(repair(ball.V, flat),
                    Equals("F: none of the 2 triangles has three different vertices"));
}

}  // namespace
