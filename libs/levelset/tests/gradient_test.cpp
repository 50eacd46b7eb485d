#include "shape3d/levelset/gradient.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::levelset;
using Catch::Contains;

template <class T, class Function>
std::vector<T> sample(const Grid& grid, const Function& f) {
  std::vector<T> samples(static_cast<std::size_t>(grid.size()));
  for (std::int64_t k = 0; k < grid.dims[2]; ++k)
    for (std::int64_t j = 0; j < grid.dims[1]; ++j)
      for (std::int64_t i = 0; i < grid.dims[0]; ++i)
        samples[static_cast<std::size_t>(grid.index(i, j, k))] = static_cast<T>(
            f(static_cast<double>(i) * grid.spacing[0], static_cast<double>(j) * grid.spacing[1],
              static_cast<double>(k) * grid.spacing[2]));
  return samples;
}

TEST_CASE("a ramp has its slope in millimetres, whatever the spacing", "[levelset][analytic]") {
  const Grid grid{{21, 19, 17}, {0.5, 1.25, 3.0}};
  const double sigma = GENERATE(0.0, 1.0, 2.5);
  const auto samples =
      sample<double>(grid, [](double x, double y, double z) { return 3 * x - 4 * y + 12 * z; });
  const Field g = gradient_magnitude(make_view(samples.data(), grid.dims, grid.spacing), sigma);
  // Away from the border, where rows end by repetition: 3σ is at most 15 nodes along x.
  const std::int64_t i = 10, j = 9, k = 8;
  if (sigma < 2.0) CHECK(g[grid.index(i, j, k)] == Approx(13.0).epsilon(1e-5));
  const Field middle = gradient_magnitude(make_view(samples.data(), grid.dims, grid.spacing), 0.0);
  CHECK(middle[grid.index(5, 6, 7)] == Approx(13.0).epsilon(1e-5));
}

TEST_CASE("a constant image has no gradient", "[levelset][analytic]") {
  const std::vector<std::int16_t> samples(15 * 12 * 9, -850);
  const Field g = gradient_magnitude(make_view(samples.data(), {15, 12, 9}), 1.3);
  CHECK(g.abs().maxCoeff() < 1e-3);  // rounding of 850 in float: 850 · 2⁻²⁴ · a few terms
}

TEST_CASE("the gradient of a Gaussian blob is that of a wider one", "[levelset][analytic]") {
  // G_σ ∗ N(0, s²) = N(0, s² + σ²): |∇| = A·r/S² exp(−r²/2S²), with A = (s/S)³ and S² = s² + σ².
  const double s = 4.0, sigma = 2.0, wide = s * s + sigma * sigma;
  const Grid grid{{49, 49, 33}, {1.0, 1.0, 1.5}};
  const auto r2 = [](double x, double y, double z) {
    return (x - 24) * (x - 24) + (y - 24) * (y - 24) + (z - 24) * (z - 24);
  };
  const auto samples = sample<float>(grid, [&](double x, double y, double z) {
    return 1000 * std::exp(-0.5 * r2(x, y, z) / (s * s));
  });
  const Field g = gradient_magnitude(make_view(samples.data(), grid.dims, grid.spacing), sigma);
  const double peak = 1000 * std::pow(s * s / wide, 1.5);
  double worst = 0.0, greatest = 0.0;
  for (std::int64_t k = 9; k < 24; ++k) {
    for (std::int64_t j = 14; j < 35; ++j) {
      for (std::int64_t i = 14; i < 35; ++i) {
        const double square =
            r2(static_cast<double>(i), static_cast<double>(j), 1.5 * static_cast<double>(k));
        const double exact = peak * std::sqrt(square) / wide * std::exp(-0.5 * square / wide);
        worst = std::max(worst, std::abs(g[grid.index(i, j, k)] - exact));
        greatest = std::max(greatest, exact);
      }
    }
  }
  // The kernel cut at 3σ has 2.7 % less variance than σ².
  CHECK(worst < 0.02 * greatest);
}

TEST_CASE("sample type, strides, threads do not change the gradient", "[levelset]") {
  std::mt19937 random(5);
  const Grid grid{{40, 21, 13}, {0.7, 0.7, 1.0}};
  const auto samples = sample<std::int16_t>(
      grid, [&](double, double, double) { return static_cast<int>(random() % 2000) - 1000; });
  const ImageView view = make_view(samples.data(), grid.dims, grid.spacing);
  const Field g = gradient_magnitude(view, 1.0, 1);
  CHECK((gradient_magnitude(view, 1.0, 3) == g).all());
  const std::vector<double> reals(samples.begin(), samples.end());
  CHECK((gradient_magnitude(make_view(reals.data(), grid.dims, grid.spacing), 1.0) == g).all());
  // Mirrored along x by a negative stride.
  ImageView mirrored = view;
  mirrored.data = samples.data() + 39;
  mirrored.strides = {-1, 40, 40 * 21};
  const Field m = gradient_magnitude(mirrored, 1.0);
  for (std::int64_t i = 0; i < 40; ++i)
    CHECK(m[grid.index(i, 4, 5)] == Approx(g[grid.index(39 - i, 4, 5)]).epsilon(1e-4));
}

