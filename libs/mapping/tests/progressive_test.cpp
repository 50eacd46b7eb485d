#include "shape3d/mapping/progressive.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "bodies.hpp"
#include "shape3d/mapping/inspect.hpp"

namespace {
using namespace shape3d::mapping;
using namespace shape3d::mapping::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

constexpr CollapseCost kCosts[] = {CollapseCost::quadrics, CollapseCost::lindstrom_turk,
                                   CollapseCost::hoppe};

bool same_bits(const Points& a, const Points& b) {
  return a.rows() == b.rows() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

// A bumpy body without symmetry, shuffled, with coordinates that fill all 53 bits.
Body bumpy(int level) {
  std::mt19937 random(4);
  Body body = shuffled(sphere(level), random);
  for (Eigen::Index v = 0; v < body.V.rows(); ++v) {
    const Eigen::RowVector3d u = body.V.row(v);
    body.V.row(v) *= 1.1 + 0.3 * std::sin(3 * u[0] + 1) * std::cos(4 * u[1]) + 0.2 * u[2];
  }
  return body;
}

TEST_CASE("the finest level is the mesh, to the bit", "[mapping][progressive]") {
  for (const CollapseCost cost : kCosts) {
    INFO(to_string(cost));
    const Body body = bumpy(3);
    ProgressiveOptions options;
    options.cost = cost;
    ProgressiveMesh mesh(body.V, body.F, options);
    CHECK(mesh.is_complete());
    CHECK(mesh.finest() == body.F.rows());
    CHECK(mesh.triangle_count() == body.F.rows());
    CHECK(same_bits(mesh.V(), body.V));
    CHECK(mesh.F() == body.F);
    CHECK(mesh.coarsest() < 40);
    // Down and up in leaps, then every level is as it was on the way down.
    std::mt19937 random(1);
    for (int leap = 0; leap < 30; ++leap)
      mesh.set_triangle_count(static_cast<std::int64_t>(random() % 1400));
    mesh.set_triangle_count(100000);
    CHECK(same_bits(mesh.V(), body.V));
    CHECK(mesh.F() == body.F);
  }
}

TEST_CASE("every level is a closed manifold of the same topology", "[mapping][progressive]") {
  for (const CollapseCost cost : kCosts) {
    INFO(to_string(cost));
    ProgressiveOptions options;
    options.cost = cost;
    const Body body = bumpy(2), ring = torus(2, 0.8, 24, 12);
    ProgressiveMesh mesh(body.V, body.F, options), ring_mesh(ring.V, ring.F, options);
    std::vector<std::pair<Points, Triangles>> levels;
    for (std::int64_t n = mesh.finest(); n >= mesh.coarsest(); n -= 2) {
      mesh.set_triangle_count(n);
      const Inspection found = inspect(mesh.V(), mesh.F());
      REQUIRE(mesh.triangle_count() == n);
      REQUIRE(found.spherical());
      REQUIRE(mesh.vertex_count() == 2 + n / 2);
      levels.emplace_back(mesh.V(), mesh.F());
    }
    for (std::int64_t n = mesh.coarsest(); n <= mesh.finest(); n += 2) {
      mesh.set_triangle_count(n);
      const auto& [V, F] = levels[static_cast<std::size_t>((mesh.finest() - n) / 2)];
      REQUIRE(same_bits(mesh.V(), V));
      REQUIRE(mesh.F() == F);
    }
    ring_mesh.set_triangle_count(0);
    const Inspection found = inspect(ring_mesh.V(), ring_mesh.F());
    CHECK(found.genus == 1);
    CHECK(found.closed());
    CHECK(ring_mesh.coarsest() >= 14);  // the torus has no triangulation of fewer
    CHECK(ring_mesh.coarsest() < 60);
  }
}

TEST_CASE("meshes with a boundary and of several pieces", "[mapping][progressive]") {
  for (const CollapseCost cost : kCosts) {
    INFO(to_string(cost));
    ProgressiveOptions options;
    options.cost = cost;
    Body sheet = patch(12, [](double x, double y) { return 0.3 * std::sin(2 * x + y); });
    Triangles holed(sheet.F.rows() - 2, 3);
    holed << sheet.F.topRows(100), sheet.F.bottomRows(sheet.F.rows() - 102);
    const Body ball = sphere(1);
    Points V(sheet.V.rows() + ball.V.rows(), 3);
    V << sheet.V, ball.V.rowwise() + Eigen::RowVector3d(0, 0, 4);
    Triangles F(holed.rows() + ball.F.rows(), 3);
    F << holed, ball.F.array() + static_cast<std::int32_t>(sheet.V.rows());
    ProgressiveMesh mesh(V, F, options);
    CHECK(mesh.coarsest() < 80);
    for (std::int64_t n = mesh.finest(); n >= mesh.coarsest(); --n) {
      mesh.set_triangle_count(n);
      const Inspection found = inspect(mesh.V(), mesh.F());
      REQUIRE(mesh.triangle_count() <= n);
      REQUIRE(found.components == 2);
      REQUIRE(found.boundary_loops == 2);
      REQUIRE(found.genus == 0);
      REQUIRE(found.misoriented_edges + found.nonmanifold_edges + found.isolated_vertices == 0);
    }
    mesh.set_triangle_count(mesh.finest());
    CHECK(same_bits(mesh.V(), V));
    CHECK(mesh.F() == F);
  }
}

TEST_CASE("a flat sheet stays flat and keeps its border", "[mapping][progressive]") {
  const Body sheet = patch(16, [](double x, double y) { return x + 2 * y; });
  for (const CollapseCost cost : kCosts) {
    INFO(to_string(cost));
    ProgressiveOptions options;
    options.cost = cost;
    ProgressiveMesh mesh(sheet.V, sheet.F, options);
    mesh.set_triangle_count(60);
    const Points V = mesh.V();
    CHECK((V.col(2) - V.col(0) - 2 * V.col(1)).cwiseAbs().maxCoeff() < 1e-5);
    CHECK(V.col(0).maxCoeff() == Approx(1.0).epsilon(0.02));
    CHECK(inspect(V, mesh.F()).area == Approx(4 * std::sqrt(6.0)).epsilon(0.05));
  }
}

TEST_CASE("coarse levels stay near the surface", "[mapping][progressive]") {
  // n equal triangles of side s have n √3 s² / 4 = 4π, and their middles are s² / 6 below the
  // sphere.
  const Body ball = sphere(3);
  for (const CollapseCost cost : kCosts) {
    INFO(to_string(cost));
    ProgressiveOptions options;
    options.cost = cost;
    ProgressiveMesh mesh(ball.V, ball.F, options);
    double previous = 0.0;
    for (const std::int64_t n : {80, 320}) {
      mesh.set_triangle_count(n);
      const double sagitta = 16 * 3.14159 / (std::sqrt(3.0) * static_cast<double>(n)) / 6;
      const double error = distance_to_mesh(ball.V, mesh.V(), mesh.F());
      INFO(n << ": " << error << " against " << sagitta);
      CHECK(error < 4 * sagitta);
      if (previous > 0.0) CHECK(error < previous / 2);  // in theory a fourth
      previous = error;
    }
  }
}

TEST_CASE("simplification commutes with scale, and does not depend on place",
          "[mapping][progressive]") {
  const Body body = bumpy(2);
  ProgressiveMesh mesh(body.V, body.F);
  mesh.set_triangle_count(100);
  for (const double scale : {std::ldexp(1.0, -200), std::ldexp(1.0, 100)}) {
    ProgressiveMesh scaled(scale * body.V, body.F);
    scaled.set_triangle_count(100);
    CHECK(scaled.F() == mesh.F());
    CHECK((scaled.V() / scale - mesh.V()).cwiseAbs().maxCoeff() == 0.0);
  }
  ProgressiveMesh far((body.V.array() + 1000.0).matrix(), body.F);
  far.set_triangle_count(100);
  CHECK(inspect(far.V(), far.F()).spherical());
  CHECK(distance_to_mesh((far.V().array() - 1000.0).matrix(), body.V, body.F) < 0.2);
}

TEST_CASE("vertices keep their rows", "[mapping][progressive]") {
  const Body body = bumpy(2);
  ProgressiveMesh mesh(body.V, body.F);
  mesh.set_triangle_count(120);
  const std::vector<std::int32_t> rows = mesh.vertex_rows();
  CHECK(static_cast<std::int64_t>(rows.size()) == mesh.vertex_count());
  CHECK(std::is_sorted(rows.begin(), rows.end()));
  const Points V = mesh.V();
  int unmoved = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double moved = (V.row(static_cast<Eigen::Index>(i)) - body.V.row(rows[i])).norm();
    CHECK(moved < 1.0);
    unmoved += moved == 0.0 ? 1 : 0;
  }
  CHECK(unmoved < mesh.vertex_count());
}

TEST_CASE("copies are independent", "[mapping][progressive]") {
  const Body body = bumpy(1);
  ProgressiveMesh mesh(body.V, body.F), copy(mesh), assigned(body.V, body.F);
  copy.set_triangle_count(20);
  CHECK(mesh.triangle_count() == 80);
  CHECK(copy.triangle_count() == 20);
  assigned = copy;
  assigned.set_triangle_count(80);
  CHECK(copy.triangle_count() == 20);
  CHECK(same_bits(assigned.V(), body.V));
  const ProgressiveMesh moved(std::move(copy));
  CHECK(moved.triangle_count() == 20);
}

TEST_CASE("collapses end where they are told to, or are cancelled", "[mapping][progressive]") {
  const Body body = bumpy(3);
  ProgressiveOptions options;
  options.coarsest = 500;
  ProgressiveMesh mesh(body.V, body.F, options);
  CHECK(mesh.coarsest() == 500);
  CHECK(mesh.collapses() == 390);
  mesh.set_triangle_count(3);
  CHECK(mesh.triangle_count() == 500);
  options.coarsest = 4;
  options.progress = [](double share) {
    CHECK(share >= 0.0);
    CHECK(share <= 1.0);
    return false;
  };
  const Body large = bumpy(5);
  const ProgressiveMesh cancelled(large.V, large.F, options);
  CHECK_FALSE(cancelled.is_complete());
  CHECK(cancelled.collapses() > 0);
  CHECK(cancelled.coarsest() > 10000);
  CHECK(same_bits(cancelled.V(), large.V));
}

TEST_CASE("the tetrahedron has one level", "[mapping][progressive]") {
  Points V(4, 3);
  V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  Triangles F(4, 3);
  F << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3;
  for (const CollapseCost cost : kCosts) {
    ProgressiveOptions options;
    options.cost = cost;
    const ProgressiveMesh mesh(V, F, options);
    CHECK(mesh.coarsest() == 4);
    CHECK(mesh.F() == F);
  }
}

TEST_CASE("coincident vertices and flat triangles do no harm", "[mapping][progressive]") {
  Body body = sphere(2);
  body.V.row(body.F(0, 1)) = body.V.row(body.F(0, 0));
  body.V.row(body.F(77, 2)) = body.V.row(body.F(77, 0));
  for (const CollapseCost cost : kCosts) {
    INFO(to_string(cost));
    ProgressiveOptions options;
    options.cost = cost;
    ProgressiveMesh mesh(body.V, body.F, options);
    mesh.set_triangle_count(50);
    CHECK(mesh.triangle_count() == 50);
    CHECK(mesh.V().allFinite());
    CHECK(inspect(mesh.V(), mesh.F()).spherical());
    mesh.set_triangle_count(mesh.finest());
    CHECK(same_bits(mesh.V(), body.V));
    CHECK(mesh.F() == body.F);
  }
}

TEST_CASE("Hoppe's terms: sharp edges stay sharp", "[mapping][progressive][hoppe]") {
  // A cube on a fine grid, whose faces bulge a little so that there is something to trade.
  Body cube = cubes_meshed_twelve_ways()[4];
  for (Eigen::Index v = 0; v < cube.V.rows(); ++v) {
    const Eigen::RowVector3d p = cube.V.row(v);
    for (int axis = 0; axis < 3; ++axis) {
      const double s = p[(axis + 1) % 3], t = p[(axis + 2) % 3];
      if (std::abs(p[axis]) == 1.0) cube.V(v, axis) *= 1 + 0.1 * (1 - s * s) * (1 - t * t);
    }
  }
  ProgressiveOptions options;
  options.cost = CollapseCost::hoppe;
  ProgressiveMesh mesh(cube.V, cube.F, options);
  mesh.set_triangle_count(100);
  const Points V = mesh.V();
  // The eight corners, where three sharp edges meet, cannot move.
  int corners = 0;
  for (Eigen::Index v = 0; v < V.rows(); ++v)
    corners += V.row(v).cwiseAbs() == Eigen::RowVector3d::Ones() ? 1 : 0;
  CHECK(corners == 8);
  // The twelve edges are still chains along the edges of the cube.
  const Triangles F = mesh.F();
  double length = 0.0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Eigen::RowVector3d a = V.row(F(t, i)), b = V.row(F(t, (i + 1) % 3));
      int common = 0;  // coordinates in which both are ±1, the same
      for (int axis = 0; axis < 3; ++axis)
        common += a[axis] == b[axis] && std::abs(a[axis]) == 1.0 ? 1 : 0;
      if (common >= 2) length += (a - b).norm() / 2;  // each edge is in two triangles
    }
  }
  CHECK(length == Approx(24.0).epsilon(1e-6));
}

