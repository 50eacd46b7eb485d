#include "common/volume_info.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

namespace {

using namespace shape3d::apps;

template <class T>
Volume make_volume(const std::vector<T>& values, std::array<std::int64_t, 3> dims) {
  Volume volume;
  volume.samples.resize(values.size() * sizeof(T));
  std::memcpy(volume.samples.data(), values.data(), volume.samples.size());
  volume.view = shape3d::zmc::make_view(reinterpret_cast<const T*>(volume.samples.data()), dims,
                                        {0.5, 0.75, 2.0}, {1.0, 2.0, 3.0});
  volume.format = "test";
  return volume;
}

std::uint64_t total(const std::vector<std::uint64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

TEST_CASE("a description has range, mean and histogram of 0 … n − 1", "[info]") {
  // Each of the 32 bins gets the same share: 3072 values from 0 to 3071, width 3071 / 32.
  std::vector<std::int16_t> values(3072);
  std::iota(values.begin(), values.end(), std::int16_t{-1000});
  const VolumeDescription found = describe_volume(make_volume(values, {16, 12, 16}));
  CHECK(found.format == "test");
  CHECK(found.dims == std::array<std::int64_t, 3>{16, 12, 16});
  CHECK(found.type == shape3d::zmc::SampleType::int16);
  CHECK(found.spacing == Eigen::Vector3d(0.5, 0.75, 2.0));
  CHECK(found.origin == Eigen::Vector3d(1.0, 2.0, 3.0));
  CHECK(found.direction == Eigen::Matrix3d::Identity());
  CHECK(found.minimum == -1000.0);
  CHECK(found.maximum == 2071.0);
  CHECK(found.mean == 535.5);
  CHECK(found.finite == 3072);
  CHECK(found.non_finite == 0);
  REQUIRE(found.histogram.size() == 32);
  CHECK(found.histogram_lower == -1000.0);
  CHECK(found.histogram_width == Approx(3071.0 / 32));
  CHECK(total(found.histogram) == 3072);
  for (std::size_t bin = 0; bin < 32; ++bin) {
    // Values in [lower, upper), by the definition.
    const double lower = found.histogram_lower + static_cast<double>(bin) * found.histogram_width;
    const double upper = lower + found.histogram_width;
    const double first = std::ceil(lower);
    const double end = bin == 31 ? 2072.0 : std::ceil(upper);
    CHECK(static_cast<double>(found.histogram[bin]) == end - first);
  }
}

TEST_CASE("labels have a bin for each value", "[info]") {
  std::vector<std::uint8_t> values(60, 7);
  for (std::size_t n = 0; n < 20; ++n) values[n] = 9;
  values[59] = 12;
  const VolumeDescription found = describe_volume(make_volume(values, {5, 4, 3}));
  CHECK(found.histogram == std::vector<std::uint64_t>{39, 0, 20, 0, 0, 1});
  CHECK(found.histogram_lower == 6.5);
  CHECK(found.histogram_width == 1.0);
  CHECK(found.mean == Approx((39 * 7 + 20 * 9 + 12) / 60.0));
}

TEST_CASE("what is not finite is counted and left out", "[info]") {
  std::vector<float> values(60, 2.0F);
  values[0] = std::numeric_limits<float>::quiet_NaN();
  values[17] = std::numeric_limits<float>::infinity();
  values[59] = -std::numeric_limits<float>::infinity();
  values[30] = -6.0F;
  const VolumeDescription found = describe_volume(make_volume(values, {5, 4, 3}));
  CHECK(found.finite == 57);
  CHECK(found.non_finite == 3);
  CHECK(found.minimum == -6.0);
  CHECK(found.maximum == 2.0);
  CHECK(found.mean == Approx((56 * 2.0 - 6.0) / 57.0));
  CHECK(total(found.histogram) == 57);
  CHECK(found.histogram.front() == 1);
  CHECK(found.histogram.back() == 56);

  const std::vector<double> nothing(60, std::numeric_limits<double>::quiet_NaN());
  const VolumeDescription none = describe_volume(make_volume(nothing, {5, 4, 3}));
  CHECK(none.finite == 0);
  CHECK(none.non_finite == 60);
  CHECK(none.histogram.empty());
  CHECK(none.minimum == 0.0);
}

TEST_CASE("constants and the largest doubles have a histogram", "[info]") {
  const VolumeDescription one =
      describe_volume(make_volume(std::vector<double>(60, 0.1), {5, 4, 3}));
  CHECK(one.histogram == std::vector<std::uint64_t>{60});
  CHECK(one.mean == Approx(0.1).epsilon(1e-15));
  std::vector<double> values(60, std::numeric_limits<double>::max());
  values[5] = std::numeric_limits<double>::lowest();
  const VolumeDescription wide = describe_volume(make_volume(values, {5, 4, 3}));
  REQUIRE(wide.histogram.size() == 32);
  CHECK(wide.histogram.front() == 1);
  CHECK(wide.histogram.back() == 59);
  const VolumeDescription small =
      describe_volume(make_volume(std::vector<std::int32_t>(60, -5), {5, 4, 3}));
  CHECK(small.histogram == std::vector<std::uint64_t>{60});
  CHECK(describe_volume(Volume()).histogram.empty());
}

}  // namespace
