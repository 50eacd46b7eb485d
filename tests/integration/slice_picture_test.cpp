#include "common/slice_picture.hpp"

#include <cmath>
#include <numeric>

#include <catch2/catch.hpp>

#include "common/polylines.hpp"
#include "png_image.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::test;
using Catch::Matchers::Message;

constexpr Color kRed{0.85, 0.1, 0.1};

// A half that is bright: x ≥ 8 of 16 × 12 × 4, 1 × 2 × 3 mm.
struct Halves {
  Halves() {
    for (int n = 0; n < 16 * 12 * 4; ++n) samples.push_back(n % 16 >= 8 ? 100 : 0);
    view = zmc::make_view(samples.data(), {16, 12, 4}, {1, 2, 3}, {5, -7, 11});
  }
  std::vector<std::int16_t> samples;
  zmc::VolumeView view;
};

SlicePanel panel_of(const Halves& halves) {
  SlicePanel panel;
  panel.title = "z = 2";
  panel.volume = halves.view;
  panel.slice = 2;
  panel.white = 100.0;
  return panel;
}

PngImage drawn(const std::vector<SlicePanel>& panels, SlicePage page = {}) {
  page.private_display = true;
  return decode_png(draw_slices(panels, page));
}

TEST_CASE("places on a slice and lattice coordinates are inverse", "[slices]") {
  zmc::VolumeView view = Halves().view;
  view.direction << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  for (int axis = 0; axis < 3; ++axis) {
    const SlicePlane plane(view, axis);
    const Eigen::Vector3d lattice = plane.lattice({3.5, 1.25}, 2);
    CHECK(lattice[axis] == 2.0);
    const auto back = plane.project(view.world(lattice));
    CHECK(back[0] == Approx(3.5));
    CHECK(back[1] == Approx(1.25));
  }
}

TEST_CASE("a slice shows its intensities in the proportions of millimetres", "[slices]") {
  const Halves halves;
  const PngImage png = drawn({panel_of(halves)});
  CHECK(png.width == 520);
  CHECK(png.height == 560);
  // Black: 7.5 of 15 mm wide and 22 mm high.
  int least_x = png.width, most_x = 0, least_y = png.height, most_y = 0;
  for (int y = 40; y < png.height; ++y) {  // below the title
    for (int x = 0; x < png.width; ++x) {
      if (!png.is(x, y, {0, 0, 0}, 0.1)) continue;
      least_x = std::min(least_x, x);
      most_x = std::max(most_x, x);
      least_y = std::min(least_y, y);
      most_y = std::max(most_y, y);
    }
  }
  const double width = most_x - least_x + 1, height = most_y - least_y + 1;
  // The ramp between the halves is one sample wide and turns white: dark are 7 mm of it.
  CHECK(width / height == Approx(7.05 / 22).epsilon(0.03));
}

TEST_CASE("the outline lies where the intensities change, in its colour, with a legend",
          "[slices]") {
  const Halves halves;
  SlicePanel panel = panel_of(halves);
  const auto lines = outline_of(halves.view, halves.view, 50, 2, 2);
  REQUIRE(lines.size() == 1);
  for (const auto& point : lines[0]) CHECK(point[0] == Approx(7.5));  // half-way from 7 to 8
  CHECK(std::abs(lines[0].front()[1] - lines[0].back()[1]) == Approx(22));
  panel.outlines = {{"", kRed, lines}};
  const int without = drawn({panel}).count(kRed, 0.1);
  CHECK(without > 300);
  panel.outlines[0].label = "truth";
  CHECK(drawn({panel}).count(kRed, 0.1) > without);
  // Of a part of the volume: at the same place.
  const zmc::VolumeView part = zmc::subvolume(halves.view, {4, 2, 1}, {12, 8, 4});
  const auto shorter = outline_of(halves.view, part, 50, 2, 1);
  REQUIRE(shorter.size() == 1);
  CHECK(shorter[0].front()[0] == Approx(7.5));
  CHECK(std::min(shorter[0].front()[1], shorter[0].back()[1]) == Approx(4));
}

TEST_CASE("points that coincide do not take the rest of the outline with them", "[slices]") {
  const Halves halves;
  const auto red = [&](const SliceOutline& outline) {
    SlicePanel panel = panel_of(halves);
    panel.outlines = {outline};
    return drawn({panel}).count(kRed, 0.1);
  };
  const SliceOutline square{"", kRed, {{{2, 4}, {12, 4}, {12, 18}, {2, 18}, {2, 4}}}};
  // Each corner four times: twice the same place, and as near as zero crossings at a sample are.
  SliceOutline repeated = square;
  repeated.lines[0].clear();
  for (const auto& [x, y] : square.lines[0]) {
    for (const double off : {0.0, 0.0, 1e-7, 1e-4}) repeated.lines[0].push_back({x + off, y + off});
  }
  const int whole = red(square);
  CHECK(whole > 1000);
  CHECK(red(repeated) == Approx(whole).epsilon(0.02));
  // A loop smaller than a pixel is still seen.
  CHECK(red({"", kRed, {{{5, 5}, {5, 5}, {5.0001, 5}, {5, 5}}}}) > 0);
}

TEST_CASE("what slices cannot be drawn of is refused", "[slices]") {
  const Halves halves;
  const auto refused = [](const std::vector<SlicePanel>& panels, const SlicePage& page,
                          const std::string& words) {
    CHECK_THROWS_MATCHES(draw_slices(panels, page), std::invalid_argument, Message(words));
  };
  refused({}, {}, "panels is empty; expected one or more");
  SlicePage page;
  page.columns = 17;
  refused({panel_of(halves)}, page, "columns is 17; expected 1 to 16");
  page = {};
  page.height = 100;
  refused({panel_of(halves)}, page,
          "height is 100 pixels for each of 1 panels; expected 128 to 4096, and at most 16384 in "
          "all");
  SlicePanel panel = panel_of(halves);
  panel.slice = 4;
  refused({panel}, {}, "slice is 4; expected 0 to 3");
  panel.axis = 3;
  refused({panel}, {}, "axis is 3; expected 0, 1 or 2");
  panel = panel_of(halves);
  panel.white = panel.black;
  refused({panel}, {}, "white is 0; expected more than black, 0");
}

}  // namespace
