#include "shape3d/mapping/wrap.hpp"

#include <limits>

#include <catch2/catch.hpp>

#include "bodies.hpp"
#include "shape3d/mapping/inspect.hpp"

namespace {
using namespace shape3d::mapping;
using namespace shape3d::mapping::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

// Least distance along the axes: every vertex of `inner` is inside the box of `outer`.
bool box_contains(const Points& outer, const Points& inner) {
  return (outer.colwise().minCoeff().array() < inner.colwise().minCoeff().array()).all() &&
         (outer.colwise().maxCoeff().array() > inner.colwise().maxCoeff().array()).all();
}

TEST_CASE("a torus is wrapped with its hole closed", "[mapping][wrap]") {
  // The hole of radius 0.6 stays open for α below it; the diagonal is √(2 · 4² + 1.4²).
  const Body ring = torus(1.3, 0.7, 40, 20);
  const Wrapped result = wrap(ring.V, ring.F);
  REQUIRE(result.status == WrapStatus::ok);
  const Inspection found = inspect(result.V, result.F);
  CHECK(found.spherical());
  CHECK(*found.volume > 0);
  CHECK(box_contains(result.V, ring.V));
  CHECK(result.alpha > 0.5 * 0.6);
  CHECK(result.alpha < 2.0 * 0.6);
  CHECK(result.offset == Approx(result.alpha / 30));
  // Among the attempts are a good one and, within the ratio, a bad one of smaller α.
  bool bad_below = false;
  for (const WrapAttempt& attempt : result.attempts) {
    const bool good = attempt.components == 1 && attempt.euler == 2;
    if (attempt.alpha == result.alpha) CHECK(good);
    if (!good && attempt.alpha < result.alpha && attempt.alpha * 1.1001 >= result.alpha)
      bad_below = true;
  }
  CHECK(bad_below);
}

TEST_CASE("open and crossing triangles are wrapped, at all scales", "[mapping][wrap]") {
  // Two square sheets across each other.
  Points V(8, 3);
  V << -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1;
  Triangles F(4, 3);
  F << 0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7;
  WrapOptions options;
  options.finest = 12;
  std::int64_t triangles = 0;
  for (const double scale : {1.0, 1e-30, 1e30}) {
    INFO(scale);
    const Wrapped result = wrap(scale * V, F, options);
    REQUIRE(result.status == WrapStatus::ok);
    CHECK(inspect(result.V, result.F).spherical());
    CHECK(box_contains(result.V, scale * V));
    CHECK(result.alpha == Approx(scale * std::sqrt(12.0) / 12));  // nothing bad till the finest
    if (triangles != 0) CHECK(std::abs(result.F.rows() - triangles) < triangles / 10);
    triangles = result.F.rows();
  }
}

TEST_CASE("bodies far apart have no wrap of one piece", "[mapping][wrap]") {
  const Body ball = sphere(1);
  Points V(2 * ball.V.rows(), 3);
  V << 0.01 * ball.V, (0.01 * ball.V).rowwise() + Eigen::RowVector3d(1, 1, 1);
  Triangles F(2 * ball.F.rows(), 3);
  F << ball.F, ball.F.array() + static_cast<std::int32_t>(ball.V.rows());
  WrapOptions options;
  options.coarsest = 8;
  options.finest = 10;
  const Wrapped result = wrap(V, F, options);
  CHECK(result.status == WrapStatus::no_sphere);
  CHECK(result.V.rows() + result.F.rows() == 0);
  REQUIRE_FALSE(result.attempts.empty());
  CHECK(result.attempts.front().components == 2);
  CHECK_THAT(std::string(to_string(result.status)), Contains("handles or several pieces"));
}

TEST_CASE("wrap can be cancelled", "[mapping][wrap]") {
  const Body ball = sphere(1);
  WrapOptions options;
  options.progress = [](double share) { return share < 0.1; };
  const Wrapped result = wrap(ball.V, ball.F, options);
  CHECK(result.status == WrapStatus::cancelled);
  CHECK(result.V.rows() == 0);
  CHECK_THAT(std::string(to_string(result.status)), Contains("cancelled"));
  CHECK_THAT(std::string(to_string(WrapStatus::ok)), Contains("genus 0"));
}

TEST_CASE("wrap refuses bad arguments", "[mapping][wrap][contract]") {
  const Body ball = sphere(0);
  const auto refused = [&ball](auto change, const char* message) {
    WrapOptions options;
    change(options);
    CHECK_THROWS_WITH(wrap(ball.V, ball.F, options), StartsWith(message));
  };
  refused([](WrapOptions& o) { o.coarsest = 0.5; },
          "options.coarsest: expected a number from 1 to 1000, got 0.5");
  refused([](WrapOptions& o) { o.finest = 3; }, "options.finest: expected a number from 4 to 1000");
  refused([](WrapOptions& o) { o.offset = 1; }, "options.offset: expected a number from 2 to 1000");
  refused([](WrapOptions& o) { o.ratio = std::numeric_limits<double>::quiet_NaN(); },
          "options.ratio: expected a number from 1.001 to 2");
  CHECK_THROWS_WITH(wrap(0.0 * ball.V, ball.F), Contains("so there is nothing to wrap"));
  CHECK_THROWS_WITH(wrap(ball.V, Triangles(0, 3)), Contains("the vertices of the 0 triangles"));
  Triangles wrong = ball.F;
  wrong(2, 2) = -4;
  CHECK_THROWS_WITH(wrap(ball.V, wrong), Contains("F: 1 row has an index outside 0 to 11"));
  Points hole = ball.V;
  hole(1, 1) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(wrap(hole, ball.F), Contains("V: 1 row is not finite"));
}

}  // namespace
