#include "shape3d/descriptors/hsh_basis.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "sphere_grid.hpp"

namespace {
using namespace shape3d::descriptors;

constexpr double kPi = 3.14159265358979323846;

// (5.7) to (5.9) as printed, without the factor Y_l^m; (2l)!! = 2^l l!.
double printed_radial(int lambda, int l, double theta0) {
  const double u = std::cos(theta0);
  double gegenbauer = 0;
  for (int t = 0; t <= (lambda - l) / 2; ++t) {
    gegenbauer +=
        (t % 2 == 0 ? 1 : -1) * std::tgamma(lambda + 1.0 - t) /
        (std::tgamma(t + 1.0) * std::tgamma(lambda - l - 2 * t + 1.0) * std::tgamma(l + 1.0)) *
        std::pow(2 * u, lambda - l - 2 * t);
  }
  const double norm =
      ((lambda + l) % 2 == 0 ? 1 : -1) * std::pow(2.0, l) * std::tgamma(l + 1.0) *
      std::sqrt(2 * (lambda + 1.0) / kPi *
                std::exp(std::lgamma(lambda - l + 1.0) - std::lgamma(lambda + l + 2.0)));
  return norm * gegenbauer * std::pow(std::sin(theta0), l);
}

TEST_CASE("the numbers of harmonics are those of section 5.2", "[descriptors][analytic]") {
  CHECK(hsh_count(8) == 285);
  CHECK(hsh_count(30) == 10416);
  CHECK(hsh_pair_count(8) == 45);
  CHECK(hsh_pair_count(15) == 136);
  CHECK(hsh_pair_count(30) == 496);
  std::size_t next = 0, pair = 0;
  for (int lambda = 0; lambda <= 12; ++lambda) {
    for (int l = 0; l <= lambda; ++l) {
      CHECK(hsh_pair_index(lambda, l) == pair++);
      for (int m = -l; m <= l; ++m) CHECK(hsh_index(lambda, l, m) == next++);
    }
    CHECK(hsh_count(lambda) == next);
    CHECK(hsh_pair_count(lambda) == pair);
  }
}

TEST_CASE("radial functions are the printed formulas where these have digits",
          "[descriptors][analytic]") {
  for (double theta0 = 0.1; theta0 < kPi; theta0 += 0.37) {
    const Eigen::VectorXd radial = hsh_radial(12, theta0);
    for (int lambda = 0; lambda <= 12; ++lambda) {
      for (int l = 0; l <= lambda; ++l) {
        INFO("lambda " << lambda << ", l " << l << ", theta0 " << theta0);
        CHECK(std::abs(radial[static_cast<Eigen::Index>(hsh_pair_index(lambda, l))] -
                       printed_radial(lambda, l, theta0)) < 1e-10);
      }
    }
  }
  // R_{λ,0} = (−1)^λ √(2/π) sin((λ+1)θ0) / sin θ0; the sum (5.9) has lost all digits of it at λ
  // = 60.
  const double theta0 = 0.3;
  const double exact = std::sqrt(2 / kPi) * std::sin(61 * theta0) / std::sin(theta0);
  CHECK(std::abs(hsh_radial(60, theta0)[static_cast<Eigen::Index>(hsh_pair_index(60, 0))] - exact) <
        1e-12);
  CHECK(std::abs(printed_radial(60, 0, theta0) - exact) > 1e-2);
}

TEST_CASE("the basis is orthonormal on S3 for K = 30 and 60", "[descriptors][analytic]") {
  // Y = R · Y_l^m: the Gram matrix is the product of those of R (for each l) and of Y_l^m.
  const int K = GENERATE(8, 30, 60);
  INFO("K = " << K);
  // Products have degree 2K in cos θ0: K + 1 nodes of Gauss–Chebyshev are exact; twice as many test
  // the same integral differently.
  const int nodes = K + 2;
  Eigen::MatrixXd radial(static_cast<Eigen::Index>(hsh_pair_count(K)), nodes);
  Eigen::VectorXd weights(nodes);
  for (int i = 0; i < nodes; ++i) {
    const double theta0 = kPi * (i + 1) / (nodes + 1);
    radial.col(i) = hsh_radial(K, theta0);
    weights[i] = kPi / (nodes + 1) * std::pow(std::sin(theta0), 2);
  }
  double worst = 0;
  for (int l = 0; l <= K; ++l) {
    for (int a = l; a <= K; ++a) {
      for (int b = a; b <= K; ++b) {
        const double product =
            (radial.row(static_cast<Eigen::Index>(hsh_pair_index(a, l))).array() *
             radial.row(static_cast<Eigen::Index>(hsh_pair_index(b, l))).array() *
             weights.transpose().array())
                .sum();
        worst = std::max(worst, std::abs(product - (a == b ? 1 : 0)));
      }
    }
  }
  CHECK(worst < 1e-12);

  // The whole basis at once: 285 functions on a product grid, and the sums over m as printed.
  if (K > 8) return;
  Eigen::VectorXd u, w;
  detail::gauss_legendre(K + 1, u, w);
  const int columns = 2 * K + 1;
  Eigen::MatrixXcd values(static_cast<Eigen::Index>(hsh_count(K)), nodes * (K + 1) * columns);
  Eigen::VectorXd measure(values.cols());
  Eigen::Index next = 0;
  for (int i = 0; i < nodes; ++i) {
    for (int j = 0; j <= K; ++j) {
      for (int k = 0; k < columns; ++k) {
        values.col(next) =
            hsh_basis(K, kPi * (i + 1) / (nodes + 1), std::acos(u[j]), 2 * kPi * k / columns);
        measure[next++] = weights[i] * w[j] * 2 * kPi / columns;
      }
    }
  }
  const Eigen::MatrixXcd gram = values.conjugate() * measure.asDiagonal() * values.transpose();
  CHECK((gram - Eigen::MatrixXcd::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff() <
        1e-12);
}

TEST_CASE("the addition theorem holds on S3", "[descriptors][analytic]") {
  // Σ_{l,m} |Y_{λ,l}^m|² = (λ+1)² / 2π² at every point, also at the poles.
  for (const double theta0 : {0.0, 1e-9, 0.4, 1.6, 3.0, kPi}) {
    for (const double theta : {0.0, 0.7, kPi}) {
      const Eigen::VectorXcd basis = hsh_basis(60, theta0, theta, 1.3);
      for (int lambda = 0; lambda <= 60; ++lambda) {
        const double sum = basis
                               .segment(static_cast<Eigen::Index>(hsh_index(lambda, 0, 0)),
                                        (lambda + 1) * (lambda + 1))
                               .squaredNorm();
        INFO("lambda " << lambda << ", theta0 " << theta0 << ", theta " << theta);
        CHECK(sum == Approx((lambda + 1) * (lambda + 1) / (2 * kPi * kPi)).epsilon(1e-11));
      }
    }
  }
}

TEST_CASE("angles and degrees out of range are refused", "[descriptors][contract]") {
  CHECK_THROWS_WITH(hsh_radial(61, 0), "K is 61, expected 0 … 60");
  CHECK_THROWS_WITH(hsh_radial(-1, 0), "K is -1, expected 0 … 60");
  CHECK_THROWS_WITH(hsh_radial(3, -0.5), "theta0 is -0.5, expected 0 … π");
  CHECK_THROWS_WITH(hsh_basis(3, 1, 4, 0), "theta is 4, expected 0 … π");
  CHECK_THROWS_WITH(hsh_basis(3, 1, 1, std::numeric_limits<double>::infinity()),
                    "phi is inf, expected a finite angle");
}

}  // namespace
