#include "shape3d/levelset/intensity_model.hpp"

#include <cmath>
#include <stdexcept>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::levelset;
using Catch::Contains;

GaussianMixture two_classes(double deviation_a = 40, double deviation_b = 40) {
  GaussianMixture m;
  m.weights.resize(2);
  m.means.resize(2);
  m.variances.resize(2);
  m.weights << 0.5, 0.5;
  m.means << -800, 0;
  m.variances << deviation_a * deviation_a, deviation_b * deviation_b;
  return m;
}

GaussianMixture four_classes() {
  GaussianMixture m;
  m.weights.resize(4);
  m.means.resize(4);
  m.variances.resize(4);
  m.weights << 0.4, 0.1, 0.3, 0.2;
  m.means << -850, -780, 0, 100;
  m.variances << 900, 2500, 900, 2500;
  return m;
}

TEST_CASE("log-odds of two equal Gaussians are linear", "[levelset][analytic]") {
  // Λ(u) = (μ₁ − μ₀)/σ² · (u − (μ₀ + μ₁)/2); so a level λ lies at −400 + λσ²/800.
  const IntensityModel model = make_intensity_model(two_classes());
  for (const double u : {-800.0, -612.5, -400.0, -1.0, 0.0})
    CHECK(model.log_odds(u) == Approx(800.0 / 1600.0 * (u + 400.0)).margin(1e-9));
  for (const double lambda : {-100.0, 0.0, 3.0, 150.0}) {
    REQUIRE(model.levels(lambda).size() == 1);
    CHECK(model.levels(lambda).front() == Approx(-400.0 + lambda * 2.0).margin(1e-6));
  }
  CHECK(model.levels(201.0).empty());
  CHECK(model.min_log_odds() == Approx(-200.0));
  CHECK(model.max_log_odds() == Approx(200.0));
}

TEST_CASE("phi is the difference of the posteriors less the offset", "[levelset][analytic]") {
  const IntensityModel model = make_intensity_model(two_classes(300, 250));
  for (const double u : {-700.0, -400.0, -300.0, -50.0}) {
    const double in = model.density_inside(u), out = model.density_outside(u);
    for (const double w : {-0.5, 0.0, 0.25})
      CHECK(model.phi(u, w) == Approx((out - in) / (out + in) - w).margin(1e-4));
  }
  CHECK(model.density_inside(-300.0) == Approx(model.mixture().component(1, -300.0)));
  CHECK(model.density_inside(-300.0) + model.density_outside(-300.0) ==
        Approx(model.mixture().density(-300.0)));
  // The level of λ is the zero of φ at w = −tanh(λ/2).
  for (const double lambda : {-2.0, 0.5, 2.0}) {
    const double level = model.levels(lambda).front();
    CHECK(model.phi(level, offset_of_log_odds(lambda)) == Approx(0.0).margin(1e-4));
  }
}

TEST_CASE("beyond the outer means the log-odds are constant", "[levelset]") {
  const IntensityModel model = make_intensity_model(two_classes(120, 40));
  CHECK(model.log_odds(-3000) == model.log_odds(-800));
  CHECK(model.log_odds(2000) == model.log_odds(0));
}

TEST_CASE("a wide class does not overtake a narrow one twice", "[levelset]") {
  // Unbounded, N(−800, 300²) exceeds N(0, 10²) again a little above 0.
  const IntensityModel model = make_intensity_model(two_classes(300, 10));
  double before = model.log_odds(-800);
  for (double u = -800; u <= 400; u += 0.5) {
    const double now = model.log_odds(u);
    CHECK(now >= before);
    before = now;
  }
  CHECK(model.log_odds(400) > 0.0);
  CHECK(model.levels(0.0).size() == 1);
}

TEST_CASE("bright and dark split the classes at the widest gap", "[levelset]") {
  const IntensityModel bright = make_intensity_model(four_classes());
  CHECK(bright.inside() == std::vector<bool>{false, false, true, true});
  const IntensityModel dark = make_intensity_model(four_classes(), {Inside::dark, {}});
  CHECK(dark.inside() == std::vector<bool>{true, true, false, false});
  for (double u = -900; u < 200; u += 7) {
    CHECK(dark.log_odds(u) == Approx(-bright.log_odds(u)));
    CHECK(dark.density_inside(u) == bright.density_outside(u));
  }
  CHECK(bright.is_split());
  CHECK(bright.levels(0.0).front() == Approx(dark.levels(0.0).front()).margin(0.3));
}

TEST_CASE("a class in the middle has a level on each side", "[levelset]") {
  GaussianMixture m;
  m.weights = Eigen::ArrayXd::Constant(3, 1.0 / 3.0);
  m.means.resize(3);
  m.means << 0, 100, 200;
  m.variances = Eigen::ArrayXd::Constant(3, 100);
  const IntensityModel model = make_intensity_model(m, {Inside::classes, {1}});
  CHECK_FALSE(model.is_split());
  const std::vector<double> levels = model.levels(0.0);
  REQUIRE(levels.size() == 2);
  CHECK(levels[0] == Approx(50).margin(0.01));
  CHECK(levels[1] == Approx(150).margin(0.01));
  CHECK(model.signed_level_distance(60, levels, 0.0) == Approx(10).margin(0.01));
  CHECK(model.signed_level_distance(170, levels, 0.0) == Approx(-20).margin(0.01));
  CHECK(model.signed_level_distance(20, levels, 0.0) == Approx(-30).margin(0.01));
}

TEST_CASE("one-sided models say so", "[levelset]") {
  CHECK_FALSE(make_intensity_model(four_classes(), {Inside::classes, {0, 1, 2, 3}}).two_sided());
  CHECK_FALSE(make_intensity_model(four_classes(), {Inside::classes, {}}).two_sided());
  CHECK_FALSE(IntensityModel().two_sided());
  CHECK(make_intensity_model(four_classes(), {Inside::classes, {0, 1, 2, 3}}).levels(0.0).empty());
}

TEST_CASE("classes that do not exist are refused", "[levelset][contract]") {
  CHECK_THROWS_WITH(make_intensity_model(four_classes(), {Inside::classes, {4}}),
                    Contains("class inside is 4; expected a number from 0"));
  CHECK_THROWS_WITH(make_intensity_model(four_classes(), {Inside::classes, {1, 1}}),
                    Contains("class inside is 1; expected each class to be named once"));
  CHECK_THROWS_WITH(make_intensity_model(GaussianMixture{}), Contains("mixture is empty"));
}
}  // namespace
