#include "shape3d/zmc/volume_view.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

namespace {
using namespace shape3d::zmc;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What validate() says of a view; empty when it accepts it.
std::string complaint(const VolumeView& view) {
  try {
    validate(view);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

/// A valid view of 4 x 5 x 6 samples, sample (i, j, k) being its place in the dense array.
struct Example {
  std::vector<std::int16_t> samples = [] {
    std::vector<std::int16_t> values(120);
    std::iota(values.begin(), values.end(), std::int16_t{0});
    return values;
  }();
  VolumeView view = make_view(samples.data(), {4, 5, 6}, {0.5, 1.0, 2.0}, {-10.0, 20.0, 30.0});
};

/// Sample (i, j, k) of a view of int16.
std::int16_t sample(const VolumeView& view, std::int64_t i, std::int64_t j, std::int64_t k) {
  const auto strides = view.effective_strides();
  return static_cast<const std::int16_t*>(
      view.data)[i * strides[0] + j * strides[1] + k * strides[2]];
}

template <class T>
void check_type(const char* name) {
  const T value{};
  const VolumeView view = make_view(&value, {2, 3, 4});
  CHECK(to_string(view.type) == name);
  CHECK(sample_size(view.type) == sizeof(T));
}

TEST_CASE("sample types have the name and the size of their C++ type", "[zmc]") {
  check_type<std::int8_t>("int8");
  check_type<std::uint8_t>("uint8");
  check_type<std::int16_t>("int16");
  check_type<std::uint16_t>("uint16");
  check_type<std::int32_t>("int32");
  check_type<float>("float32");
  check_type<double>("float64");
}

TEST_CASE("a number outside the enumeration is no sample type", "[zmc][contract]") {
  CHECK(to_string(static_cast<SampleType>(99)) == "unknown");
  CHECK_THROWS_WITH(sample_size(static_cast<SampleType>(99)),
                    "sample type is 99; expected one of the enumeration");
}

TEST_CASE("strides of zero stand for a dense array, x fastest", "[zmc]") {
  const Example example;
  CHECK(example.view.effective_strides() == std::array<std::int64_t, 3>{1, 4, 20});
  CHECK(sample(example.view, 3, 2, 1) == 3 + 4 * 2 + 20 * 1);
}

TEST_CASE("world applies spacing, then direction, then origin", "[zmc]") {
  Example example;
  // A quarter turn about z: lattice x runs along world y, lattice y along world -x.
  example.view.direction << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  CHECK(example.view.world({2, 3, 4}) == Eigen::Vector3d(-10 - 3 * 1.0, 20 + 2 * 0.5, 30 + 4 * 2));
}

TEST_CASE("a subvolume shares the samples at their places in the world", "[zmc]") {
  Example example;
  example.view.direction =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const std::array<std::int64_t, 3> lower{1, 0, 2};
  const VolumeView block = subvolume(example.view, lower, {4, 3, 6});
  CHECK(block.dims == std::array<std::int64_t, 3>{3, 3, 4});
  CHECK_NOTHROW(validate(block));
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        CHECK(sample(block, i, j, k) == sample(example.view, i + 1, j, k + 2));
        CHECK(block.world(Eigen::Vector3d(i, j, k))
                  .isApprox(example.view.world(Eigen::Vector3d(i + 1, j, k + 2)), 1e-14));
      }
    }
  }
  const VolumeView inner = subvolume(block, {1, 1, 1}, {3, 3, 3});
  CHECK(sample(inner, 1, 1, 1) == sample(example.view, 3, 2, 4));
}

TEST_CASE("a subvolume of a view with negative strides follows them", "[zmc]") {
  Example example;
  VolumeView flipped = example.view;
  flipped.strides = {1, -4, 20};
  flipped.data = &example.samples[16];
  const VolumeView block = subvolume(flipped, {0, 1, 0}, {4, 4, 6});
  CHECK(sample(block, 2, 0, 3) == sample(example.view, 2, 3, 3));
  CHECK(sample(block, 2, 2, 3) == sample(example.view, 2, 1, 3));
}

TEST_CASE("a subvolume refuses blocks that are empty or reach outside", "[zmc][contract]") {
  const Example example;
  CHECK_NOTHROW(subvolume(example.view, {0, 0, 0}, {4, 5, 6}));
  CHECK_THROWS_AS(subvolume(example.view, {0, 0, 0}, {5, 5, 6}), std::invalid_argument);
  CHECK_THROWS_WITH(subvolume(example.view, {0, 0, 0}, {5, 5, 6}),
                    "subvolume: range [0, 5) of axis x; expected a non-empty range within [0, 4)");
  CHECK_THROWS_WITH(subvolume(example.view, {0, -1, 0}, {4, 5, 6}),
                    "subvolume: range [-1, 5) of axis y; expected a non-empty range within [0, 5)");
  CHECK_THROWS_WITH(subvolume(example.view, {0, 0, 3}, {4, 5, 3}),
                    "subvolume: range [3, 3) of axis z; expected a non-empty range within [0, 6)");
}

