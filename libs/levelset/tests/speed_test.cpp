#include "shape3d/levelset/speed.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/levelset/calibration.hpp"
#include "shape3d/levelset/gradient.hpp"

namespace {
using namespace shape3d::levelset;
using Catch::Contains;

IntensityModel model() {
  GaussianMixture m;
  m.weights = Eigen::ArrayXd::Constant(2, 0.5);
  m.means.resize(2);
  m.means << 0, 1000;
  m.variances = Eigen::ArrayXd::Constant(2, 200 * 200);
  return make_intensity_model(m);
}

const Grid kGrid{{40, 8, 7}, {1, 1, 1}};

std::vector<float> edge_image() {
  std::vector<float> samples(static_cast<std::size_t>(kGrid.size()));
  for (std::int64_t n = 0; n < kGrid.size(); ++n)
    samples[static_cast<std::size_t>(n)] =
        static_cast<float>(500 * (1 + std::erf((static_cast<double>(n % 40) - 19.5) / 2)));
  return samples;
}

TEST_CASE("the fuzzy table holds at its corners and rises between", "[levelset]") {
  CHECK(fuzzy_factor(0.0F, 0.0F) == 0.0F);
  CHECK(fuzzy_factor(1.0F, 1.0F) == 1.0F);
  CHECK(fuzzy_factor(0.0F, 1.0F) == Approx(0.5));
  CHECK(fuzzy_factor(1.0F, 0.0F) == Approx(0.5));
  CHECK(fuzzy_factor(0.5F, 0.5F) == Approx(0.5));
  for (int a = 0; a <= 20; ++a) {
    for (int b = 0; b <= 20; ++b) {
      const float x = static_cast<float>(a) / 20, y = static_cast<float>(b) / 20;
      const float k = fuzzy_factor(x, y);
      CHECK(k == Approx(fuzzy_factor(y, x)));
      CHECK(k >= 0.0F);
      CHECK(k <= 1.0F);
      if (a < 20) CHECK(fuzzy_factor(x + 0.05F, y) >= k - 1e-6F);
    }
  }
}

TEST_CASE("k_I is one half at the scale and falls with the exponent", "[levelset][analytic]") {
  CHECK(gradient_factor(0.0F, 10.0F, 2.0F) == 1.0F);
  CHECK(gradient_factor(10.0F, 10.0F, 2.0F) == Approx(0.5));
  CHECK(gradient_factor(30.0F, 10.0F, 2.0F) == Approx(0.1));
  CHECK(gradient_factor(20.0F, 10.0F, 3.0F) == Approx(1.0 / 9.0));
  CHECK(gradient_factor(20.0F, 0.0F, 3.0F) == 1.0F);
}

TEST_CASE("a quantile counts", "[levelset]") {
  Field field(1001);
  for (Eigen::Index i = 0; i <= 1000; ++i) field[(i * 37) % 1001] = static_cast<float>(i);
  for (const double q : {0.05, 0.5, 0.95})
    CHECK(quantile(field, q) == Approx(1000 * q).margin(1.5));
  CHECK(quantile(Field::Zero(5), 0.5) == 0.0);
  CHECK(quantile(Field(), 0.5) == 0.0);
}

TEST_CASE("intensity alone is -phi at w = 0", "[levelset][analytic]") {
  const std::vector<float> samples = edge_image();
  SpeedOptions options;
  options.method = Method::intensity;
  const Speed speed =
      make_speed(make_view(samples.data(), kGrid.dims), {}, model(), 3.0, true, options);
  for (std::int64_t n = 0; n < kGrid.size(); ++n) {
    CHECK(speed.advance[n] ==
          Approx(-model().phi(samples[static_cast<std::size_t>(n)], 0.0)).margin(1e-3));
    CHECK(speed.factor[n] == 1.0F);
  }
}

TEST_CASE("the combined speed is the product of its parts", "[levelset][analytic]") {
  const std::vector<float> samples = edge_image();
  const ImageView view = make_view(samples.data(), kGrid.dims);
  const Field gradient = gradient_magnitude(view);
  const IntensityModel m = model();
  const double lambda = m.log_odds(650);
  SpeedOptions options;
  options.boundary_width = 1.5;
  options.min_factor = 0.0;
  const Speed speed = make_speed(view, gradient, m, lambda, true, options);
  CHECK(speed.gradient_scale == Approx(quantile(gradient, 0.95)));
  const Field y = boundary_detector(view, m, lambda, 1.5);
  for (std::int64_t n = 0; n < kGrid.size(); ++n) {
    const float k = fuzzy_factor(
        gradient_factor(gradient[n], static_cast<float>(speed.gradient_scale), 2.0F), 1.0F - y[n]);
    const double a = std::tanh(0.5 * (m.log_odds(samples[static_cast<std::size_t>(n)]) - lambda));
    CHECK(speed.factor[n] == Approx(k).margin(2e-3));
    CHECK(speed.advance[n] == Approx(k * a).margin(3e-3));
  }
  // Its zero is at the calibrated level: the speed expands above it and shrinks below.
  for (std::int64_t n = 0; n < kGrid.size(); ++n) {
    if (std::abs(samples[static_cast<std::size_t>(n)] - 650) < 1) continue;
    CHECK((speed.advance[n] > 0) == (samples[static_cast<std::size_t>(n)] > 650));
  }
}

TEST_CASE("gradient alone has the direction asked for, and k its least value", "[levelset]") {
  const std::vector<float> samples = edge_image();
  const ImageView view = make_view(samples.data(), kGrid.dims);
  const Field gradient = gradient_magnitude(view);
  SpeedOptions options;
  options.method = Method::gradient;
  options.min_factor = 0.6;
  const Speed shrink = make_speed(view, gradient, IntensityModel(), 0.0, false, options);
  CHECK(shrink.factor.size() == 0);
  CHECK(shrink.advance.maxCoeff() == Approx(-0.6));
  CHECK(shrink.advance.minCoeff() == Approx(-1.0).margin(1e-3));
  options.direction = 1.0;
  const Speed expand = make_speed(view, gradient, IntensityModel(), 0.0, false, options);
  CHECK((expand.advance == -shrink.advance).all());
}

TEST_CASE("settings of a speed out of range are refused", "[levelset][contract]") {
  std::vector<float> samples(27, 1.0F);
  const ImageView view = make_view(samples.data(), {3, 3, 3});
  const Field g = Field::Zero(27);
  const auto refused = [&](void (*change)(SpeedOptions&), const char* message) {
    SpeedOptions options;
    change(options);
    CHECK_THROWS_WITH(make_speed(view, g, model(), 0.0, false, options), Contains(message));
  };
  refused([](SpeedOptions& o) { o.exponent = 0; }, "exponent is 0");
  refused([](SpeedOptions& o) { o.gradient_quantile = 1; }, "gradient_quantile is 1");
  refused([](SpeedOptions& o) { o.boundary_width = -1; }, "boundary_width is -1");
  refused([](SpeedOptions& o) { o.direction = 0.5; },
          "direction is 0.5; expected -1 (shrink) or 1");
  refused([](SpeedOptions& o) { o.min_factor = 2; }, "min_factor is 2");
  refused([](SpeedOptions& o) { o.threads = -3; }, "threads is -3");
  CHECK_THROWS_WITH(make_speed(view, {}, model(), 0.0, false),
                    Contains("gradient: size is 0; expected 27"));
  CHECK_THROWS_WITH(make_speed(view, g, IntensityModel(), 0.0, false),
                    Contains("model is one with all classes on one side"));
  samples[26] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(make_speed(view, g, model(), 0.0, false), Contains("sample (2, 2, 2) is NaN"));
}
}  // namespace
