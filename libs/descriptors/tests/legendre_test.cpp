#include "legendre.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

namespace {
using shape3d::descriptors::Legendre;

constexpr double kPi = 3.14159265358979323846;

std::vector<double> values_at(const Legendre& legendre, double theta) {
  std::vector<double> values(Legendre::count(legendre.degree()));
  legendre.evaluate(std::cos(theta), std::sin(theta), values.data());
  return values;
}

// Nodes and weights of Gauss–Legendre quadrature on [−1, 1] by Newton's method.
void gauss_legendre(int n, std::vector<double>& nodes, std::vector<double>& weights) {
  nodes.resize(static_cast<std::size_t>(n));
  weights.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 1.0;
    for (int step = 0; step < 100; ++step) {
      double p = 1.0, before = 0.0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k;
        before = p;
        p = next;
      }
      slope = n * (x * p - before) / (x * x - 1.0);
      const double change = p / slope;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    nodes[static_cast<std::size_t>(i)] = x;
    weights[static_cast<std::size_t>(i)] = 2.0 / ((1.0 - x * x) * slope * slope);
  }
}

TEST_CASE("Legendre functions of low degree have their closed forms", "[descriptors][analytic]") {
  const Legendre legendre(3);
  for (const double theta : {0.0, 1e-9, 0.3, 1.1, kPi / 2, 2.8, kPi}) {
    const double c = std::cos(theta), s = std::sin(theta);
    const std::vector<double> p = values_at(legendre, theta);
    INFO("theta = " << theta);
    CHECK(p[Legendre::index(0, 0)] == Approx(std::sqrt(1 / (4 * kPi))).epsilon(1e-15));
    CHECK(p[Legendre::index(1, 0)] == Approx(std::sqrt(3 / (4 * kPi)) * c).margin(1e-15));
    CHECK(p[Legendre::index(1, 1)] == Approx(-std::sqrt(3 / (8 * kPi)) * s).margin(1e-15));
    CHECK(p[Legendre::index(2, 0)] ==
          Approx(std::sqrt(5 / (16 * kPi)) * (3 * c * c - 1)).margin(1e-15));
    CHECK(p[Legendre::index(2, 1)] == Approx(-std::sqrt(15 / (8 * kPi)) * s * c).margin(1e-15));
    CHECK(p[Legendre::index(2, 2)] == Approx(std::sqrt(15 / (32 * kPi)) * s * s).margin(1e-15));
    CHECK(p[Legendre::index(3, 2)] ==
          Approx(std::sqrt(105 / (32 * kPi)) * s * s * c).margin(1e-15));
    CHECK(p[Legendre::index(3, 3)] ==
          Approx(-std::sqrt(35 / (64 * kPi)) * s * s * s).margin(1e-15));
  }
}

TEST_CASE("Legendre functions up to degree 160 are orthonormal in each order",
          "[descriptors][analytic]") {
  // Products of two have degree <= 320 in cos θ and an even power of sin θ: 161 nodes are exact.
  const int degree = 160;
  const Legendre legendre(degree);
  std::vector<double> nodes, weights;
  gauss_legendre(degree + 1, nodes, weights);
  std::vector<std::vector<double>> at_nodes;
  for (const double x : nodes) {
    std::vector<double> values(Legendre::count(degree));
    legendre.evaluate(x, std::sqrt((1 - x) * (1 + x)), values.data());
    at_nodes.push_back(values);
  }
  double worst = 0;
  for (int m = 0; m <= degree; m += 1) {
    for (int l = m; l <= degree; ++l) {
      for (int k = l; k <= degree; k += 7) {
        double product = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          product += 2 * kPi * weights[i] * at_nodes[i][Legendre::index(l, m)] *
                     at_nodes[i][Legendre::index(k, m)];
        }
        worst = std::max(worst, std::abs(product - (k == l ? 1.0 : 0.0)));
      }
    }
  }
  CHECK(worst < 2e-13);  // 160 steps of the recurrence, each at rounding level
}

TEST_CASE("the addition theorem holds up to degree 1000 and at the poles",
          "[descriptors][analytic]") {
  // Σ_m |Y_l^m|² = (2l+1)/4π at every point: neither underflow nor growth in any order. Near the
  // poles a rounding error at degree k is carried to degree l as (l − k) times itself: l² ε / 2.
  const int degree = 1000;
  const Legendre legendre(degree);
  for (const double theta : {0.0, 1e-12, 1e-5, 1e-3, 0.02, 0.5, 1.3, kPi / 2, 3.0, kPi}) {
    const std::vector<double> p = values_at(legendre, theta);
    double worst = 0;
    for (int l = 0; l <= degree; ++l) {
      double sum = 0;
      for (int m = 0; m <= l; ++m) {
        sum += (m == 0 ? 1 : 2) * p[Legendre::index(l, m)] * p[Legendre::index(l, m)];
      }
      worst = std::max(worst, std::abs(sum * 4 * kPi / (2 * l + 1) - 1));
    }
    INFO("theta = " << theta << ", worst " << worst);
    CHECK(worst < 0.5 * degree * degree * std::numeric_limits<double>::epsilon());
  }
}

TEST_CASE("Legendre functions agree with the standard library's", "[descriptors][analytic]") {
  // std::sph_legendre computes each by another route, at lower degree.
  const Legendre legendre(60);
  double worst = 0;
  for (double theta = 0.05; theta < kPi; theta += 0.17) {
    const std::vector<double> p = values_at(legendre, theta);
    for (unsigned l = 0; l <= 60; ++l) {
      for (unsigned m = 0; m <= l; ++m) {
        worst =
            std::max(worst, std::abs(p[Legendre::index(static_cast<int>(l), static_cast<int>(m))] -
                                     std::sph_legendre(l, m, theta)));
      }
    }
  }
  CHECK(worst < 1e-12);
}

}  // namespace
