#include "shape3d/mapping/curvature.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "bodies.hpp"

namespace {
using namespace shape3d::mapping;
using namespace shape3d::mapping::test;
using Catch::Matchers::Contains;
constexpr double kPi = 3.141592653589793;

struct Exact {
  double maximum = 0, minimum = 0;
};

// Largest error of κ1, κ2 against closed forms; and of H and K, which must agree with them.
template <class Form>
double worst(const Body& body, const Curvature& found, const Form& exact) {
  double most = 0.0;
  for (Eigen::Index v = 0; v < body.V.rows(); ++v) {
    const Exact k = exact(body.V.row(v));
    most = std::max(
        {most, std::abs(found.maximum[v] - k.maximum), std::abs(found.minimum[v] - k.minimum)});
  }
  CHECK((found.mean - 0.5 * (found.maximum + found.minimum)).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((found.gaussian - found.maximum.cwiseProduct(found.minimum)).cwiseAbs().maxCoeff() < 1e-9);
  return most;
}

Exact ellipsoid_curvature(const Eigen::RowVector3d& p, const Eigen::RowVector3d& s) {
  // K = 1 / (a² b² c² w²) with w = Σ p²/s⁴, and H = (|p|² − Σ s²) / (−2 a² b² c² w^{3/2}).
  const double w = (p.array() / s.array().square()).square().sum();
  const double squares = s.array().square().prod();
  const double K = 1.0 / (squares * w * w);
  const double H = (s.squaredNorm() - p.squaredNorm()) / (2.0 * squares * std::pow(w, 1.5));
  const double root = std::sqrt(std::max(0.0, H * H - K));
  return {H + root, H - root};
}

Exact torus_curvature(const Eigen::RowVector3d& p, double R, double r) {
  const double ring = std::hypot(p[0], p[1]);
  return {1.0 / r, (ring - R) / (r * ring)};  // cos φ / (R + r cos φ)
}

TEST_CASE("curvature converges on a sphere", "[mapping][curvature]") {
  // Irregular: the vertices of an icosahedron have five neighbours. Each level halves the edges.
  for (const int degree : {2, 3, 4}) {
    double previous = 0.0;
    for (const int level : {2, 3, 4}) {
      Body ball = sphere(level);
      ball.V *= 2.5;
      CurvatureOptions options;
      options.degree = degree;
      options.rings = degree == 4 ? 3 : 2;
      const Curvature found = curvature(ball.V, ball.F, options);
      const double error = worst(ball, found, [](const Eigen::RowVector3d&) {
        return Exact{0.4, 0.4};
      });
      INFO("degree " << degree << ", level " << level << ": " << error << " after " << previous);
      CHECK(found.undetermined == 0);
      CHECK((found.normal - ball.V / 2.5).rowwise().norm().maxCoeff() < 0.02);
      if (previous > 0.0) CHECK(error < previous / 3.5);  // second order, by symmetry also for 2
      previous = error;
    }
    CHECK(previous < 0.004);  // a hundredth of the curvature
  }
}

TEST_CASE("curvature converges on a torus, with its directions", "[mapping][curvature]") {
  const double R = 1.0, r = 0.4;
  double previous = 0.0;
  for (const int n : {40, 80, 160}) {
    const Body ring = torus(R, r, n, n / 2);
    const Curvature found = curvature(ring.V, ring.F);
    const double error =
        worst(ring, found, [&](const Eigen::RowVector3d& p) { return torus_curvature(p, R, r); });
    INFO("n " << n << ": " << error << " after " << previous);
    if (previous > 0.0) CHECK(error < previous / 3.5);
    previous = error;
    // κ1 = 1/r runs round the tube: its direction has no part along the ring.
    double along = 0.0;
    for (Eigen::Index v = 0; v < ring.V.rows(); ++v) {
      const Eigen::RowVector3d around =
          Eigen::RowVector3d(-ring.V(v, 1), ring.V(v, 0), 0).normalized();
      along = std::max(along, std::abs(found.maximum_direction.row(v).dot(around)));
      CHECK(std::abs(found.minimum_direction.row(v).dot(found.normal.row(v))) < 1e-9);
    }
    CHECK(along < 12.0 / (n * n / 16.0));
  }
  CHECK(previous < 0.01 * (1 / r));
}

TEST_CASE("curvature converges on an ellipsoid", "[mapping][curvature]") {
  const Eigen::RowVector3d axes(1.5, 1.0, 0.7);
  double previous = 0.0;
  for (const int level : {3, 4, 5}) {
    Body body = sphere(level);
    body.V = body.V.array().rowwise() * axes.array();
    const Curvature found = curvature(body.V, body.F);
    const double error = worst(
        body, found, [&](const Eigen::RowVector3d& p) { return ellipsoid_curvature(p, axes); });
    INFO("level " << level << ": " << error << " after " << previous);
    if (previous > 0.0) CHECK(error < previous / 3.3);
    previous = error;
  }
  CHECK(previous < 0.015);
}

TEST_CASE("Gaussian curvature adds up to 2 pi chi", "[mapping][curvature]") {
  const auto total = [](const Body& body) {
    const Curvature found = curvature(body.V, body.F);
    double sum = 0.0;
    for (Eigen::Index t = 0; t < body.F.rows(); ++t) {
      const Eigen::Vector3d a = body.V.row(body.F(t, 0)), b = body.V.row(body.F(t, 1)),
                            c = body.V.row(body.F(t, 2));
      const double area = 0.5 * (b - a).cross(c - a).norm();
      for (int i = 0; i < 3; ++i) sum += area / 3 * found.gaussian[body.F(t, i)];
    }
    return sum;
  };
  double previous = 0.0, ring_previous = 0.0;
  for (const int level : {3, 4, 5}) {
    Body body = sphere(level);
    body.V = body.V.array().rowwise() * Eigen::Array3d(1.3, 1.0, 0.6).transpose();
    const double error = std::abs(total(body) - 4 * kPi);
    const double ring_error = std::abs(total(torus(1.0, 0.4, 10 << level, 5 << level)));
    INFO("level " << level << ": " << error << ", " << ring_error);
    if (level > 3) {
      CHECK(error < previous / 3.5);
      CHECK(ring_error < ring_previous / 3.5);
    }
    previous = error;
    ring_previous = ring_error;
  }
  CHECK(previous < 0.01 * 4 * kPi);
}

TEST_CASE("a saddle, a boundary and the sign", "[mapping][curvature]") {
  const Body saddle = patch(40, [](double x, double y) { return 0.5 * (x * x - y * y); });
  const Curvature found = curvature(saddle.V, saddle.F);
  CHECK(found.undetermined == 0);
  // At the middle κ = ∓1 along x and y: towards the normal along x, away from it along y.
  const Eigen::Index middle = 20 + 41 * 20;
  CHECK(found.maximum[middle] == Approx(1.0).epsilon(1e-6));
  CHECK(found.minimum[middle] == Approx(-1.0).epsilon(1e-6));
  CHECK(std::abs(found.maximum_direction(middle, 1)) == Approx(1.0));
  CHECK(std::abs(found.minimum_direction(middle, 0)) == Approx(1.0));
  // At the corner (−1, −1): H = (f_xx (1 + f_y²) − … ) / 2 w³ = 0 by symmetry, K = −1 / w⁴, w² = 3.
  CHECK(found.mean[0] == Approx(0.0).margin(0.01));
  CHECK(found.gaussian[0] == Approx(-1.0 / 9).epsilon(0.02));
  // Turned inside out, signs change and κ1, κ2 trade places.
  Triangles turned = saddle.F;
  turned.rowwise().reverseInPlace();
  const Curvature inside = curvature(saddle.V, turned);
  CHECK((inside.maximum + found.minimum).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("curvature is equivariant", "[mapping][curvature]") {
  Body body = sphere(3);
  body.V = body.V.array().rowwise() * Eigen::Array3d(1.5, 1.0, 0.7).transpose();
  const Curvature before = curvature(body.V, body.F);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (const double scale : {1e-40, 1e3, 1e40}) {
    Points V = scale * (body.V * turn.transpose());
    V.rowwise() += scale * Eigen::RowVector3d(3, -1, 2);
    const Curvature after = curvature(V, body.F);
    CHECK((after.maximum * scale - before.maximum).cwiseAbs().maxCoeff() < 1e-8);
    CHECK((after.minimum * scale - before.minimum).cwiseAbs().maxCoeff() < 1e-8);
    CHECK((after.normal - before.normal * turn.transpose()).cwiseAbs().maxCoeff() < 1e-8);
  }
}

TEST_CASE("vertices without enough neighbours have no curvature", "[mapping][curvature]") {
  Points V(5, 3);
  V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 7, 7, 7;
  Triangles F(4, 3);
  F << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3;
  const Curvature found = curvature(V, F);
  CHECK(found.undetermined == 5);
  CHECK(std::isnan(found.mean[0]));
  CHECK(std::isnan(found.normal(4, 2)));
  CHECK(curvature(V, Triangles(0, 3)).undetermined == 5);
}

TEST_CASE("curvature refuses bad arguments", "[mapping][curvature][contract]") {
  const Body ball = sphere(1);
  CurvatureOptions options;
  options.degree = 5;
  CHECK_THROWS_WITH(curvature(ball.V, ball.F, options), Contains("degree: expected 2 to 4, got 5"));
  options.degree = 2;
  options.rings = 0;
  CHECK_THROWS_WITH(curvature(ball.V, ball.F, options), Contains("rings: expected 1 to 10, got 0"));
  Points hole = ball.V;
  hole(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(curvature(hole, ball.F), Contains("V: 1 row is not finite"));
  Triangles wrong = ball.F;
  wrong(0, 0) = 42;
  CHECK_THROWS_WITH(curvature(ball.V, wrong), Contains("F: 1 row has an index outside"));
  CHECK_THROWS_WITH(curvature(1.5e308 * ball.V, ball.F), Contains("beyond the range of double"));
}

}  // namespace
