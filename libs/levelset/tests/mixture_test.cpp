#include "shape3d/levelset/mixture.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::levelset;
using Catch::Contains;

GaussianMixture mixture(std::initializer_list<std::array<double, 3>> classes) {
  GaussianMixture m;
  const auto n = static_cast<Eigen::Index>(classes.size());
  m.weights.resize(n);
  m.means.resize(n);
  m.variances.resize(n);
  Eigen::Index k = 0;
  for (const auto& [weight, mean, deviation] : classes) {
    m.weights[k] = weight;
    m.means[k] = mean;
    m.variances[k++] = deviation * deviation;
  }
  return m;
}

/// The histogram that a mixture has without any sampling error, unit bins.
Histogram expected_histogram(const GaussianMixture& m, double lower, double upper, double total) {
  Histogram h;
  h.lower = lower - 0.5;
  h.minimum = lower;
  h.maximum = upper;
  h.counts.resize(static_cast<Eigen::Index>(upper - lower) + 1);
  for (Eigen::Index b = 0; b < h.counts.size(); ++b)
    h.counts[b] = std::floor(total * m.density(lower + static_cast<double>(b)) + 0.5);
  return h;
}

const GaussianMixture kLungLike = mixture({{0.45, -800, 40}, {0.15, -300, 90}, {0.40, 20, 60}});
const Histogram kLungHistogram = expected_histogram(kLungLike, -1024, 400, 7e6);

void check_close(const GaussianMixture& found, const GaussianMixture& truth, double weight,
                 double mean, double deviation) {
  REQUIRE(found.size() == truth.size());
  for (int k = 0; k < truth.size(); ++k) {
    INFO("class " << k);
    CHECK(std::abs(found.weights[k] - truth.weights[k]) < weight);
    CHECK(std::abs(found.means[k] - truth.means[k]) < mean);
    CHECK(std::abs(std::sqrt(found.variances[k]) - std::sqrt(truth.variances[k])) < deviation);
  }
}

TEST_CASE("EM increases the likelihood at every step", "[levelset][em]") {
  const int classes = GENERATE(1, 2, 3, 5, 8);
  MixtureOptions options;
  options.method = MixtureMethod::em;
  options.classes = classes;
  options.tolerance = 0.0;
  options.iterations = 150;
  const MixtureFit fit = fit_mixture(kLungHistogram, options);
  INFO(classes << " classes");
  REQUIRE(fit.log_likelihoods.size() == static_cast<std::size_t>(fit.iterations));
  // Rounding of a sum of 1425 terms of total magnitude |L|: 1425 · 2⁻⁵³ · |L|.
  const double rounding = 1425 * 0x1p-53 * std::abs(fit.log_likelihood);
  for (std::size_t n = 1; n < fit.log_likelihoods.size(); ++n)
    CHECK(fit.log_likelihoods[n] >= fit.log_likelihoods[n - 1] - rounding);
}

TEST_CASE("EM recovers a known mixture", "[levelset][em]") {
  MixtureOptions options;
  options.method = MixtureMethod::em;
  options.tolerance = 1e-12;
  options.iterations = 3000;
  const MixtureFit fit = fit_mixture(kLungHistogram, options);
  CHECK(fit.stop == MixtureStop::converged);
  check_close(fit.mixture, kLungLike, 1e-3, 1.0, 1.0);
  CHECK(fit.misfit < 1e-4);
}

TEST_CASE("one class is the mean and the variance", "[levelset][em]") {
  Histogram h;
  h.lower = -0.5;
  h.counts.resize(4);
  h.counts << 1, 0, 2, 1;
  h.maximum = 3;
  MixtureOptions options;
  options.method = MixtureMethod::em;
  options.classes = 1;
  const MixtureFit fit = fit_mixture(h, options);
  CHECK(fit.mixture.weights[0] == Approx(1.0));
  CHECK(fit.mixture.means[0] == Approx(1.75));
  CHECK(fit.mixture.variances[0] == Approx((1.75 * 1.75 + 2 * 0.0625 + 1.25 * 1.25) / 4));
  // ln L of a Gaussian at its maximum: −N/2 (ln 2πσ² + 1).
  const double expected =
      -2.0 * (std::log(2 * 3.14159265358979323846 * fit.mixture.variances[0]) + 1.0);
  CHECK(fit.log_likelihood == Approx(expected));
  CHECK(fit.bic == Approx(2.0 * std::log(4.0) - 2.0 * expected));
}

TEST_CASE("stochastic EM recovers a known mixture, and seeds agree", "[levelset][sem]") {
  MixtureOptions options;
  options.chain = 400;
  GaussianMixture first;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    options.seed = seed;
    const MixtureFit fit = fit_mixture(kLungHistogram, options);
    INFO("seed " << seed << ", run " << fit.run << ", misfit " << fit.misfit);
    CHECK(fit.stop == MixtureStop::chain_complete);
    CHECK(fit.run_misfits.size() == 5);
    check_close(fit.mixture, kLungLike, 0.01, 6.0, 4.0);
    if (first.size() == 0) first = fit.mixture;
    check_close(fit.mixture, first, 0.01, 6.0, 4.0);
  }
  options.seed = 1;
  const GaussianMixture again = fit_mixture(kLungHistogram, options).mixture;
  CHECK((again.means == first.means).all());
  CHECK((again.variances == first.variances).all());
}

