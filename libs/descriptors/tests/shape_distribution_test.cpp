#include "shape3d/descriptors/shape_distribution.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "meshes.hpp"

namespace {
using namespace shape3d::descriptors;
using namespace shape3d::descriptors::test;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

TEST_CASE("the D2 histogram of a sphere has its closed form", "[descriptors][analytic]") {
  // Chords of the unit sphere: P(d < t) = t²/4, mean 4/3. Shares vary by √(p(1−p)/n).
  const Soup ball = sphere(100);
  D2Options options;
  options.range = 1.5;  // up to the diameter
  const Eigen::VectorXd histogram = d2_histogram(ball.V, ball.F, options);
  REQUIRE(histogram.size() == 64);
  CHECK(histogram.sum() == Approx(1).epsilon(1e-12));
  for (int b = 0; b < 63; ++b) {  // the last bin gathers what rounding pushes beyond
    const double low = b / 32.0, high = (b + 1) / 32.0;
    const double share = (high * high - low * low) / 4;
    INFO("bin " << b);
    CHECK(std::abs(histogram[b] - share) <
          5 * std::sqrt(share / options.pairs) + 2e-4);  // the mean and the facets
  }
}

TEST_CASE("points are drawn by area", "[descriptors][analytic]") {
  // Two far squares of areas 1 and 3: 3/8 of the pairs join different squares.
  Soup far = joined(box({0, 0, 0}, {1, 1, 1e-9}), box({1000, 0, 0}, {1003, 1, 1e-9}));
  D2Options options;
  options.pairs = 400000;
  options.bins = 2;
  options.range = 2;  // bin 0 ends at the mean
  const Eigen::VectorXd histogram = d2_histogram(far.V, far.F, options);
  CHECK(std::abs(histogram[1] - 0.375) < 5 * std::sqrt(0.375 * 0.625 / options.pairs));
  CHECK(d2_histogram(far.V, far.F, options, 1) == d2_histogram(far.V, far.F, options, 3));
  D2Options other = options;
  other.seed = 2;
  CHECK(d2_histogram(far.V, far.F, other) != histogram);
}

TEST_CASE("D2 does not change with pose and size", "[descriptors][property]") {
  const Soup body = bumpy(10);
  const Soup moved = transformed(body, 1e6 * random_rotation(4), Vector3d(1e7, 2e7, -1e7));
  const Eigen::VectorXd a = d2_histogram(body.V, body.F), b = d2_histogram(moved.V, moved.F);
  CHECK((a - b).cwiseAbs().sum() < 1e-3);  // the same draws; some cross a bin's border by rounding
}

TEST_CASE("the extended Gaussian image of a cube follows its symmetry", "[descriptors][analytic]") {
  // Six equal normals: E_l = 0 for odd l and for l = 2, and by the addition theorem
  // Σ_m |E_l^m|² = (2l+1)/4π · mean of P_l(n·n') = (2l+1)/4π (P_l(1) + P_l(−1) + 4 P_l(0)) / 6.
  const Soup cube = box({-1, -1, -1}, {1, 1, 1});
  const Soup turned = transformed(cube, random_rotation(9));
  const Eigen::VectorXd power = egi_power(turned.V, turned.F, 12);
  for (unsigned l = 0; l <= 12; ++l) {
    const double mean = (1 + (l % 2 == 0 ? 1 : -1) + 4 * std::legendre(l, 0.0)) / 6;
    INFO("l " << l);
    CHECK(power[l] ==
          Approx(std::sqrt(std::max(0.0, (2 * l + 1) / (4 * kPi) * mean))).margin(1e-7));
  }
  const Soup body = bumpy(6);
  Soup reversed = body;
  reversed.F.col(0).swap(reversed.F.col(1));
  CHECK((egi_power(body.V, body.F, 10) - egi_power(reversed.V, reversed.F, 10)).norm() < 1e-13);
  CHECK(extended_gaussian_image(body.V, body.F, 10, 1) ==
        extended_gaussian_image(body.V, body.F, 10, 3));
  // E_1 is the sum of area vectors, 0 for a closed surface; E_0 = Y_0^0.
  CHECK(egi_power(body.V, body.F, 3)[1] < 1e-12);
  CHECK(egi_power(body.V, body.F, 3)[0] == Approx(1 / std::sqrt(4 * kPi)));
}

TEST_CASE("random descriptors are uniform and belong to the mesh", "[descriptors][property]") {
  const Soup body = bumpy(3);
  const Eigen::VectorXd numbers = random_descriptor(body.V, body.F, 100000);
  CHECK(numbers.minCoeff() >= 0);
  CHECK(numbers.maxCoeff() < 1);
  CHECK(std::abs(numbers.mean() - 0.5) < 5 * std::sqrt(1.0 / 12 / 100000));
  CHECK(std::abs((numbers.array() - 0.5).square().mean() - 1.0 / 12) < 0.002);
  CHECK(random_descriptor(body.V, body.F, 10) == random_descriptor(body.V, body.F, 10));
  CHECK(random_descriptor(body.V, body.F, 10) != random_descriptor(body.V, body.F, 10, 2));
  const Soup other = bumpy(4);
  CHECK(random_descriptor(body.V, body.F, 10) != random_descriptor(other.V, other.F, 10));
}

TEST_CASE("wrong options of shape distributions are refused", "[descriptors][contract]") {
  const Soup cube = box({0, 0, 0}, {1, 1, 1});
  D2Options options;
  options.bins = 1;
  CHECK_THROWS_WITH(d2_histogram(cube.V, cube.F, options), "bins is 1, expected 2 … 4096");
  options.bins = 8;
  options.pairs = 0;
  CHECK_THROWS_WITH(d2_histogram(cube.V, cube.F, options), "pairs is 0, expected 1 … 1000000000");
  options.pairs = 10;
  options.range = 0;
  CHECK_THROWS_WITH(d2_histogram(cube.V, cube.F, options),
                    "range is 0, expected a positive finite number");
  CHECK_THROWS_WITH(egi_power(cube.V, cube.F, 1001), "K is 1001, expected 0 … 1000");
  CHECK_THROWS_WITH(random_descriptor(cube.V, cube.F, 0), "length is 0, expected 1 … 16777216");
  Soup flat = cube;
  flat.V.setZero();
  CHECK_THROWS_WITH(d2_histogram(flat.V, flat.F, D2Options{}),
                    "the mesh has no area: all 12 triangles are degenerate");
  CHECK_THROWS_WITH(extended_gaussian_image(flat.V, flat.F, 3),
                    "the mesh has no area: all 12 triangles are degenerate");
}

}  // namespace