TEST_CASE("a subvolume of a view without samples has none", "[zmc]") {
  VolumeView view;
  view.dims = {4, 4, 4};
  CHECK(subvolume(view, {1, 1, 1}, {3, 3, 3}).data == nullptr);
}

TEST_CASE("validate accepts views of every place and handedness", "[zmc][contract]") {
  Example example;
  CHECK(complaint(example.view).empty());
  example.view.direction.col(2) *= -1;
  CHECK(complaint(example.view).empty());
  example.view.strides = {20, -5, 1};
  CHECK(complaint(example.view).empty());
  // Scale is no matter: neither the smallest nor the largest axes are singular.
  for (const double scale : {1e-300, 1e-8, 1e8, 1e300}) {
    example.view.direction = scale * Eigen::Matrix3d::Identity();
    CAPTURE(scale);
    CHECK(complaint(example.view).empty());
  }
  example.view.direction << 1, 1, 0, 0, 1e-6, 0, 0, 0, 1;  // sheared, but not singular
  CHECK(complaint(example.view).empty());
}

TEST_CASE("validate names the missing samples", "[zmc][contract]") {
  Example example;
  example.view.data = nullptr;
  CHECK_THROWS_AS(validate(example.view), std::invalid_argument);
  CHECK(complaint(example.view) == "volume view: data is null; expected a pointer to samples");
}

TEST_CASE("validate names a dimension without cells", "[zmc][contract]") {
  Example example;
  const auto [axis, dim] = GENERATE(table<int, std::int64_t>({{0, 1}, {1, 0}, {2, -7}}));
  example.view.dims[static_cast<std::size_t>(axis)] = dim;
  CHECK(complaint(example.view) ==
        "volume view: dims[" + std::to_string(axis) + "] is " + std::to_string(dim) +
            "; expected at least 2 (a volume one sample thick has no cells)");
}

TEST_CASE("validate refuses more samples than memory can address", "[zmc][contract]") {
  Example example;
  const std::int64_t side = std::int64_t{1} << 21;  // side^3 = 2^63
  example.view.dims = {side, side, side};
  CHECK(complaint(example.view) ==
        "volume view: dims is (2097152, 2097152, 2097152); "
        "expected a number of samples that memory can address");
  example.view.dims = {side, side, side / 2};  // 2^62 samples of 2 bytes: one byte too many
  CHECK_FALSE(complaint(example.view).empty());
  example.view.type = SampleType::int8;
  CHECK(complaint(example.view).empty());
}

TEST_CASE("validate refuses strides that are zero on some axes only", "[zmc][contract]") {
  Example example;
  example.view.strides = {1, 0, 20};
  CHECK(complaint(example.view) ==
        "volume view: strides is (1, 0, 20); expected all or none of them 0");
}

TEST_CASE("validate names a spacing that is not finite and positive", "[zmc][contract]") {
  Example example;
  const auto [axis, value, printed] = GENERATE(table<int, double, std::string>(
      {{0, 0.0, "0"}, {1, -0.5, "-0.5"}, {2, kNan, "nan"}, {2, kInfinity, "inf"}}));
  example.view.spacing[axis] = value;
  CHECK(complaint(example.view) == "volume view: spacing[" + std::to_string(axis) + "] is " +
                                       printed + "; expected a finite positive number");
}

TEST_CASE("validate names an origin or a direction that is not finite", "[zmc][contract]") {
  Example example;
  example.view.origin[1] = -kInfinity;
  CHECK(complaint(example.view) == "volume view: origin[1] is -inf; expected a finite number");
  example.view.origin[1] = 0.0;
  example.view.direction(2, 0) = kNan;
  CHECK(complaint(example.view) == "volume view: direction(2, 0) is nan; expected a finite number");
}

TEST_CASE("validate refuses a singular direction at every scale", "[zmc][contract]") {
  Example example;
  const double scale = GENERATE(1e-300, 1.0, 1e300);
  CAPTURE(scale);
  SECTION("an axis of length zero") {
    example.view.direction = scale * Eigen::Matrix3d::Identity();
    example.view.direction.col(1).setZero();
    CHECK_THAT(complaint(example.view), Catch::StartsWith("volume view: direction is singular"));
  }
  SECTION("axes in one plane, not representable exactly") {
    const Eigen::Vector3d a(0.1, 0.7, 0.3);
    const Eigen::Vector3d b(0.9, -0.2, 0.6);
    example.view.direction.col(0) = scale * a;
    example.view.direction.col(1) = scale * b;
    example.view.direction.col(2) = scale * (a / 3 + b / 7);
    CHECK_THAT(complaint(example.view), Catch::StartsWith("volume view: direction is singular"));
  }
}

TEST_CASE("the message of a singular direction shows its columns", "[zmc][contract]") {
  Example example;
  example.view.direction << 1, 2, 0, 0, 0, 0.5, 0, 0, 0;
  CHECK(complaint(example.view) ==
        "volume view: direction is singular (columns 1 0 0; 2 0 0; 0 0.5 0); "
        "expected three independent axes");
}
}  // namespace