TEST_CASE("Hoppe's terms: springs, and attributes", "[mapping][progressive][hoppe]") {
  // On a flat sheet distances are 0 all over. Springs alone decide: the more weight, the less the
  // lengths of edges differ.
  const Body sheet = patch(20, [](double, double) { return 0.0; });
  const auto coarse = [&sheet](const HoppeOptions& hoppe) {
    ProgressiveOptions options;
    options.cost = CollapseCost::hoppe;
    options.hoppe = hoppe;
    ProgressiveMesh mesh(sheet.V, sheet.F, options);
    mesh.set_triangle_count(200);
    return std::pair(mesh.V(), mesh.F());
  };
  // Attributes: a step across x = 0. Triangles that cross it are the error; with the term there are
  // fewer, because vertices stay beside it.
  HoppeOptions plain, with_attributes;
  plain.spring_weight = with_attributes.spring_weight = 1e-3;
  Eigen::MatrixXd step(sheet.V.rows(), 1);
  for (Eigen::Index v = 0; v < sheet.V.rows(); ++v) step(v, 0) = sheet.V(v, 0) > 0.01 ? 1.0 : 0.0;
  with_attributes.attributes = step;
  const auto crossing_area = [](const std::pair<Points, Triangles>& mesh) {
    const auto& [V, F] = mesh;
    double area = 0.0;
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
      double low = 1e9, high = -1e9;
      for (int i = 0; i < 3; ++i) {
        low = std::min(low, V(F(t, i), 0));
        high = std::max(high, V(F(t, i), 0));
      }
      const Eigen::Vector3d a = V.row(F(t, 0)), b = V.row(F(t, 1)), c = V.row(F(t, 2));
      if (low < 0.0 && high > 0.1) area += 0.5 * (b - a).cross(c - a).norm();
    }
    return area;
  };
  const double without = crossing_area(coarse(plain)),
               with = crossing_area(coarse(with_attributes));
  INFO(without << " without, " << with << " with attributes");
  CHECK(with < 0.7 * without);

  const auto longest_over_mean = [](const std::pair<Points, Triangles>& mesh) {
    const auto& [V, F] = mesh;
    double sum = 0.0, most = 0.0;
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const double length = (V.row(F(t, i)) - V.row(F(t, (i + 1) % 3))).norm();
        sum += length;
        most = std::max(most, length);
      }
    }
    return most / (sum / static_cast<double>(3 * F.rows()));
  };
  HoppeOptions none;
  none.spring_weight = 0.0;
  const double loose = longest_over_mean(coarse(none)), tight = longest_over_mean(coarse(plain));
  INFO(loose << " without, " << tight << " with springs");
  CHECK(tight < loose);
}

