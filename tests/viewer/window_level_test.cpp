#include "viewer/model/window_level.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "viewer/model/isovalues.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps::viewer;

TEST_CASE("presets by name", "[viewer][window]") {
  REQUIRE(window_preset("bone"));
  CHECK(window_preset("bone")->black() == -500.0);
  CHECK(window_preset("bone")->white() == 1500.0);
  CHECK(window_preset("lung")->level == -600.0);
  CHECK(window_preset("soft-tissue")->width == 400.0);
  CHECK(window_preset("abdomen")->width == 350.0);
  CHECK_FALSE(window_preset("brain"));
}

TEST_CASE("the automatic window leaves outliers outside", "[viewer][window]") {
  // 0 … 9999 in order, one sample in a thousand far above.
  std::vector<float> samples(100'000);
  for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = static_cast<float>(n % 10'000);
  for (std::size_t n = 0; n < samples.size(); n += 1000) samples[n] = 1e6F;
  samples[5] = std::numeric_limits<float>::quiet_NaN();
  const Window window = automatic_window(zmc::make_view(samples.data(), {100, 100, 10}));
  CHECK(window.black() == Approx(100.0).margin(20.0));
  CHECK(window.white() == Approx(9950.0).margin(60.0));
}

TEST_CASE("a constant or no number at all has a window, too", "[viewer][window]") {
  std::vector<float> samples(8, 5.0F);
  CHECK(automatic_window(zmc::make_view(samples.data(), {2, 2, 2})) == Window{5.0, 1.0});
  samples.assign(8, std::numeric_limits<float>::quiet_NaN());
  CHECK(automatic_window(zmc::make_view(samples.data(), {2, 2, 2})) == Window{0.0, 1.0});
}

TEST_CASE("a drag over the side goes through the range", "[viewer][window]") {
  const Window start{100.0, 50.0};
  CHECK(dragged(start, 0.0, -1.0, 1000.0) == Window{-900.0, 50.0});
  CHECK(dragged(start, 0.5, 0.0, 1000.0) == Window{100.0, 550.0});
  CHECK(dragged(start, -1.0, 0.0, 1000.0).width > 0.0);
}

TEST_CASE("the first isovalue parts two classes", "[viewer][window]") {
  std::vector<float> samples(4096);
  for (std::size_t n = 0; n < samples.size(); ++n)
    samples[n] = (n % 3 == 0 ? 80.0F : 20.0F) + static_cast<float>(n % 7);
  const double isovalue = default_isovalue(zmc::make_view(samples.data(), {16, 16, 16}), 20, 86);
  CHECK(isovalue > 26.0);
  CHECK(isovalue < 80.0);
  // CT: bone.
  CHECK(default_isovalue(zmc::make_view(samples.data(), {16, 16, 16}), -1024, 3000) == 226.0);
  CHECK(default_isovalue(zmc::make_view(samples.data(), {16, 16, 16}), 5, 5) == 5.0);
}

}  // namespace
