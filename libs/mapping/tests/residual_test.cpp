#include "residual.hpp"

#include <random>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::mapping;

struct Case {
  RestShape shape;
  std::array<Eigen::Vector3d, 3> corners;
};

/// A random triangle of the surface and a counter-clockwise one on the sphere.
Case random_case(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const auto point = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  Case result{rest_shape(point(), point(), point()), {point(), point(), point()}};
  for (Eigen::Vector3d& p : result.corners) p.normalize();
  auto& [p, q, r] = result.corners;
  if (p.dot(q.cross(r)) < 0) std::swap(q, r);
  return result;
}

TEST_CASE("the squared residual is A (s1/s2 + s2/s1 - 2), by singular values") {
  std::mt19937 random(7);
  for (int i = 0; i < 200; ++i) {
    const Case c = random_case(random);
    Eigen::Matrix<double, 3, 2> J = Eigen::Matrix<double, 3, 2>::Zero();
    for (int k = 0; k < 3; ++k) {
      J.col(0) += c.corners[k] * c.shape.du[k];
      J.col(1) += c.corners[k] * c.shape.dv[k];
    }
    const Eigen::Vector2d s = J.jacobiSvd().singularValues();
    const double conformal =
        conformal_residual(c.shape, Energy::conformal, 0, c.corners, nullptr).squaredNorm();
    CHECK(conformal == Approx(c.shape.area * (s[0] / s[1] + s[1] / s[0] - 2)).epsilon(1e-9));
    // The harmonic energy is twice ½ A |J|², so that its excess over the area is half of this.
    const double harmonic =
        conformal_residual(c.shape, Energy::harmonic, 0, c.corners, nullptr).squaredNorm();
    CHECK(harmonic == Approx(c.shape.area * (s[0] - s[1]) * (s[0] - s[1])).epsilon(1e-9));
  }
}

TEST_CASE("the analytic Jacobians are the limits of central differences") {
  const Energy energy = GENERATE(Energy::conformal, Energy::harmonic);
  std::mt19937 random(11);
  for (int i = 0; i < 50; ++i) {
    const Case c = random_case(random);
    // Half of them flipped, which is smoothed.
    std::array<Eigen::Vector3d, 3> corners = c.corners;
    if (i % 2 == 1) std::swap(corners[0], corners[1]);
    const double epsilon = i % 2 == 1 ? 0.3 : 0;
    std::array<RowMatrix3, 3> analytic;
    conformal_residual(c.shape, energy, epsilon, corners, &analytic);
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        // Two step sizes and Richardson's extrapolation: error O(h⁴).
        const auto difference = [&](double h) {
          std::array<Eigen::Vector3d, 3> up = corners, down = corners;
          up[k][axis] += h;
          down[k][axis] -= h;
          return Eigen::Vector3d((conformal_residual(c.shape, energy, epsilon, up, nullptr) -
                                  conformal_residual(c.shape, energy, epsilon, down, nullptr)) /
                                 (2 * h));
        };
        const double D = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
        const double h = 1e-4 * D;
        const Eigen::Vector3d numeric = (4 * difference(0.5 * h) - difference(h)) / 3;
        const double scale = analytic[k].norm() + 1e-12;
        CHECK((analytic[k].col(axis) - numeric).norm() < 1e-6 * scale);
      }
    }
  }
}

TEST_CASE("the residual vanishes for a similar triangle and does not see its size") {
  const Eigen::Vector3d p(0.2, 0.1, 3), q(1.3, 0.4, 3.2), r(0.5, 1.1, 2.9);
  const RestShape shape = rest_shape(p, q, r);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  for (const double scale : {1e-8, 1.0, 1e8}) {
    const std::array<Eigen::Vector3d, 3> similar{scale * (R * p), scale * (R * q), scale * (R * r)};
    CHECK(conformal_residual(shape, Energy::conformal, 0, similar, nullptr).norm() < 1e-12);
    const std::array<Eigen::Vector3d, 3> sheared{scale * p, scale * q, scale * (r + 0.3 * (q - p))};
    const std::array<Eigen::Vector3d, 3> sheared_once{p, q, r + 0.3 * (q - p)};
    CHECK(conformal_residual(shape, Energy::conformal, 0, sheared, nullptr).norm() ==
          Approx(conformal_residual(shape, Energy::conformal, 0, sheared_once, nullptr).norm()));
  }
}

TEST_CASE("the area residual is the logarithm of the area scale, its Jacobian the difference") {
  std::mt19937 random(5);
  for (int i = 0; i < 50; ++i) {
    const Case c = random_case(random);
    std::array<Eigen::RowVector3d, 3> analytic;
    const double value = area_residual(c.shape, 0.7, c.corners, &analytic);
    const double image =
        0.5 * (c.corners[1] - c.corners[0]).cross(c.corners[2] - c.corners[0]).norm();
    CHECK(value == Approx(std::sqrt(0.7 * c.shape.area) *
                          std::log(image / c.shape.area / 12.566370614359172)));
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        std::array<Eigen::Vector3d, 3> up = c.corners, down = c.corners;
        const double h = 1e-5 * image;
        up[k][axis] += h;
        down[k][axis] -= h;
        const double numeric = (area_residual(c.shape, 0.7, up, nullptr) -
                                area_residual(c.shape, 0.7, down, nullptr)) /
                               (2 * h);
        CHECK(std::abs(analytic[k][axis] - numeric) < 1e-6 * (1 + analytic[k].norm()));
      }
    }
  }
}

TEST_CASE(
    "corner angles add up to pi, are those of the law of cosines, their Jacobians differences") {
  std::mt19937 random(11);
  for (int i = 0; i < 50; ++i) {
    const std::array<Eigen::Vector3d, 3> corners = random_case(random).corners;
    std::array<RowMatrix3, 3> analytic;
    const Eigen::Vector3d angles = corner_angles(corners, &analytic);
    CHECK(angles.sum() == Approx(3.14159265358979323846));
    for (int k = 0; k < 3; ++k) {
      const double a = (corners[(k + 1) % 3] - corners[k]).norm();
      const double b = (corners[(k + 2) % 3] - corners[k]).norm();
      const double c = (corners[(k + 1) % 3] - corners[(k + 2) % 3]).norm();
      CHECK(std::cos(angles[k]) == Approx((a * a + b * b - c * c) / (2 * a * b)).margin(1e-12));
      for (int axis = 0; axis < 3; ++axis) {
        std::array<Eigen::Vector3d, 3> up = corners, down = corners;
        const double h = 1e-6 * std::min(a, b);
        up[k][axis] += h;
        down[k][axis] -= h;
        const Eigen::Vector3d numeric =
            (corner_angles(up, nullptr) - corner_angles(down, nullptr)) / (2 * h);
        CHECK((analytic[k].col(axis) - numeric).norm() < 1e-5 * (1 + analytic[k].norm()));
      }
    }
  }
}

}  // namespace
