#include "shape3d/levelset/local_mixture.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/levelset/segment.hpp"

namespace {
using namespace shape3d::levelset;
using Catch::Contains;

/// A blurred ball of radius 5 mm at (12, 13, 10) mm, and a bright bar that is far from it and
/// larger.
struct Scene {
  Grid grid{{36, 34, 22}, {0.8, 0.8, 1.0}};
  Eigen::Vector3d seed{15.0, 16.25, 10.0};
  std::vector<std::int16_t> samples;
};

Scene make_scene(double object, double around, double bar, double noise) {
  Scene s;
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (std::int64_t k = 0; k < s.grid.dims[2]; ++k)
    for (std::int64_t j = 0; j < s.grid.dims[1]; ++j)
      for (std::int64_t i = 0; i < s.grid.dims[0]; ++i) {
        const double x = 0.8 * static_cast<double>(i), y = 0.8 * static_cast<double>(j),
                     z = static_cast<double>(k);
        const double ball =
            0.5 * (1.0 + std::erf((5.0 - std::hypot(x - 12, y - 13, z - 10)) / 0.9));
        double value = around + ball * (object - around) + noise * normal(random);
        if (x > 23.0) value += bar - around;
        s.samples.push_back(static_cast<std::int16_t>(std::lround(value)));
      }
  return s;
}

ImageView view_of(const Scene& s) {
  return make_view(s.samples.data(), s.grid.dims, s.grid.spacing);
}

TEST_CASE("the classes of an object are what is at its seed and what is round it",
          "[levelset][analytic]") {
  const double noise = GENERATE(0.0, 25.0, 60.0);
  const bool dark = GENERATE(false, true);
  const double sign = dark ? -1.0 : 1.0;
  // Ground glass of −480 in lung of −800 beside tissue of 0, or its negative.
  const Scene s = make_scene(sign * -480, sign * -800, 0, noise);
  LocalMixtureOptions options;
  options.dark = dark;
  const GaussianMixture mixture = local_mixture(view_of(s), s.seed, options);
  INFO("noise " << noise << ", dark " << dark);
  REQUIRE(mixture.size() == 2);
  const int object = dark ? 0 : 1, around = 1 - object;
  // A median of 33 samples has a deviation of √(π/2) n / √33 = 0.22 n; a mode is within one of n.
  CHECK(mixture.means[object] == Approx(sign * -480).margin(0.8 * noise + 1));
  CHECK(mixture.means[around] == Approx(sign * -800).margin(0.6 * noise + 1));
  CHECK(mixture.weights[0] == 0.5);
  CHECK(mixture.variances[0] == mixture.variances[1]);
  // The boundary is half way.
  IntensityModel model = make_intensity_model(mixture);
  const std::vector<double> levels = model.levels(0.0);
  REQUIRE(levels.size() == 1);
  CHECK(levels[0] == Approx(0.5 * (mixture.means[0] + mixture.means[1])).margin(0.2));
}

TEST_CASE("an object that is neither the brightest nor the largest is segmented by its classes",
          "[levelset]") {
  const Scene s = make_scene(-480, -800, 0, 20);
  SegmentOptions options;
  options.known_mixture = local_mixture(view_of(s), s.seed);
  options.calibration.max_scope = 0.1;
  const Segmentation local = segment(view_of(s), options, sphere_front(s.grid, s.seed, 3.0));
  CHECK(local.status == Status::converged);
  CHECK(local.fit.stop == MixtureStop::given);
  CHECK((local.fit.mixture.means == options.known_mixture.means).all());
  const double ball = 4.0 / 3.0 * 3.14159265 * 125.0;
  CHECK(local.volume == Approx(ball).epsilon(0.06));
  // Two classes of the region are what is darker and what is brighter than the ball.
  SegmentOptions region;
  region.mixture.classes = 2;
  CHECK(segment(view_of(s), region, sphere_front(s.grid, s.seed, 3.0)).volume < 0.5 * ball);
}

TEST_CASE("an object that does not stand out has no classes", "[levelset][contract]") {
  const Scene s = make_scene(-480, -800, 0, 25);
  CHECK(local_mixture(view_of(s), {2.0, 2.0, 2.0}).size() == 0);  // in what is round it
  LocalMixtureOptions options;
  options.dark = true;
  CHECK(local_mixture(view_of(s), {34.0, 2.0, 2.0}, options).size() == 0);  // in the brightest
  const std::vector<float> constant(1000, 7.0F);
  CHECK(local_mixture(make_view(constant.data(), {10, 10, 10}), {5, 5, 5}).size() == 0);
}

TEST_CASE("arguments of a local mixture that are wrong are refused", "[levelset][contract]") {
  std::vector<float> samples(1000, 1.0F);
  const ImageView view = make_view(samples.data(), {10, 10, 10});
  CHECK_THROWS_AS(local_mixture(ImageView{}, {0, 0, 0}), std::invalid_argument);
  CHECK_THROWS_WITH(local_mixture(view, {5, -1, 5}), Contains("seed[1] is -1; expected 0 to 9"));
  CHECK_THROWS_WITH(local_mixture(view, {5, 5, 9.5}), Contains("seed[2] is 9.5"));
  CHECK_THROWS_WITH(local_mixture(view, {std::nan(""), 5, 5}), Contains("seed[0] is nan"));
  LocalMixtureOptions options;
  options.radius = -2.0;
  CHECK_THROWS_WITH(local_mixture(view, {5, 5, 5}, options),
                    Contains("radius is -2; expected a finite number of mm"));
  samples[444] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(local_mixture(view, {5, 5, 5}), Contains("sample (4, 4, 4) is NaN"));
}
}  // namespace
