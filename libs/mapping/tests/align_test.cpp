#include "shape3d/mapping/align.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "bodies.hpp"

namespace {
using namespace shape3d::mapping;
using namespace shape3d::mapping::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

// A sphere bent by (3x + 1.2x², 2y + b y², 1.2z + c z²) and sheared a little: longer to one side
// along each axis, with three plainly different variances. b = 0 leaves a plane of symmetry, c = 0
// another.
Body lopsided(int level, double b = -0.7, double c = 0.5) {
  Body body = sphere(level);
  for (Eigen::Index v = 0; v < body.V.rows(); ++v) {
    const double x = body.V(v, 0), y = body.V(v, 1), z = body.V(v, 2);
    const double shear = b == 0.0 ? 0.0 : 0.2 * y * z;
    body.V.row(v) << 3 * x + 1.2 * x * x + shear, 2 * y + b * y * y, 1.2 * z + c * z * z;
  }
  return body;
}

double distance(const Points& a, const Points& b) { return (a - b).rowwise().norm().maxCoeff(); }

TEST_CASE("the pose of a cuboid meshed in twelve ways is its closed form", "[mapping][align]") {
  // Sides 2a, 2b, 2c: S = 8 (ab + bc + ca). Over the faces x = ±a: ∫ x² = 8 abc · a; over y = ±b
  // and z = ±c, x runs from −a to a: ∫ x² = a³ · 8 (b + c) / 3.
  const double a = 3, b = 2, c = 1.25, S = 8 * (a * b + b * c + c * a);
  const auto variance = [S](double x, double y, double z) {
    return (8 * x * x * y * z + 8 * x * x * x * (y + z) / 3) / S;
  };
  const Eigen::Vector3d expected(variance(a, b, c), variance(b, c, a), variance(c, a, b));
  for (const Body& body : cubes_meshed_twelve_ways()) {
    INFO(body.name);
    Points V = body.V;
    for (int axis = 0; axis < 3; ++axis) V.col(axis) *= (axis == 0 ? a : axis == 1 ? b : c);
    V.rowwise() += Eigen::RowVector3d(7, -5, 11);
    const Pose pose = align(V, body.F);
    CHECK((pose.centroid - Eigen::Vector3d(7, -5, 11)).norm() < 1e-12);
    CHECK(pose.area == Approx(S).epsilon(1e-13));
    CHECK((pose.eigenvalues - expected).norm() < 1e-12 * expected[0]);
    CHECK(pose.scale == Approx(1 / std::sqrt(expected.sum())).epsilon(1e-13));
    CHECK((pose.rotation.cwiseAbs() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    CHECK(pose.rotation.determinant() == Approx(1.0).epsilon(1e-13));
    CHECK(pose.skew.cwiseAbs().maxCoeff() < 1e-12);  // three planes of symmetry
    CHECK(pose.ambiguous);
  }
}

TEST_CASE("a cube has no axes of its own, and the pose says so", "[mapping][align]") {
  std::vector<Pose> poses;
  for (const Body& body : cubes_meshed_twelve_ways()) {
    INFO(body.name);
    const Pose pose = align(body.V, body.F);
    // 5/9: ∫ x² over the faces x = ±1 is 8, over the other four 16/3, of an area of 24.
    CHECK((pose.eigenvalues - Eigen::Vector3d::Constant(5.0 / 9)).norm() < 1e-13);
    CHECK(pose.gaps.maxCoeff() < 1e-12);
    CHECK(pose.ambiguous);
  }
  // The vertices alone, which (4.1) uses, have other variances in each meshing.
  const auto bodies = cubes_meshed_twelve_ways();
  double least = 1e9, most = 0;
  for (const Body& body : bodies) {
    const double mean = body.V.col(0).array().square().mean();
    least = std::min(least, mean);
    most = std::max(most, mean);
  }
  CHECK(most > 1.5 * least);
}

TEST_CASE("a surface cut in pieces anew keeps its pose", "[mapping][align]") {
  const Body body = lopsided(3);
  const Pose before = align(body.V, body.F);
  CHECK_FALSE(before.ambiguous);
  std::mt19937 random(5);
  Body finer = body;
  for (int pass = 0; pass < 2; ++pass) finer = split_at_random_points(finer, random);
  CHECK(finer.F.rows() == 9 * body.F.rows());
  const Pose after = align(finer.V, finer.F);
  CHECK((after.rotation - before.rotation).norm() < 1e-11);
  CHECK((after.centroid - before.centroid).norm() < 1e-12);
  CHECK((after.eigenvalues - before.eigenvalues).norm() < 1e-12);
  CHECK((after.skew - before.skew).norm() < 1e-11);
  CHECK(after.scale == Approx(before.scale).epsilon(1e-13));
}

TEST_CASE("moved, turned and scaled bodies have one posed surface", "[mapping][align]") {
  const Body body = lopsided(3);
  const Points expected = posed(body.V, align(body.V, body.F));
  CHECK(expected.colwise().mean().norm() < 0.3);
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (const double scale : {1e-150, 1e-6, 1.0, 3e4, 1e30, 1e150}) {
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
            .normalized();
    Points V = scale * (body.V * turn.toRotationMatrix().transpose());
    V.rowwise() += scale * Eigen::RowVector3d(40, -20, 10);
    const Pose pose = align(V, body.F);
    INFO("scale " << scale);
    CHECK_FALSE(pose.ambiguous);
    CHECK((pose.rotation * pose.rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-13);
    CHECK(pose.rotation.determinant() == Approx(1.0));
    CHECK(distance(posed(V, pose), expected) < 1e-11);
  }
}

TEST_CASE("the posed surface is centred, of size 1 and uncorrelated", "[mapping][align]") {
  const Body body = lopsided(4);
  const Pose pose = align(body.V, body.F);
  const Pose again = align(posed(body.V, pose), body.F);
  CHECK(again.centroid.norm() < 1e-13);
  CHECK(again.scale == Approx(1.0).epsilon(1e-13));
  CHECK((again.rotation - Eigen::Matrix3d::Identity()).norm() < 1e-12);
  CHECK(again.eigenvalues.sum() == Approx(1.0).epsilon(1e-13));
  CHECK(again.eigenvalues[0] > again.eigenvalues[1]);
  CHECK(again.eigenvalues[1] > again.eigenvalues[2]);
}

TEST_CASE("sign moments are exact where triangles cross the plane", "[mapping][align]") {
  // Against the midpoint rule on 4^9 pieces of one triangle, whose error is of order 4^-9.
  Points V(3, 3);
  V << -1, 0, 0, 2, 0.5, 0, 0.7, 1.5, 0.3;
  Triangles F(1, 3);
  F << 0, 1, 2;
  const Pose pose = align(V, F);
  const int n = 512;
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  const Eigen::Matrix3d q =
      pose.rotation * (V.transpose().colwise() - pose.centroid);  // a corner a column
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n - i; ++j) {
      for (int half = 0; half < (j + 1 < n - i ? 2 : 1); ++half) {
        const double u = (i + (half == 0 ? 1 : 2) / 3.0) / n,
                     v = (j + (half == 0 ? 1 : 2) / 3.0) / n;
        const Eigen::Vector3d x = q * Eigen::Vector3d(1 - u - v, u, v);
        sums += x.cwiseProduct(x.cwiseAbs()) / (n * n);
      }
    }
  }
  for (int axis = 0; axis < 2; ++axis) {
    INFO(axis);
    CHECK(pose.skew[axis] == Approx(sums[axis] / pose.eigenvalues[axis]).margin(2e-5));
  }
  // At the vertices alone the first moment differs in the first digit.
  Eigen::Vector3d corners = q.cwiseProduct(q.cwiseAbs()).rowwise().mean();
  CHECK(std::abs(corners[0] / pose.eigenvalues[0] - pose.skew[0]) > 0.05);
}

TEST_CASE("a mirror image has a pose of its own, or the same on request", "[mapping][align]") {
  const Body body = lopsided(3);
  Points mirrored = body.V;
  mirrored.col(1) *= -1.0;
  const Pose right = align(body.V, body.F), left = align(mirrored, body.F);
  CHECK(distance(posed(body.V, right), posed(mirrored, left)) > 0.1);
  CHECK((right.reversed_axis == -1) != (left.reversed_axis == -1));
  const Pose& reversed = right.reversed_axis == -1 ? left : right;
  int smallest = 0;
  reversed.skew.cwiseAbs().minCoeff(&smallest);
  CHECK(reversed.reversed_axis == smallest);
  CHECK(reversed.skew[smallest] < 0.0);
  CHECK(reversed.rotation.determinant() == Approx(1.0));

  PoseOptions options;
  options.allow_reflection = true;
  const Pose a = align(body.V, body.F, options), b = align(mirrored, body.F, options);
  CHECK(distance(posed(body.V, a), posed(mirrored, b)) < 1e-11);
  CHECK(a.rotation.determinant() * b.rotation.determinant() == Approx(-1.0));
  CHECK(a.reversed_axis == -1);
  CHECK(a.skew.minCoeff() > 0.0);
}

TEST_CASE("one plane of symmetry leaves the pose certain, two do not", "[mapping][align]") {
  const Body single = lopsided(3, 0.0);
  const Pose one = align(single.V, single.F);
  CHECK(one.skew.cwiseAbs().minCoeff() < 1e-12);
  CHECK(one.sign_margin > 0.05);
  CHECK_FALSE(one.ambiguous);
  // The same pose whichever way rounding tips the moment across the plane.
  const Points first = posed(single.V, one);
  for (const double noise : {1e-9, -1e-9}) {
    Points V = single.V;
    V.col(1).array() += noise * V.col(0).array().sin();
    CHECK(distance(posed(V, align(V, single.F)), first) < 1e-7);
  }
  const Body twice = lopsided(3, 0.0, 0.0);
  const Pose two = align(twice.V, twice.F);
  CHECK(two.sign_margin < 1e-12);
  CHECK(two.ambiguous);
}

TEST_CASE("gaps tell which axes are arbitrary", "[mapping][align]") {
  const Body cube = cubes_meshed_twelve_ways().front();
  const auto stretched = [&cube](double x, double y, double z) {
    Points V = cube.V;
    V.col(0) *= x;
    V.col(1) *= y;
    V.col(2) *= z;
    return align(V, cube.F);
  };
  const Pose rod = stretched(5, 1, 1), plate = stretched(5, 5, 1);
  CHECK(rod.gaps[0] > 0.5);
  CHECK(rod.gaps[1] < 1e-13);
  CHECK(rod.ambiguous);
  CHECK(plate.gaps[0] < 1e-13);
  CHECK(plate.gaps[1] > 0.5);
  // The stated tolerance decides.
  const Body body = lopsided(3);
  PoseOptions strict;
  strict.ambiguity_tolerance = 0.9;
  CHECK(align(body.V, body.F, strict).ambiguous);
}

TEST_CASE("flat surfaces have a pose", "[mapping][align]") {
  Points V(3, 3);
  V << 0, 0, 5, 4, 0, 5, 0, 3, 5;
  Triangles F(1, 3);
  F << 0, 1, 2;
  const Pose pose = align(V, F);
  CHECK((pose.centroid - Eigen::Vector3d(4.0 / 3, 1, 5)).norm() < 1e-13);
  CHECK(pose.area == Approx(6.0));
  CHECK(std::abs(pose.rotation(2, 2)) == Approx(1.0));
  CHECK(pose.eigenvalues[2] == Approx(0.0).margin(1e-14));
  CHECK(pose.skew[2] == 0.0);
}

TEST_CASE("align refuses what has no pose", "[mapping][align][contract]") {
  Body body = cubes_meshed_twelve_ways().front();
  PoseOptions options;
  options.ambiguity_tolerance = 0.0;
  CHECK_THROWS_WITH(
      align(body.V, body.F, options),
      StartsWith("options.ambiguity_tolerance: expected a number between 0 and 1, got"));
  Triangles wrong = body.F;
  wrong(3, 1) = static_cast<std::int32_t>(body.V.rows());
  wrong(5, 0) = -1;
  CHECK_THROWS_WITH(align(body.V, wrong),
                    StartsWith("F: 2 rows have an index outside 0 to ") && Contains("row 3"));
  Points hole = body.V;
  hole(2, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(align(hole, body.F), StartsWith("V: 1 row is not finite, the first is row 2"));
  CHECK_THROWS_WITH(align(0.0 * body.V, body.F), Contains("total area") && Contains("is zero"));
  CHECK_THROWS_WITH(align(body.V, Triangles(0, 3)),
                    Contains("total area of the 0 triangles is zero"));
  Points huge = 1e308 * body.V;
  CHECK_THROWS_WITH(align(huge, body.F), Contains("beyond the range of double"));
}

}  // namespace