TEST_CASE("stochastic EM keeps the run of least misfit", "[levelset][sem]") {
  MixtureOptions options;
  options.chain = 4;
  options.runs = 12;
  const MixtureFit fit = fit_mixture(kLungHistogram, options);
  REQUIRE(fit.run_misfits.size() == 12);
  for (const double m : fit.run_misfits) CHECK(fit.misfit <= m);
  CHECK(fit.misfit == fit.run_misfits[static_cast<std::size_t>(fit.run)]);
}

TEST_CASE("BIC finds the number of classes", "[levelset][em]") {
  const GaussianMixture two = mixture({{0.5, -800, 40}, {0.5, 0, 60}});
  MixtureOptions options;
  options.method = MixtureMethod::em;
  options.classes = 0;
  options.iterations = 2000;
  options.tolerance = 1e-12;
  CHECK(fit_mixture(expected_histogram(two, -1024, 400, 20000), options).mixture.size() == 2);
  const MixtureFit three = fit_mixture(expected_histogram(kLungLike, -1024, 400, 20000), options);
  CHECK(three.mixture.size() == 3);
  REQUIRE(three.bic_by_classes.size() == 5);
  CHECK(three.bic == Approx(three.bic_by_classes[2]).epsilon(1e-9));
}

TEST_CASE("classes are sorted by mean whatever the seed", "[levelset][sem]") {
  MixtureOptions options;
  options.classes = 6;
  options.runs = 1;
  options.chain = 6;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    options.seed = seed;
    const Eigen::ArrayXd means = fit_mixture(kLungHistogram, options).mixture.means;
    for (Eigen::Index k = 1; k < means.size(); ++k) CHECK(means[k - 1] <= means[k]);
  }
}

TEST_CASE("no variance falls under the floor", "[levelset][em]") {
  // A spike of one bin, 6 % of the samples, far from the rest.
  Histogram h = kLungHistogram;
  h.counts[0] = 0.06 * h.total();
  MixtureOptions options;
  options.classes = 4;
  options.min_deviation = 0.004;
  options.method = GENERATE(MixtureMethod::em, MixtureMethod::stochastic_em);
  const MixtureFit fit = fit_mixture(h, options);
  const double floor = 0.004 * (h.maximum - h.minimum);
  CHECK(fit.mixture.variances.minCoeff() >= floor * floor * (1.0 - 1e-12));
  CHECK(std::isfinite(fit.log_likelihood));
}

TEST_CASE("misfit is zero for the mixture itself and the weighted square else", "[levelset][em]") {
  CHECK(misfit(kLungHistogram, kLungLike) < 1e-5);
  // H and P of two bins of width 1: ∑ (P − H)²/H, with P from the closed form.
  Histogram h;
  h.lower = -0.5;
  h.maximum = 1;
  h.counts.resize(2);
  h.counts << 3, 1;
  const GaussianMixture p = mixture({{1.0, 0.0, 1.0}});
  const double p0 = 0.3989422804014327, p1 = 0.24197072451914337;
  const double expected = (p0 - 0.75) * (p0 - 0.75) / 0.75 + (p1 - 0.25) * (p1 - 0.25) / 0.25;
  CHECK(misfit(h, p) == Approx(expected));
  CHECK(p.density(1.0) == Approx(p1));
}

TEST_CASE("fewer occupied bins than classes is an outcome, not an error", "[levelset][contract]") {
  Histogram h;
  h.counts = Eigen::ArrayXd::Zero(5);
  h.counts[1] = 10;
  h.counts[4] = 5;
  h.maximum = 4;
  const MixtureFit fit = fit_mixture(h, {});
  CHECK(fit.stop == MixtureStop::too_few_bins);
  CHECK(fit.mixture.size() == 0);
  CHECK(to_string(fit.stop) == "too_few_bins");
  CHECK(to_string(MixtureStop::converged) == "converged");
  CHECK(to_string(MixtureStop::iteration_limit) == "iteration_limit");
  CHECK(to_string(MixtureStop::chain_complete) == "chain_complete");
  CHECK(to_string(MixtureStop::given) == "given");
}

TEST_CASE("options of a mixture out of range are refused", "[levelset][contract]") {
  const auto refused = [](void (*change)(MixtureOptions&), const char* message) {
    MixtureOptions options;
    change(options);
    CHECK_THROWS_AS(fit_mixture(kLungHistogram, options), std::invalid_argument);
    CHECK_THROWS_WITH(fit_mixture(kLungHistogram, options), Contains(message));
  };
  refused([](MixtureOptions& o) { o.classes = 9; }, "classes is 9; expected 1 to 8");
  refused([](MixtureOptions& o) { o.max_classes = 0; }, "max_classes is 0");
  refused([](MixtureOptions& o) { o.iterations = 0; }, "iterations is 0; expected at least 1");
  refused([](MixtureOptions& o) { o.tolerance = -1; }, "tolerance is -1");
  refused([](MixtureOptions& o) { o.chain = 1; }, "chain is 1; expected at least 2");
  refused([](MixtureOptions& o) { o.runs = 0; }, "runs is 0");
  refused([](MixtureOptions& o) { o.min_deviation = 1; }, "min_deviation is 1");
}
}  // namespace
