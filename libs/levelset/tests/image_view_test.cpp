#include "shape3d/levelset/image_view.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/levelset/status.hpp"

namespace {
using namespace shape3d::levelset;
using Catch::Contains;

const std::vector<std::int16_t> kSamples(24, 7);

ImageView valid() { return make_view(kSamples.data(), {4, 3, 2}, {0.5, 0.5, 2.0}); }

TEST_CASE("a subvolume shares the samples of its box", "[levelset]") {
  std::vector<std::int32_t> samples(4 * 3 * 2);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<std::int32_t>(i);
  const ImageView view = make_view(samples.data(), {4, 3, 2});
  const ImageView block = subvolume(view, {{1, 2, 1}, {3, 3, 2}});
  CHECK(block.dims == std::array<std::int64_t, 3>{2, 1, 1});
  CHECK(*static_cast<const std::int32_t*>(block.data) == 1 + 4 * (2 + 3 * 1));
  CHECK(block.effective_strides() == view.effective_strides());
}

TEST_CASE("an empty, inverted or outlying region of interest is refused", "[levelset][contract]") {
  const ImageView view = valid();
  CHECK_THROWS_WITH(subvolume(view, {{0, 0, 0}, {0, 3, 2}}),
                    "region of interest: range [0, 0) of axis x; expected a non-empty range within "
                    "[0, 4)");
  CHECK_THROWS_WITH(subvolume(view, {{0, 2, 0}, {4, 1, 2}}), Contains("[2, 1) of axis y"));
  CHECK_THROWS_WITH(subvolume(view, {{0, 0, 0}, {4, 3, 3}}), Contains("[0, 3) of axis z"));
  CHECK_THROWS_AS(subvolume(view, {{-1, 0, 0}, {4, 3, 2}}), std::invalid_argument);
}

TEST_CASE("a view that is no image is refused, naming the field", "[levelset][contract]") {
  CHECK_NOTHROW(validate(valid()));
  ImageView view = valid();
  view.data = nullptr;
  CHECK_THROWS_WITH(validate(view), "image: data is null; expected a pointer to samples");
  view = valid();
  view.dims[1] = 0;
  CHECK_THROWS_WITH(validate(view), "image: dims[1] is 0; expected at least 1");
  view = valid();
  view.dims = {std::int64_t{1} << 31, std::int64_t{1} << 31, 2};
  CHECK_THROWS_WITH(validate(view), Contains("that memory can address"));
  view = valid();
  view.spacing[2] = -1.0;
  CHECK_THROWS_WITH(validate(view),
                    "image: spacing[2] is -1; expected a finite positive number of mm");
  view = valid();
  view.strides = {1, 0, 12};
  CHECK_THROWS_WITH(validate(view), "image: strides is (1, 0, 12); expected all or none of them 0");
  CHECK_THROWS_WITH(validate(Grid{{2, 0, 2}, {1, 1, 1}}), Contains("grid: dims[1] is 0"));
  CHECK_THROWS_AS(sample_size(static_cast<SampleType>(99)), std::invalid_argument);
}

TEST_CASE("sample types and statuses have names", "[levelset]") {
  CHECK(to_string(SampleType::uint16) == "uint16");
  CHECK(sample_size(SampleType::float64) == 8);
  for (int s = 0; s <= static_cast<int>(Status::cancelled); ++s) {
    CHECK(to_string(static_cast<Status>(s)) != "unknown status");
  }
  CHECK(anisotropy({0.5, 0.5, 5.0}) == 10.0);
  CHECK(Grid{{1, 1, 1}, {1, 2, 4}}.mean_spacing() == Approx(2.0));
}
}  // namespace