TEST_CASE("progressive meshes refuse bad arguments", "[mapping][progressive][contract]") {
  const Body ball = sphere(1);
  const auto refused = [&ball](auto change, const char* message) {
    ProgressiveOptions options;
    change(options);
    CHECK_THROWS_WITH(ProgressiveMesh(ball.V, ball.F, options), StartsWith(message));
  };
  refused([](ProgressiveOptions& o) { o.coarsest = 0; }, "options.coarsest: expected 1 at least");
  refused([](ProgressiveOptions& o) { o.hoppe.distance_weight = -1; },
          "options.hoppe.distance_weight: expected 0 at least");
  refused([](ProgressiveOptions& o) { o.hoppe.spring_weight = std::nan(""); },
          "options.hoppe.spring_weight");
  refused([](ProgressiveOptions& o) { o.hoppe.scalar_weight = -1; }, "options.hoppe.scalar_weight");
  refused([](ProgressiveOptions& o) { o.hoppe.discontinuity_weight = -1; },
          "options.hoppe.discontinuity_weight");
  refused([](ProgressiveOptions& o) { o.hoppe.sharp_angle = 4; },
          "options.hoppe.sharp_angle: expected 0 to pi");
  refused([](ProgressiveOptions& o) { o.hoppe.attributes.setZero(5, 1); },
          "options.hoppe.attributes: expected 42 rows, got 5");
  refused([](ProgressiveOptions& o) { o.hoppe.attributes.setConstant(42, 1, std::nan("")); },
          "options.hoppe.attributes: a value is not finite");
  Body broken = ball;
  broken.F.row(3).reverseInPlace();
  CHECK_THROWS_WITH(ProgressiveMesh(broken.V, broken.F),
                    StartsWith("V, F: 3 edges have two triangles that are oriented against"));
  broken = ball;
  broken.V(1, 1) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(ProgressiveMesh(broken.V, broken.F), Contains("not a finite number"));
  CHECK_THROWS_WITH(ProgressiveMesh(ball.V, Triangles(0, 3)), Contains("0 triangles"));
  CHECK_THROWS_WITH(ProgressiveMesh(ball.V, ball.F.topRows(9)), Contains("are in no triangle"));
  ProgressiveMesh mesh(ball.V, ball.F);
  CHECK_THROWS_WITH(mesh.set_triangle_count(-1),
                    StartsWith("count: expected 0 triangles at least"));
}

}  // namespace
