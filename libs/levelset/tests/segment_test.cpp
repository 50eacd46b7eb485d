#include "shape3d/levelset/segment.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::levelset;
using Catch::Contains;

/// Tissue round a dark cavity that is open at both ends, with a bright ball and a rod in it.
struct Scene {
  Grid grid{{64, 60, 40}, {0.7, 0.7, 0.9}};
  std::vector<std::int16_t> samples;
  Eigen::Array<bool, -1, 1> tissue;
};

Scene make_scene(double noise, bool dark_objects = false) {
  Scene s;
  std::mt19937 random(17);
  std::normal_distribution<double> normal(0.0, 1.0);
  s.samples.resize(static_cast<std::size_t>(s.grid.size()));
  s.tissue.resize(s.grid.size());
  for (std::int64_t k = 0; k < s.grid.dims[2]; ++k)
    for (std::int64_t j = 0; j < s.grid.dims[1]; ++j)
      for (std::int64_t i = 0; i < s.grid.dims[0]; ++i) {
        const double x = 0.7 * static_cast<double>(i) - 22.1,
                     y = 0.7 * static_cast<double>(j) - 20.6,
                     z = 0.9 * static_cast<double>(k) - 17.4;
        const double wall = std::hypot(x / 1.1, y) - 16.0;      // > 0 in the wall
        const double ball = 4.5 - std::hypot(x - 5, y + 3, z);  // > 0 in the ball
        const double rod = 1.3 - std::hypot(y - 6 - 0.1 * z, x + 4);
        const double inside = std::max({wall, ball, rod});
        const double part = 0.5 * (1.0 + std::erf(inside / 0.6));
        const double value = (dark_objects ? 1.0 - part : part) * 900.0 - 850.0;
        const auto n = static_cast<std::size_t>(s.grid.index(i, j, k));
        s.samples[n] = static_cast<std::int16_t>(std::lround(value + noise * normal(random)));
        s.tissue[static_cast<Eigen::Index>(n)] = inside > 0.0;
      }
  return s;
}

double dice(const Eigen::Array<bool, -1, 1>& a, const Eigen::Array<bool, -1, 1>& b) {
  return 2.0 * static_cast<double>((a && b).count()) / static_cast<double>(a.count() + b.count());
}

TEST_CASE("a noisy scene is segmented, bright or dark", "[levelset]") {
  const bool dark = GENERATE(false, true);
  const double noise = GENERATE(25.0, 150.0);
  const Scene scene = make_scene(noise, dark);
  SegmentOptions options;
  options.mixture.classes = 2;
  if (dark) options.inside.inside = Inside::dark;
  const Segmentation s =
      segment(make_view(scene.samples.data(), scene.grid.dims, scene.grid.spacing), options);
  INFO("noise " << noise << ", dark " << dark << ": " << to_string(s.status) << ", level "
                << (s.calibration.levels.empty() ? 0.0 : s.calibration.levels[0]));
  CHECK(s.status == Status::converged);
  CHECK(dice((s.evolution.psi <= 0.0F), scene.tissue) > (noise < 100 ? 0.985 : 0.965));
  REQUIRE(s.calibration.levels.size() == 1);
  CHECK(s.calibration.levels[0] == Approx(-400).margin(50));
  CHECK(s.noise == Approx(noise).epsilon(0.2));
  CHECK((s.smoothing > 0.0) == (noise > 100));
  CHECK(s.inside == s.labels().cast<std::int64_t>().sum());
  CHECK(s.volume == Approx(static_cast<double>(s.inside) * 0.7 * 0.7 * 0.9));
  CHECK(s.warnings.empty());
  CHECK(s.fit.mixture.size() == 2);
  CHECK(s.histogram.total() == static_cast<double>(scene.grid.size()));
  CHECK(s.timings.estimation() > 0.0);
}

TEST_CASE("noise is smoothed until it is a sixth of the distance of the sides",
          "[levelset][analytic]") {
  SegmentOptions options;
  options.mixture.classes = 2;
  options.evolution.max_iterations = 1;
  for (const double noise : {200.0, 300.0, 400.0}) {
    const Scene scene = make_scene(noise);
    const ImageView view = make_view(scene.samples.data(), scene.grid.dims, scene.grid.spacing);
    options.smoothing = 0.0;
    // The sides as they are estimated from the image before it is smoothed.
    const GaussianMixture raw = segment(view, options).fit.mixture;
    options.smoothing = -1.0;
    const Segmentation s = segment(view, options);
    INFO("noise " << noise << ": " << s.smoothing);
    const double left = s.noise * std::pow(noise_gain(s.smoothing), 3);
    CHECK(left == Approx((raw.means[1] - raw.means[0]) / 6.0).epsilon(0.01));
  }
}

