#include "shape3d/levelset/calibration.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/levelset/gradient.hpp"

namespace {
using namespace shape3d::levelset;
using Catch::Contains;

/// Classes at 0 and 1000 of equal deviation: Λ is linear and its level 0 lies at 500.
IntensityModel model(double deviation = 60, Inside inside = Inside::bright) {
  GaussianMixture m;
  m.weights = Eigen::ArrayXd::Constant(2, 0.5);
  m.means.resize(2);
  m.means << 0, 1000;
  m.variances = Eigen::ArrayXd::Constant(2, deviation * deviation);
  return make_intensity_model(m, {inside, {}});
}

double lambda_of_level(const IntensityModel& m, double level) { return m.log_odds(level); }

template <class Function>
std::vector<float> sample(const Grid& grid, const Function& f) {
  std::vector<float> samples(static_cast<std::size_t>(grid.size()));
  for (std::int64_t k = 0; k < grid.dims[2]; ++k)
    for (std::int64_t j = 0; j < grid.dims[1]; ++j)
      for (std::int64_t i = 0; i < grid.dims[0]; ++i)
        samples[static_cast<std::size_t>(grid.index(i, j, k))] = static_cast<float>(
            f(static_cast<double>(i) * grid.spacing[0], static_cast<double>(j) * grid.spacing[1],
              static_cast<double>(k) * grid.spacing[2]));
  return samples;
}

/// Smooth edge at x = 0: erf of width s.
double edge(double x, double s) { return 500.0 * (1.0 + std::erf(x / (s * std::sqrt(2.0)))); }

TEST_CASE("Y of a linear profile is the bell of the distance to the crossing",
          "[levelset][analytic]") {
  // I = 100·x mm: the level L is crossed at x = L/100 exactly, between samples.
  const Grid grid{{24, 5, 4}, {0.7, 1.0, 2.0}};
  const auto samples = sample(grid, [](double x, double, double) { return 100.0 * x; });
  const IntensityModel m = model(400);
  const double level = GENERATE(400.0, 777.0, 1000.0 - 1e-3);
  const double width = 1.3;
  const ImageView view = make_view(samples.data(), grid.dims, grid.spacing);
  const Field d = boundary_distance(view, m, lambda_of_level(m, level), 3.1 * width);
  const Field y = boundary_detector(view, m, lambda_of_level(m, level), width);
  for (std::int64_t i = 0; i < 24; ++i) {
    const double exact = level / 100.0 - 0.7 * static_cast<double>(i);  // bright side is negative
    INFO("x = " << 0.7 * static_cast<double>(i) << ", crossing at " << level / 100.0);
    CHECK(d[grid.index(i, 2, 2)] ==
          Approx(std::max(-3.1 * width, std::min(3.1 * width, exact))).margin(2e-3));
    const double bell =
        std::abs(exact) < 3.1 * width ? std::exp(-exact * exact / (width * width)) : 0;
    CHECK(y[grid.index(i, 2, 2)] == Approx(bell).margin(3e-3));
  }
}

TEST_CASE("the distance to an oblique plane is that of a plane", "[levelset][analytic]") {
  // For a linear image the crossings on the lattice edges lie on the plane; one-sided first-order
  // schemes are exact for planes, too.
  const Grid grid{{40, 40, 40}, {1.0, 1.0, 1.0}};
  const Eigen::Vector3d normal = Eigen::Vector3d(2, 3, 1).normalized();
  const auto samples = sample(grid, [&](double x, double y, double z) {
    return 500 + 40.0 * normal.dot(Eigen::Vector3d(x - 20, y - 20, z - 20));
  });
  const IntensityModel m = model(400);
  const Field d = boundary_distance(make_view(samples.data(), grid.dims), m, 0.0, 3.0);
  double worst = 0.0;
  for (std::int64_t k = 8; k < 32; ++k)
    for (std::int64_t j = 8; j < 32; ++j)
      for (std::int64_t i = 8; i < 32; ++i) {
        const double exact = -normal.dot(Eigen::Vector3d(
            static_cast<double>(i - 20), static_cast<double>(j - 20), static_cast<double>(k - 20)));
        if (std::abs(exact) > 2.5) continue;
        worst = std::max(worst, std::abs(d[grid.index(i, j, k)] - exact));
      }
  CHECK(worst < 0.02);
}

TEST_CASE("a wall of two samples does not count as all boundary", "[levelset][analytic]") {
  // Samples 0 0 1000 1000 0 0: crossings half-way, so d = ½ inside the wall and Y = exp(−¼/ℓ²),
  // not 1.
  const Grid grid{{12, 6, 6}, {1, 1, 1}};
  const auto samples =
      sample(grid, [](double x, double, double) { return x > 4.5 && x < 6.5 ? 1000.0 : 0.0; });
  const Field y = boundary_detector(make_view(samples.data(), grid.dims), model(), 0.0, 1.0);
  for (const std::int64_t i : {4, 5, 6, 7})
    CHECK(y[grid.index(i, 3, 3)] == Approx(std::exp(-0.25)).margin(1e-3));
  CHECK(y[grid.index(3, 3, 3)] == Approx(std::exp(-2.25)).margin(1e-3));
}

TEST_CASE("S of a smooth edge is greatest where the gradient is", "[levelset][analytic]") {
  // |∇(G_σ ∗ I)| is a Gaussian about x₀ and Y one about the level's place c: their cosine is
  // exp(−(c − x₀)²/…), greatest at c = x₀, the half level, for w as for the product.
  const double x0 = 12.3;
  const Grid grid{{26, 10, 8}, {1, 1, 1}};
  const auto samples = sample(grid, [&](double x, double, double) { return edge(x - x0, 1.5); });
  const ImageView view = make_view(samples.data(), grid.dims);
  const Field g = gradient_magnitude(view);
  CalibrationOptions options;
  options.overlap = GENERATE(Overlap::cosine, Overlap::product);
  // The model's own level is off by 200: unequal weights alone move it by σ²/1000 · ln(…); here the
  // variances do. The gradient knows nothing of it.
  GaussianMixture wrong;
  wrong.weights = Eigen::ArrayXd::Constant(2, 0.5);
  wrong.means.resize(2);
  wrong.means << 0, 1000;
  wrong.variances.resize(2);
  wrong.variances << 60 * 60, 150 * 150;
  const IntensityModel m = make_intensity_model(wrong);
  CHECK(std::abs(m.levels(0.0).front() - 500) > 150);
  const Calibration c = calibrate(view, g, m, 1.0, options);
  REQUIRE(c.levels.size() == 1);
  INFO("level " << c.levels[0] << " of λ = " << c.lambda);
  CHECK(c.levels[0] == Approx(500).margin(25));
  CHECK(c.w == offset_of_log_odds(c.lambda));
  CHECK(c.w != 0.0);
}

TEST_CASE("S is the closed form of two bells", "[levelset][analytic]") {
  // In 1D: a = exp(−(x−c)²/ℓ²), b = exp(−(x−x₀)²/2v), v = s² + σ²: ∫ab/√(∫a²∫b²) with Gaussians of
  // variance p = ℓ²/2 and v is √(2√(pv)/(p+v)) · exp(−(c−x₀)²/2(p+v)).
  const double s = 2.0, sigma = 1.0, x0 = 20.0;
  const Grid grid{{41, 8, 8}, {1, 1, 1}};
  const auto samples = sample(grid, [&](double x, double, double) { return edge(x - x0, s); });
  const ImageView view = make_view(samples.data(), grid.dims);
  const Field g = gradient_magnitude(view, sigma);
  const double width = 2.5, p = width * width / 2, v = s * s + sigma * sigma;
  CalibrationOptions options;
  options.boundary_width = width;
  options.coarse_samples = 9;
  const IntensityModel m = model(200);
  const Calibration c = calibrate(view, g, m, 1.0, options);
  REQUIRE(c.curve.size() >= 9);
  int compared = 0;
  for (const OverlapSample& sample_of_s : c.curve) {
    // Place of the level: the inverse of the edge, by bisection.
    double low = -8, high = 8;
    for (int n = 0; n < 60; ++n) {
      const double middle = 0.5 * (low + high);
      (edge(middle, s) < sample_of_s.level ? low : high) = middle;
    }
    if (std::abs(low) > 3) continue;
    const double exact =
        std::sqrt(2 * std::sqrt(p * v) / (p + v)) * std::exp(-low * low / (2 * (p + v)));
    INFO("level " << sample_of_s.level << " at " << low);
    CHECK(sample_of_s.overlap == Approx(exact).margin(0.02));
    ++compared;
  }
  CHECK(compared >= 5);
}

TEST_CASE("the scope limits the search", "[levelset]") {
  const Grid grid{{26, 6, 6}, {1, 1, 1}};
  const auto samples = sample(grid, [&](double x, double, double) { return edge(x - 13, 1.5); });
  const ImageView view = make_view(samples.data(), grid.dims);
  const Field g = gradient_magnitude(view);
  const IntensityModel m = model();
  CalibrationOptions options;
  options.scope_constant = 10;
  const Calibration c = calibrate(view, g, m, 0.01, options);
  CHECK(c.scope == Approx(0.1));
  for (const OverlapSample& s : c.curve) {
    CHECK(std::abs(s.lambda) <= 0.1 * m.max_log_odds() * (1 + 1e-6));
    CHECK(s.w == offset_of_log_odds(s.lambda));
    CHECK(std::abs(s.w) <= c.scope_w);
  }
  for (std::size_t n = 1; n < c.curve.size(); ++n)
    CHECK(c.curve[n - 1].lambda <= c.curve[n].lambda);
}

TEST_CASE("dark objects mirror bright ones", "[levelset]") {
  const Grid grid{{26, 6, 6}, {1, 1, 1}};
  const auto samples = sample(grid, [&](double x, double, double) { return edge(x - 12.7, 1.5); });
  const ImageView view = make_view(samples.data(), grid.dims);
  const Field g = gradient_magnitude(view);
  const Calibration bright = calibrate(view, g, model(), 1.0);
  const Calibration dark = calibrate(view, g, model(60, Inside::dark), 1.0);
  REQUIRE(bright.levels.size() == 1);
  REQUIRE(dark.levels.size() == 1);
  CHECK(dark.levels[0] == Approx(bright.levels[0]).margin(5));
  CHECK(dark.lambda == Approx(-bright.lambda).margin(3));
  const Field b = boundary_distance(view, model(), 0.0, 3.0);
  const Field d = boundary_distance(view, model(60, Inside::dark), 0.0, 3.0);
  CHECK((b + d).abs().maxCoeff() < 1e-4);
}

TEST_CASE("a class in the middle is calibrated at both of its levels", "[levelset]") {
  GaussianMixture mixture;
  mixture.weights = Eigen::ArrayXd::Constant(3, 1.0 / 3.0);
  mixture.means.resize(3);
  mixture.means << 0, 500, 1000;
  mixture.variances = Eigen::ArrayXd::Constant(3, 50 * 50);
  const IntensityModel m = make_intensity_model(mixture, {Inside::classes, {1}});
  const Grid grid{{60, 6, 6}, {1, 1, 1}};
  const auto samples = sample(
      grid, [](double x, double, double) { return 0.5 * edge(x - 20, 2) + 0.5 * edge(x - 40, 2); });
  const ImageView view = make_view(samples.data(), grid.dims);
  const Calibration c = calibrate(view, gradient_magnitude(view), m, 1.0);
  REQUIRE(c.levels.size() == 2);
  CHECK(c.levels[0] == Approx(250).margin(60));
  CHECK(c.levels[1] == Approx(750).margin(60));
  const Field d = boundary_distance(view, m, 0.0, 3.0);
  CHECK(d[grid.index(30, 3, 3)] == -3.0F);
  CHECK(d[grid.index(5, 3, 3)] == 3.0F);
  CHECK(d[grid.index(55, 3, 3)] == 3.0F);
}

TEST_CASE("a model of one side is not calibrated, and a caller can cancel", "[levelset]") {
  const Grid grid{{26, 6, 6}, {1, 1, 1}};
  const auto samples = sample(grid, [&](double x, double, double) { return edge(x - 13, 1.5); });
  const ImageView view = make_view(samples.data(), grid.dims);
  const Field g = gradient_magnitude(view);
  const Calibration none = calibrate(view, g, IntensityModel(model().mixture(), {true, true}), 1.0);
  CHECK(none.w == 0.0);
  CHECK(none.curve.empty());
  CalibrationOptions options;
  int calls = 0;
  options.progress = [&](const Progress& p) {
    CHECK(p.stage == "calibration");
    CHECK(p.share > 0.0);
    return ++calls < 3;
  };
  CHECK(calibrate(view, g, model(), 1.0, options).cancelled);
  CHECK(calls == 3);
}

TEST_CASE("S over evenly spread bars is S over all samples, to a hundredth", "[levelset]") {
  // 128 × 256 × 96 samples: tubes along x and balls in noise; a quarter of the bars is summed.
  std::mt19937 random(11);
  const Grid grid{{128, 256, 96}, {0.7, 0.7, 1.2}};
  const auto samples = sample(grid, [&](double x, double y, double z) {
    const double tube = 6 - std::hypot(std::remainder(y, 30), std::remainder(z, 30));
    const double ball = 9 - std::hypot(std::remainder(x, 45), std::remainder(y - 15, 30),
                                       std::remainder(z - 15, 30));
    return edge(std::max(tube, ball), 1.0) + static_cast<double>(random() % 100);
  });
  const ImageView view = make_view(samples.data(), grid.dims, grid.spacing);
  const Field g = gradient_magnitude(view);
  CalibrationOptions options;
  options.refinements = 1;
  options.max_samples = 0;
  const Calibration all = calibrate(view, g, model(), 1.0, options);
  options.max_samples = grid.size() / 4;
  const Calibration part = calibrate(view, g, model(), 1.0, options);
  // The first seven offsets are the same; those after them go to the same best one.
  REQUIRE(part.curve.size() == all.curve.size());
  bool differs = false;
  for (std::size_t n = 0; n < all.curve.size(); ++n) {
    CHECK(part.curve[n].overlap == Approx(all.curve[n].overlap).margin(0.01));
    differs = differs || part.curve[n].overlap != all.curve[n].overlap;
  }
  CHECK(differs);  // it is a part that was summed
  REQUIRE(part.levels.size() == 1);
  CHECK(part.levels[0] == Approx(all.levels[0]).margin(10));  // of classes 1000 apart
}

TEST_CASE("threads do not change the calibration", "[levelset]") {
  std::mt19937 random(3);
  const Grid grid{{50, 40, 30}, {0.7, 0.7, 1.2}};
  const auto samples = sample(grid, [&](double x, double y, double z) {
    return edge(8 - std::hypot(x - 17, y - 14, z - 18), 1.0) + static_cast<double>(random() % 100);
  });
  const ImageView view = make_view(samples.data(), grid.dims, grid.spacing);
  const Field g = gradient_magnitude(view);
  CalibrationOptions options;
  options.threads = 1;
  const Calibration one = calibrate(view, g, model(), 1.0, options);
  options.threads = 4;
  const Calibration four = calibrate(view, g, model(), 1.0, options);
  CHECK(one.lambda == four.lambda);
  REQUIRE(one.curve.size() == four.curve.size());
  for (std::size_t n = 0; n < one.curve.size(); ++n)
    CHECK(one.curve[n].overlap == four.curve[n].overlap);
}

TEST_CASE("settings of a calibration out of range are refused", "[levelset][contract]") {
  std::vector<float> samples(27, 1.0F);
  const ImageView view = make_view(samples.data(), {3, 3, 3});
  const Field g = Field::Zero(27);
  const auto refused = [&](void (*change)(CalibrationOptions&), const char* message) {
    CalibrationOptions options;
    change(options);
    CHECK_THROWS_WITH(calibrate(view, g, model(), 1.0, options), Contains(message));
  };
  refused([](CalibrationOptions& o) { o.scope_constant = 0; }, "scope_constant is 0");
  refused([](CalibrationOptions& o) { o.max_scope = 1.5; }, "max_scope is 1.5");
  refused([](CalibrationOptions& o) { o.coarse_samples = 4; },
          "coarse_samples is 4; expected an odd");
  refused([](CalibrationOptions& o) { o.refinements = -1; }, "refinements is -1");
  refused([](CalibrationOptions& o) { o.max_samples = -1; }, "max_samples is -1");
  refused([](CalibrationOptions& o) { o.boundary_width = -1; }, "boundary_width is -1");
  refused([](CalibrationOptions& o) { o.threads = -1; }, "threads is -1");
  CHECK_THROWS_WITH(calibrate(view, Field::Zero(26), model(), 1.0),
                    Contains("gradient: size is 26; expected 27"));
  CHECK_THROWS_WITH(calibrate(view, g, model(), -1.0), Contains("misfit is -1"));
  CHECK_THROWS_WITH(boundary_distance(view, model(), 0.0, 0.0), Contains("limit is 0"));
  CHECK_THROWS_WITH(boundary_detector(view, model(), 0.0, -2.0), Contains("boundary_width is -2"));
  samples[5] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(calibrate(view, g, model(), 1.0), Contains("sample (2, 1, 0) is NaN"));
}
}  // namespace
