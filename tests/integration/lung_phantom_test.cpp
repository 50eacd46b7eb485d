// The phantom is as hard as it is meant to be, and its truth is the truth.
#include "support/lung_phantom.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "common/segmentation_measures.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::test;
using Catch::Matchers::Contains;

// Measures of thresholding at the half level; distances in samples.
apps::SegmentationMeasures threshold(const LungPhantom& phantom) {
  std::vector<std::uint8_t> mask(phantom.samples.size());
  for (std::size_t n = 0; n < mask.size(); ++n)
    mask[n] = phantom.samples[n] >= LungPhantom::kHalfLevel ? 1 : 0;
  const std::vector<std::uint8_t> truth = phantom.tissue();
  return apps::compare_masks({mask.data(), phantom.dims}, {truth.data(), phantom.dims});
}

LungPhantom phantom_of(PhantomNoise noise, double hu, std::uint64_t seed = 1) {
  LungPhantomOptions options;
  options.noise = noise;
  options.noise_hu = hu;
  options.seed = seed;
  return make_lung_phantom(options);
}

LungPhantomOptions small_options() {
  LungPhantomOptions options;
  options.dims = {96, 112, 40};
  return options;
}

TEST_CASE("thresholding finds the phantom as hard as it is meant to be", "[phantom]") {
  for (const std::uint64_t seed : {1, 2}) {
    const apps::SegmentationMeasures easy = threshold(phantom_of(PhantomNoise::gaussian, 25, seed));
    INFO("seed " << seed);
    CHECK(easy.dice == Approx(0.980).margin(0.005));
    CHECK(*easy.hausdorff95 == Approx(3.2).margin(0.5));
    CHECK(*threshold(phantom_of(PhantomNoise::gaussian, 150, seed)).hausdorff95 >= 10.0);
  }
}

TEST_CASE("the noise has the deviation and the shape of its kind", "[phantom]") {
  for (const PhantomNoise kind :
       {PhantomNoise::gaussian, PhantomNoise::poisson, PhantomNoise::rayleigh}) {
    LungPhantomOptions options = small_options();
    options.noise_hu = 0;
    const LungPhantom clean = make_lung_phantom(options);
    options.noise = kind;
    options.noise_hu = 60;
    const LungPhantom noisy = make_lung_phantom(options);
    // Moments of the noise over the clear lung and the clear tissue.
    for (const double level : {LungPhantom::kAir, LungPhantom::kTissue}) {
      double n = 0, sum = 0, squares = 0, cubes = 0;
      for (std::size_t i = 0; i < clean.samples.size(); ++i) {
        if (clean.samples[i] != level) continue;
        const double e = noisy.samples[i] - level;
        n += 1;
        sum += e;
        squares += e * e;
        cubes += e * e * e;
      }
      REQUIRE(n > 1e4);
      const double variance = squares / n, skewness = cubes / n / std::pow(variance, 1.5);
      // Of n values: the mean within 5 deviations, the deviation within 5/√(2n).
      double expected = 60, skew = 0;
      if (kind == PhantomNoise::poisson) {
        const double gain = 3600.0 / 624, mean = (level + 1024) / gain;
        expected = gain * std::sqrt(mean);
        skew = 1 / std::sqrt(mean);
      }
      if (kind == PhantomNoise::rayleigh)
        skew = 2 * std::sqrt(kPi) * (kPi - 3) / std::pow(4 - kPi, 1.5);
      INFO(to_string(kind) << " at " << level);
      CHECK(sum / n == Approx(0).margin(5 * expected / std::sqrt(n)));
      CHECK(std::sqrt(variance) == Approx(expected).epsilon(5 / std::sqrt(2 * n) + 0.002));
      CHECK(skewness == Approx(skew).margin(5 * std::sqrt(6 / n) + 0.02));
    }
  }
}

TEST_CASE("without noise the half level parts what is thick, and nodules are where they are said",
          "[phantom]") {
  LungPhantomOptions options = small_options();
  options.noise_hu = 0;
  const LungPhantom phantom = make_lung_phantom(options);
  REQUIRE(phantom.nodules.size() == 4);
  for (const PhantomNodule& nodule : phantom.nodules) {
    INFO(to_string(nodule.kind));
    const std::vector<std::uint8_t> mask = phantom.nodule(nodule);
    const apps::MaskSize size = apps::measure_mask({mask.data(), phantom.dims, phantom.spacing});
    // In samples, for a ball in samples is an ellipsoid where spacings differ.
    const double r = nodule.radius / phantom.spacing.x();
    const double ball = 4 * kPi / 3 * r * r * r;
    if (nodule.kind == NoduleKind::at_pleura) {
      // Half a radius from the wall, which is flat to first order: a cap of height 3r/2 stays.
      const double cap = kPi * std::pow(1.5 * r, 2) * (3 * r - 1.5 * r) / 3;
      CHECK(static_cast<double>(size.samples) == Approx(cap).epsilon(0.15));
    } else {
      CHECK(static_cast<double>(size.samples) == Approx(ball).epsilon(0.06));
    }
    const auto index = [&](const Eigen::Vector3d& p) {
      return static_cast<std::size_t>(
          std::lround(p.x()) +
          phantom.dims[0] * (std::lround(p.y()) + phantom.dims[1] * std::lround(p.z())));
    };
    CHECK(mask[index(nodule.centre)] == 1);
    const bool glass = nodule.kind == NoduleKind::ground_glass;
    CHECK(phantom.samples[index(nodule.centre)] ==
          Approx(glass ? LungPhantom::kGroundGlass : LungPhantom::kTissue).margin(40));
    CHECK(phantom.tissue()[index(nodule.centre)] == (glass ? 0 : 1));
  }
}

TEST_CASE("a seed gives the same phantom, another one another", "[phantom]") {
  LungPhantomOptions options = small_options();
  const LungPhantom one = make_lung_phantom(options), same = make_lung_phantom(options);
  CHECK(one.samples == same.samples);
  CHECK(one.labels == same.labels);
  options.seed = 2;
  CHECK(make_lung_phantom(options).labels != one.labels);
}

TEST_CASE("a phantom that cannot be made is refused", "[phantom]") {
  LungPhantomOptions options;
  options.dims = {23, 64, 64};
  CHECK_THROWS_WITH(make_lung_phantom(options), "dims has 23; expected 24 or more");
  options = {};
  options.noise_hu = -1;
  CHECK_THROWS_WITH(make_lung_phantom(options), Contains("noise_hu is -1"));
}

}  // namespace
