#include "shape3d/levelset/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::levelset;
using Catch::Contains;

template <class T>
std::vector<T> random_samples(std::size_t count, int lower, int upper) {
  std::mt19937 random(7);
  std::vector<T> samples(count);
  for (T& sample : samples)
    sample = static_cast<T>(lower +
                            static_cast<int>(random() % static_cast<unsigned>(upper - lower + 1)));
  return samples;
}

TEMPLATE_TEST_CASE("bins of integers count each value", "[levelset]", std::int8_t, std::uint8_t,
                   std::int16_t, std::uint16_t, std::int32_t) {
  const int lower = std::is_signed_v<TestType> ? -90 : 10;
  const auto samples = random_samples<TestType>(20 * 30 * 7, lower, lower + 100);
  const Histogram h = histogram(make_view(samples.data(), {20, 30, 7}));
  REQUIRE(h.bins() == 101);
  CHECK(h.bin_width == 1.0);
  CHECK(h.minimum == lower);
  CHECK(h.maximum == lower + 100);
  CHECK(h.total() == 20 * 30 * 7);
  for (int b = 0; b < h.bins(); ++b) {
    CHECK(h.center(b) == lower + b);
    const auto exact = std::count(samples.begin(), samples.end(), static_cast<TestType>(lower + b));
    CHECK(h.counts[b] == static_cast<double>(exact));
  }
}

TEMPLATE_TEST_CASE("bins of reals count each interval", "[levelset]", float, double) {
  std::mt19937 random(3);
  std::vector<TestType> samples(5000);
  for (TestType& s : samples) s = static_cast<TestType>(random()) / static_cast<TestType>(1e9);
  HistogramOptions options;
  options.max_bins = 64;
  const Histogram h = histogram(make_view(samples.data(), {10, 50, 10}), options);
  REQUIRE(h.bins() == 64);
  CHECK(h.total() == 5000);
  CHECK(h.bin_width == Approx((h.maximum - h.minimum) / 64));
  for (int b = 0; b < 63; ++b) {
    const double lower = h.lower + b * h.bin_width, upper = lower + h.bin_width;
    const auto count = std::count_if(samples.begin(), samples.end(), [&](TestType s) {
      return static_cast<double>(s) >= lower && static_cast<double>(s) < upper;
    });
    CHECK(std::abs(h.counts[b] - static_cast<double>(count)) <=
          1);  // a sample on an edge may round
  }
  CHECK((h.density() * h.bin_width).sum() == Approx(1.0));
}

TEST_CASE("wide ranges of integers share bins of whole numbers", "[levelset]") {
  const auto samples = random_samples<std::int32_t>(4000, -50000, 50000);
  HistogramOptions options;
  options.max_bins = 1000;
  const Histogram h = histogram(make_view(samples.data(), {40, 10, 10}), options);
  CHECK(h.bins() <= 1000);
  CHECK(h.bin_width == std::floor(h.bin_width));
  CHECK(h.total() == 4000);
  CHECK(h.occupied() <= h.bins());
}

TEST_CASE("strides and threads change nothing", "[levelset]") {
  const auto samples = random_samples<std::int16_t>(24 * 20 * 16, -1000, 1000);
  ImageView view = make_view(samples.data(), {24, 20, 16});
  HistogramOptions options;
  options.threads = 1;
  const Histogram whole = histogram(view, options);
  options.threads = 4;
  CHECK((histogram(view, options).counts == whole.counts).all());
  ImageView turned = view;  // x and z exchanged: the same samples
  turned.dims = {16, 20, 24};
  turned.strides = {24 * 20, 24, 1};
  CHECK((histogram(turned, options).counts == whole.counts).all());
}

TEST_CASE("padding is left out, given or found", "[levelset]") {
  auto samples = random_samples<std::int16_t>(10000, -900, 100);
  for (std::size_t i = 0; i < 600; ++i) samples[i] = -1024;  // 6 %
  const ImageView view = make_view(samples.data(), {100, 10, 10});
  const Histogram found = histogram(view);
  REQUIRE(found.padding.has_value());
  CHECK(*found.padding == -1024.0);
  CHECK(found.padding_samples == 600);
  CHECK(found.minimum == -900.0);
  CHECK(found.total() == 9400);

  HistogramOptions options;
  options.detect_padding = false;
  CHECK(histogram(view, options).total() == 10000);
  options.padding = 5.0;
  const Histogram given = histogram(view, options);
  CHECK(given.padding_samples == std::count(samples.begin(), samples.end(), std::int16_t{5}));
  CHECK(given.total() + static_cast<double>(given.padding_samples) == 10000);

  const std::vector<float> reals(samples.begin(), samples.end());
  const Histogram of_reals = histogram(make_view(reals.data(), {100, 10, 10}));
  CHECK(of_reals.padding_samples == 600);
}

TEST_CASE("a background is not taken for padding", "[levelset]") {
  std::vector<std::uint8_t> samples(1000, 10);
  for (std::size_t i = 0; i < 400; ++i) samples[i] = 200;
  const Histogram h = histogram(make_view(samples.data(), {10, 10, 10}));
  CHECK_FALSE(h.padding.has_value());
  CHECK(h.total() == 1000);
}

TEST_CASE("a constant image has one bin, and padding alone has none", "[levelset]") {
  const std::vector<std::int16_t> samples(64, 12);
  const ImageView view = make_view(samples.data(), {4, 4, 4});
  const Histogram constant = histogram(view);
  CHECK(constant.bins() == 1);
  CHECK(constant.counts[0] == 64);
  CHECK(constant.minimum == constant.maximum);
  HistogramOptions options;
  options.padding = 12.0;
  const Histogram nothing = histogram(view, options);
  CHECK(nothing.bins() == 0);
  CHECK(nothing.padding_samples == 64);
}

TEMPLATE_TEST_CASE("a sample that is not finite is named", "[levelset][contract]", float, double) {
  std::vector<TestType> samples(4 * 5 * 6, TestType{1});
  samples[4 * 5 * 2 + 4 * 3 + 1] = std::numeric_limits<TestType>::quiet_NaN();
  const ImageView view = make_view(samples.data(), {4, 5, 6});
  CHECK_THROWS_WITH(histogram(view), "image: sample (1, 3, 2) is NaN; expected a finite number");
  samples[0] = std::numeric_limits<TestType>::infinity();
  CHECK_THROWS_WITH(histogram(view), "image: sample (0, 0, 0) is inf; expected a finite number");
}

TEST_CASE("options of a histogram out of range are refused", "[levelset][contract]") {
  const std::vector<std::int16_t> samples(8, 1);
  const ImageView view = make_view(samples.data(), {2, 2, 2});
  HistogramOptions options;
  options.max_bins = 1;
  CHECK_THROWS_WITH(histogram(view, options), "max_bins is 1; expected at least 2");
  options = {};
  options.threads = -1;
  CHECK_THROWS_WITH(histogram(view, options), Contains("threads is -1"));
  CHECK_THROWS_AS(histogram(ImageView{}), std::invalid_argument);
}
}  // namespace