TEST_CASE("calibration makes the volume stable against the estimate", "[levelset][stability]") {
  // Twelve seeds of SEM, stopped after two iterations.
  const Scene scene = make_scene(25.0);
  const ImageView view = make_view(scene.samples.data(), scene.grid.dims, scene.grid.spacing);
  const auto spread = [&](bool calibrated) {
    double sum = 0.0, square = 0.0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      SegmentOptions options;
      options.mixture.chain = 2;
      options.mixture.runs = 1;
      options.mixture.seed = seed;
      options.calibrated = calibrated;
      const double volume = segment(view, options).volume;
      sum += volume;
      square += volume * volume;
    }
    return std::sqrt(std::max(square / 12 - sum / 12 * (sum / 12), 0.0));
  };
  const double with = spread(true), without = spread(false);
  INFO("standard deviation of the volume: " << with << " with, " << without << " without");
  CHECK(with < without / 5);
}

TEST_CASE("methods and starts are as asked for", "[levelset]") {
  const Scene scene = make_scene(25.0);
  const ImageView view = make_view(scene.samples.data(), scene.grid.dims, scene.grid.spacing);
  SegmentOptions options;
  options.mixture.classes = 2;
  options.speed.method = Method::intensity;
  const Segmentation intensity = segment(view, options);
  CHECK(intensity.calibration.curve.empty());
  CHECK(intensity.gradient_scale == 0.0);
  CHECK(intensity.status == Status::converged);

  // From a sphere in the ball: the ball alone, for nothing else is connected to it.
  options.speed.method = Method::combined;
  const Segmentation ball =
      segment(view, options, sphere_front(scene.grid, {38.7, 25.1, 19.3}, 2.0));
  CHECK(ball.status == Status::converged);
  CHECK(ball.volume == Approx(4.0 / 3.0 * 3.14159265 * std::pow(4.5, 3)).epsilon(0.08));

  options.evolution.curvature = 0.02;
  CHECK(segment(view, options).status == Status::converged);
}

TEST_CASE("what cannot be segmented has a status", "[levelset][contract]") {
  const std::vector<std::int16_t> constant(1000, 5);
  CHECK(segment(make_view(constant.data(), {10, 10, 10})).status == Status::constant_image);
  std::vector<std::uint8_t> binary(1000, 0);
  for (std::size_t n = 0; n < 500; ++n) binary[n] = 1;
  const Segmentation few = segment(make_view(binary.data(), {10, 10, 10}));
  CHECK(few.status == Status::too_few_bins);
  CHECK(few.evolution.psi.size() == 0);
  SegmentOptions options;
  options.mixture.classes = 2;
  options.mixture.method = MixtureMethod::em;
  options.inside.inside = Inside::classes;
  options.inside.classes = {0, 1};
  CHECK(segment(make_view(binary.data(), {10, 10, 10}), options).status == Status::one_sided);
}

TEST_CASE("spacings above 20 to 1 are warned of", "[levelset]") {
  Scene scene = make_scene(25.0);
  const ImageView view = make_view(scene.samples.data(), scene.grid.dims, {0.5, 0.5, 10.5});
  SegmentOptions options;
  options.mixture.classes = 2;
  options.evolution.max_iterations = 3;
  const Segmentation s = segment(view, options);
  REQUIRE(s.warnings.size() == 1);
  CHECK_THAT(s.warnings[0], Contains("anisotropic by 21 : 1"));
}

TEST_CASE("a segmentation can be cancelled in every stage", "[levelset]") {
  const Scene scene = make_scene(150.0);
  const ImageView view = make_view(scene.samples.data(), scene.grid.dims, scene.grid.spacing);
  SegmentOptions options;
  options.mixture.classes = 2;
  std::set<std::string> stages;
  options.progress = [&](const Progress& p) {
    stages.insert(std::string(p.stage));
    return true;
  };
  CHECK(segment(view, options).status == Status::converged);
  CHECK(stages == std::set<std::string>{"histogram", "mixture", "smoothing", "gradient",
                                        "calibration", "speed", "evolution"});
  for (const std::string& stage : stages) {
    options.progress = [&](const Progress& p) { return p.stage != stage; };
    INFO(stage);
    CHECK(segment(view, options).status == Status::cancelled);
  }
}

TEST_CASE("threads do not change a segmentation", "[levelset]") {
  const Scene scene = make_scene(60.0);
  const ImageView view = make_view(scene.samples.data(), scene.grid.dims, scene.grid.spacing);
  SegmentOptions options;
  options.threads = 1;
  const Segmentation one = segment(view, options);
  options.threads = 3;
  const Segmentation three = segment(view, options);
  CHECK((one.evolution.psi == three.evolution.psi).all());
  CHECK(one.calibration.lambda == three.calibration.lambda);
}

TEST_CASE("arguments of a segmentation that are wrong are refused", "[levelset][contract]") {
  std::vector<float> samples(1000, 1.0F);
  const ImageView view = make_view(samples.data(), {10, 10, 10});
  CHECK_THROWS_AS(segment(ImageView{}), std::invalid_argument);
  CHECK_THROWS_WITH(segment(view, {}, Field::Ones(3)), Contains("start: size is 3; expected 1000"));
  SegmentOptions options;
  options.smoothing = 17.0;
  CHECK_THROWS_WITH(segment(view, options),
                    Contains("smoothing is 17; expected at most 16 voxels"));
  options = {};
  options.threads = -1;
  CHECK_THROWS_WITH(segment(view, options), Contains("threads is -1"));
  samples[444] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(segment(view), Contains("sample (4, 4, 4) is NaN"));
}
}  // namespace
