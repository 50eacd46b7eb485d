#include "shape3d/descriptors/sh.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <stdexcept>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "sh_functions.hpp"

namespace {
using namespace shape3d::descriptors;
using namespace shape3d::descriptors::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Message;
using Complex = std::complex<double>;

constexpr double kPi = 3.14159265358979323846;

TEST_CASE("weights of the image rows are those of Driscoll and Healy and exact",
          "[descriptors][analytic]") {
  for (const int n : {4, 16, 64, 250}) {
    const Eigen::VectorXd weights = image_weights(n);
    CHECK(weights.minCoeff() > 0);
    double worst = 0;
    for (int j = 0; j < n; ++j) {
      // a_j = (4/n) sin θ_j Σ_{l < n/2} sin((2l+1)θ_j) / (2l+1), another sum for the same numbers.
      const double theta = kPi * (2 * j + 1) / (2 * n);
      double sum = 0;
      for (int l = 0; l < n / 2; ++l) sum += std::sin((2 * l + 1) * theta) / (2 * l + 1);
      worst = std::max(worst, std::abs(weights[j] - 4.0 / n * std::sin(theta) * sum));
    }
    INFO("n = " << n);
    CHECK(worst < 1e-14);
    // ∫ x^p dx over [−1, 1].
    for (const int p : {0, 1, 2, n / 2, n - 2, n - 1}) {
      double integral = 0;
      for (int j = 0; j < n; ++j) {
        integral += weights[j] * std::pow(std::cos(kPi * (2 * j + 1) / (2 * n)), p);
      }
      CHECK(integral == Approx(p % 2 == 0 ? 2.0 / (p + 1) : 0.0).margin(1e-13));
    }
  }
}

TEST_CASE("all three routes recover band-limited functions", "[descriptors][analytic]") {
  struct Case {
    int size, K;
    bool svd;
  };
  // The largest degree of a size too; the decomposition only where it is quick.
  for (const Case c :
       {Case{4, 1, true}, Case{16, 7, true}, Case{32, 12, true}, Case{64, 31, false}}) {
    const Eigen::MatrixXcd expected = random_coefficients(c.K, 2, 7);
    const Eigen::MatrixXd samples = values_at(expected, image_points(c.size));
    INFO("size " << c.size << ", K " << c.K);
    CHECK((ShTransform(c.size, c.K, ShRoute::fft)(samples) - expected).cwiseAbs().maxCoeff() <
          1e-10);
    CHECK(
        (ShTransform(c.size, c.K, ShRoute::quadrature)(samples) - expected).cwiseAbs().maxCoeff() <
        1e-10);
    if (c.svd) {
      CHECK((ShTransform(c.size, c.K, ShRoute::svd)(samples) - expected).cwiseAbs().maxCoeff() <
            1e-10);
    }
    CHECK((sh_reconstruct(expected, c.size) - samples).cwiseAbs().maxCoeff() < 1e-10);
  }
}

TEST_CASE("degree 127 of 256 rows", "[descriptors][analytic]") {
  const Eigen::MatrixXcd C = random_coefficients(127, 1, 4);
  const Eigen::MatrixXd samples = sh_reconstruct(C, 256);
  CHECK((ShTransform(256, 127)(samples) - C).cwiseAbs().maxCoeff() < 1e-10);
  // Rows next to a pole and in the middle, term by term.
  const Points points = image_points(256);
  for (const Eigen::Index first : {0, 127 * 512, 255 * 512}) {
    CHECK((values_at(C, points.middleRows(first, 100)) - samples.middleRows(first, 100))
              .cwiseAbs()
              .maxCoeff() < 1e-9);
  }
}

TEST_CASE("degrees that the quadrature resolves do not leak into lower ones",
          "[descriptors][analytic]") {
  // n = 32 rows, K = 8: degrees up to n − 1 − K = 23 are orthogonal to those ≤ 8; 24 is not.
  const Points points = image_points(32);
  Eigen::MatrixXcd coefficients = Eigen::MatrixXcd::Zero(sh_count(24), 1);
  coefficients(sh_index(23, 0), 0) = 1;
  CHECK(ShTransform(32, 8)(values_at(coefficients, points)).cwiseAbs().maxCoeff() < 1e-12);
  coefficients.setZero();
  coefficients(sh_index(24, 0), 0) = 1;
  CHECK(ShTransform(32, 8)(values_at(coefficients, points)).cwiseAbs().maxCoeff() > 1e-3);
}

TEST_CASE("coefficients of coordinates have their closed forms", "[descriptors][analytic]") {
  const Points points = image_points(16);
  for (const ShRoute route : {ShRoute::quadrature, ShRoute::fft, ShRoute::svd}) {
    const Eigen::MatrixXcd C = ShTransform(16, 3, route)(Eigen::MatrixXd(points));
    // x = √(2π/3) (Y_1^{−1} − Y_1^1), y = i√(2π/3) (Y_1^{−1} + Y_1^1), z = √(4π/3) Y_1^0.
    Eigen::MatrixXcd expected = Eigen::MatrixXcd::Zero(sh_count(3), 3);
    const double a = std::sqrt(2 * kPi / 3);
    expected(sh_index(1, -1), 0) = a;
    expected(sh_index(1, 1), 0) = -a;
    expected(sh_index(1, -1), 1) = expected(sh_index(1, 1), 1) = Complex(0, a);
    expected(sh_index(1, 0), 2) = std::sqrt(4 * kPi / 3);
    CHECK((C - expected).cwiseAbs().maxCoeff() < 1e-13);
    CHECK(sh_amplitudes(C)(2, 0) == Approx(1.4472).epsilon(1e-4));
  }
}

TEST_CASE("rotation about z multiplies coefficients by a phase", "[descriptors][property]") {
  const double alpha = 0.83;
  const Eigen::MatrixXcd C = random_coefficients(9, 1, 3);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(alpha, Eigen::Vector3d::UnitZ()).matrix();
  const Eigen::MatrixXd rotated = values_at(C, image_points(24) * R);  // f(Rᵀx), x a row
  const Eigen::MatrixXcd D = ShTransform(24, 9)(rotated);
  double worst = 0;
  for (int l = 0; l <= 9; ++l) {
    for (int m = -l; m <= l; ++m) {
      worst = std::max(worst, std::abs(D(sh_index(l, m), 0) -
                                       std::polar(1.0, -m * alpha) * C(sh_index(l, m), 0)));
    }
  }
  CHECK(worst < 1e-12);
  CHECK((sh_amplitudes(D) - sh_amplitudes(C)).cwiseAbs().maxCoeff() < 1e-12);
}

// d^l_{m'm}(β) by Wigner's sum over factorials.
double wigner_d(int l, int a, int b, double beta) {
  const auto factorial = [](int n) { return std::tgamma(n + 1.0); };
  double sum = 0;
  for (int s = std::max(0, b - a); s <= std::min(l + b, l - a); ++s) {
    sum += ((a - b + s) % 2 == 0 ? 1.0 : -1.0) *
           std::pow(std::cos(beta / 2), 2 * l + b - a - 2 * s) *
           std::pow(std::sin(beta / 2), a - b + 2 * s) /
           (factorial(l + b - s) * factorial(s) * factorial(a - b + s) * factorial(l - a - s));
  }
  return sum * std::sqrt(factorial(l + a) * factorial(l - a) * factorial(l + b) * factorial(l - b));
}

TEST_CASE("rotation acts on coefficients by Wigner's matrices", "[descriptors][property]") {
  const int K = 8;
  const double alpha = 0.7, beta = 1.9, gamma = -2.3;
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(alpha, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(beta, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(gamma, Eigen::Vector3d::UnitZ()))
                                .matrix();
  const Eigen::MatrixXcd C = random_coefficients(K, 1, 11);
  const Eigen::MatrixXcd rotated = ShTransform(20, K)(values_at(C, image_points(20) * R));
  double worst = 0;
  for (int l = 0; l <= K; ++l) {
    for (int m = -l; m <= l; ++m) {
      Complex sum = 0;
      for (int k = -l; k <= l; ++k) {
        sum += std::polar(1.0, -m * alpha - k * gamma) * wigner_d(l, m, k, beta) *
               C(sh_index(l, k), 0);
      }
      worst = std::max(worst, std::abs(sum - rotated(sh_index(l, m), 0)));
    }
  }
  CHECK(worst < 1e-11);
  CHECK((sh_norms(rotated) - sh_norms(C)).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("invariants of a vector field, whose components rotate as well",
          "[descriptors][property]") {
  const int K = 7;
  const Eigen::Matrix3d R = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized().toRotationMatrix();
  const Eigen::MatrixXcd C = random_coefficients(K, 3, 5);
  // N'(x) = R N(Rᵀx).
  const Eigen::MatrixXd turned = values_at(C, image_points(16) * R) * R.transpose();
  const Eigen::MatrixXcd D = ShTransform(16, K)(turned);
  CHECK((sh_norms(D) - sh_norms(C)).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((sh_component_roots(D) - sh_component_roots(C)).cwiseAbs().maxCoeff() < 1e-11);
  const Eigen::MatrixXd before = sh_component_gram(C), after = sh_component_gram(D);
  for (int l = 0; l <= K; ++l) {
    const Eigen::Matrix3d G = before.middleRows(3 * l, 3);
    CHECK((after.middleRows(3 * l, 3) - R * G * R.transpose()).cwiseAbs().maxCoeff() < 1e-11);
    CHECK(sh_component_roots(C).segment(3 * l, 3).norm() == Approx(sh_norms(C)[l]));
  }
  // One norm a component would not be invariant.
  CHECK((sh_norms(D.col(0)) - sh_norms(C.col(0))).cwiseAbs().maxCoeff() > 0.05);
}

TEST_CASE("least squares from scattered directions", "[descriptors][analytic]") {
  const Points points = random_directions(400, 2);
  const Eigen::MatrixXcd C = random_coefficients(6, 2, 9);
  const ShFit fit(points, 6);
  CHECK(fit.rank() == sh_count(6));
  CHECK(fit.condition() > 1);
  CHECK(fit.condition() < 10);
  CHECK((fit(values_at(C, points)) - C).cwiseAbs().maxCoeff() < 1e-11);

  // Fewer directions than coefficients: the fit is exact at them, and of least norm.
  const Points few = points.topRows(30);
  const ShFit least(few, 6);
  CHECK(least.rank() == 30);
  const Eigen::MatrixXcd D = least(values_at(C, few));
  CHECK((values_at(D, few) - values_at(C, few)).cwiseAbs().maxCoeff() < 1e-10);
  CHECK(D.norm() < C.norm());
}

TEST_CASE("residual is what Parseval's equation leaves", "[descriptors][analytic]") {
  const Eigen::MatrixXcd C = random_coefficients(12, 3, 1);
  const Eigen::MatrixXd samples = sh_reconstruct(C, 64);
  double previous = 2;
  for (const int K : {0, 3, 7, 11, 12}) {
    const Eigen::MatrixXcd low = ShTransform(64, K)(samples);
    const double rest = (C.squaredNorm() - low.squaredNorm()) / C.squaredNorm();
    const double residual = sh_residual(low, samples, 64);
    INFO("K = " << K);
    CHECK(residual == Approx(std::sqrt(std::max(rest, 0.0))).margin(1e-7));
    CHECK(residual < previous);
    previous = residual;
  }
  CHECK(previous < 1e-12);
  CHECK(sh_residual(C, Eigen::MatrixXd::Zero(samples.rows(), 3), 64) == 0);
}

TEST_CASE("amplitudes stand degree by degree", "[descriptors]") {
  const Eigen::MatrixXcd C = random_coefficients(4, 2, 8);
  const Eigen::MatrixXd amplitudes = sh_amplitudes(C);
  REQUIRE(amplitudes.rows() == 15);
  CHECK(amplitudes(0, 0) == std::abs(C(0, 0)));
  CHECK(amplitudes(14, 1) == std::abs(C(sh_index(4, 4), 1)));
  CHECK(amplitudes(7, 0) == std::abs(C(sh_index(3, 1), 0)));
  CHECK(std::abs(C(sh_index(3, -1), 0)) == Approx(amplitudes(7, 0)));
}

TEST_CASE("spherical harmonics refuse what they cannot do", "[descriptors][contract]") {
  const auto refuses = [](auto&& call, const std::string& sentence) {
    CHECK_THROWS_MATCHES(call(), std::invalid_argument, Message(sentence));
  };
  refuses([] { return image_weights(7); }, "size is 7, expected an even number of rows");
  CHECK_THROWS_WITH(image_weights(2), Contains("size is 2, expected 4 "));
  CHECK_THROWS_WITH(image_weights(1026), Contains("size is 1026"));
  refuses([] { ShTransform(64, 32); }, "K is 32, expected 0 … 31, the bandwidth of 64 rows");
  refuses([] { ShTransform(64, -1); }, "K is -1, expected 0 … 31, the bandwidth of 64 rows");
  refuses([] { ShTransform(63, 3); }, "size is 63, expected an even number of rows");
  CHECK_THROWS_WITH(ShTransform(128, 33, ShRoute::svd), Contains("K is 33, expected 0 "));
  refuses([] { ShTransform(512, 16, ShRoute::svd); },
          "directions has 524288 rows, expected at most 232210 for K = 16");
  const ShTransform transform(8, 2);
  refuses([&] { return transform(Eigen::MatrixXd::Zero(127, 1)); },
          "samples has 127 rows, expected 128");
  Eigen::MatrixXd samples = Eigen::MatrixXd::Zero(128, 2);
  samples(5, 1) = std::numeric_limits<double>::quiet_NaN();
  refuses([&] { return transform(samples); }, "samples(5, 1) is nan, expected finite numbers");
  refuses([] { return sh_norms(Eigen::MatrixXcd::Zero(8, 1)); },
          "coefficients has 8 rows, expected (K + 1)², a square");
  refuses([] { return sh_component_gram(Eigen::MatrixXcd::Zero(9, 2)); },
          "coefficients has 2 components, expected the 3 of a vector field");
  refuses([] { return sh_reconstruct(Eigen::MatrixXcd::Zero(36, 1), 10); },
          "K is 5, expected 0 … 4, the bandwidth of 10 rows");
  refuses(
      [] { return sh_residual(Eigen::MatrixXcd::Zero(9, 2), Eigen::MatrixXd::Zero(128, 1), 8); },
      "samples has 1 components, expected those of coefficients, 2");
  Points directions = random_directions(10, 1);
  refuses([&] { ShFit(Points(0, 3), 1); }, "directions has no rows");
  directions.row(4) *= 2;
  refuses([&] { ShFit(directions, 1); },
          "directions: row 4 has the length 2, expected unit vectors");
  refuses([&] { return spherical_harmonics(directions, 1); },
          "directions: row 4 has the length 2, expected unit vectors");
  CHECK_THROWS_WITH(spherical_harmonics(random_directions(3, 1), 1001), Contains("K is 1001"));
}

}  // namespace