TEST_CASE("smoothing keeps constants and ramps and lowers noise as it should",
          "[levelset][analytic]") {
  // White noise under a sampled Gaussian keeps Π Σ g²: about (2√π σ)^(−3) of its variance.
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0.0, 100.0);
  const Grid grid{{60, 60, 40}, {1, 1, 1}};
  const auto samples = sample<float>(grid, [&](double, double, double) { return normal(random); });
  const Field s = smooth(make_view(samples.data(), grid.dims), 1.0);
  double variance = 0.0;  // away from the border, where samples repeat
  for (std::int64_t k = 3; k < 37; ++k)
    for (std::int64_t j = 3; j < 57; ++j)
      for (std::int64_t i = 3; i < 57; ++i)
        variance +=
            static_cast<double>(s[grid.index(i, j, k)]) * s[grid.index(i, j, k)] / (34.0 * 54 * 54);
  CHECK(std::sqrt(variance) ==
        Approx(100.0 * std::pow(2.0 * std::sqrt(3.14159265), -1.5)).epsilon(0.05));
  CHECK(std::sqrt(variance) == Approx(100.0 * std::pow(noise_gain(1.0), 3)).epsilon(0.02));
  const auto ramp = sample<float>(grid, [](double x, double, double z) { return 2 * x - z; });
  const Field r = smooth(make_view(ramp.data(), grid.dims), 0.8);
  CHECK(r[grid.index(30, 30, 20)] == Approx(40.0).epsilon(1e-5));
  const Field same = smooth(make_view(ramp.data(), grid.dims), 0.2);  // too narrow to do anything
  CHECK((same == Eigen::Map<const Field>(ramp.data(), grid.size())).all());
}

TEST_CASE("a wider Gaussian leaves less noise", "[levelset][analytic]") {
  CHECK(noise_gain(0.0) == 1.0);
  CHECK(noise_gain(0.29) == 1.0);
  // Three samples: √(1 + 2q²)/(1 + 2q) with q = exp(−½/σ²).
  const double q = std::exp(-0.5 / 0.09);
  CHECK(noise_gain(0.3) == Approx(std::sqrt(1 + 2 * q * q) / (1 + 2 * q)).epsilon(1e-6));
  // ∫ G_σ² = 1/(2√π σ): of a wide kernel, but for 0.2 % that is cut off at 3σ.
  CHECK(noise_gain(8.0) ==
        Approx(std::pow(2.0 * std::sqrt(3.14159265) * 8.0, -0.5)).epsilon(0.005));
  double before = 1.0;
  for (double sigma = 0.3; sigma < 3.0; sigma += 0.05) {
    CHECK(noise_gain(sigma) < before);
    before = noise_gain(sigma);
  }
}

TEST_CASE("the noise of an image with edges is found", "[levelset]") {
  std::mt19937 random(1);
  const double deviation = GENERATE(10.0, 25.0, 150.0);
  std::normal_distribution<double> normal(0.0, deviation);
  const Grid grid{{80, 80, 30}, {1, 1, 1}};
  const auto samples = sample<std::int16_t>(grid, [&](double x, double y, double) {
    return std::lround((std::fmod(x + y, 20.0) < 10 ? -800 : 0) + normal(random));
  });
  // Each edge is in 2 of 10 differences along x: the median then reads high by a third at most.
  const double found = noise_deviation(make_view(samples.data(), grid.dims));
  CHECK(found > 0.95 * deviation);
  CHECK(found < 1.4 * deviation);
  const std::vector<float> two(8, 1.0F);
  CHECK(noise_deviation(make_view(two.data(), {2, 2, 2})) == 0.0);
}

TEST_CASE("settings of a filter out of range are refused", "[levelset][contract]") {
  std::vector<float> samples(27, 1.0F);
  const ImageView view = make_view(samples.data(), {3, 3, 3});
  CHECK_THROWS_WITH(gradient_magnitude(view, -1.0), Contains("sigma is -1"));
  CHECK_THROWS_WITH(gradient_magnitude(view, 33.0), Contains("at most 32 of the least spacing"));
  CHECK_THROWS_WITH(smooth(view, std::numeric_limits<double>::infinity()),
                    Contains("sigma is inf"));
  CHECK_THROWS_WITH(noise_gain(-1.0), Contains("sigma is -1; expected from 0 to 32 spacings"));
  CHECK_THROWS_WITH(noise_gain(std::numeric_limits<double>::quiet_NaN()), Contains("sigma is nan"));
  CHECK_THROWS_WITH(gradient_magnitude(view, 1.0, -2), Contains("threads is -2"));
  samples[13] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(gradient_magnitude(view), Contains("sample (1, 1, 1) is NaN"));
  CHECK_THROWS_WITH(smooth(view, 1.0), Contains("sample (1, 1, 1) is NaN"));
  CHECK_THROWS_WITH(noise_deviation(view), Contains("sample (1, 1, 1) is NaN"));
  CHECK_THROWS_AS(gradient_magnitude(ImageView{}), std::invalid_argument);
}
}  // namespace
