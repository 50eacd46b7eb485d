#include "common/chart.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include <catch2/catch.hpp>

#include "png_image.hpp"
#include "support/test_data.hpp"

namespace {
using namespace shape3d::apps;
using namespace shape3d::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Message;

constexpr Color kRed{0.8, 0.1, 0.1}, kGreen{0.1, 0.6, 0.2}, kBlue{0.1, 0.2, 0.8};

ChartSeries series_of(ChartSeries::Kind kind, std::vector<std::array<double, 2>> points,
                      const Color& color) {
  ChartSeries series;
  series.kind = kind;
  series.points = std::move(points);
  series.color = color;
  return series;
}

/// Mean column or row of the pixels of a colour.
std::optional<std::array<double, 2>> middle_of(const PngImage& png, const Color& color) {
  double x = 0, y = 0;
  int n = 0;
  for (int row = 0; row < png.height; ++row) {
    for (int column = 0; column < png.width; ++column) {
      if (!png.is(column, row, color)) continue;
      x += column;
      y += row;
      ++n;
    }
  }
  if (n == 0) return std::nullopt;
  return std::array<double, 2>{x / n, y / n};
}

PngImage drawn(const std::vector<Chart>& charts, ChartPage page = {}) {
  page.private_display = true;
  return decode_png(draw_charts(charts, page));
}

TEST_CASE("the ends of an axis: range, margin, one value, none", "[chart]") {
  ChartAxis axis;
  CHECK(axis_ends(axis, {0, 10}) == std::array<double, 2>{-0.5, 10.5});
  CHECK(axis_ends(axis, {3, std::nan("")}) == std::array<double, 2>{2.5, 3.5});
  CHECK(axis_ends(axis, {}) == std::array<double, 2>{-0.5, 0.5});
  axis.logarithmic = true;
  const auto ends = axis_ends(axis, {-1, 0, 1, 100});  // not positive: not drawn
  CHECK(ends[0] == Approx(std::pow(10, -0.1)));
  CHECK(ends[1] == Approx(std::pow(10, 2.1)));
  CHECK(axis_ends(axis, {8})[0] == Approx(4));
  CHECK(axis_ends(axis, {8})[1] == Approx(16));
  axis.range = {{2, 3}};
  CHECK(axis_ends(axis, {8}) == std::array<double, 2>{2, 3});
}

TEST_CASE("round places on a logarithmic axis", "[chart]") {
  using Ticks = std::vector<std::pair<double, std::string>>;
  CHECK(logarithmic_ticks(0.5, 20) ==
        Ticks{{0.5, "0.5"}, {1, "1"}, {2, "2"}, {5, "5"}, {10, "10"}, {20, "20"}});
  CHECK(logarithmic_ticks(0.02, 99999) ==
        Ticks{{0.1, "0.1"}, {1, "1"}, {10, "10"}, {100, "100"}, {1000, "1000"}, {10000, "10000"}});
}

TEST_CASE("points, marker lines and a legend stand where the axes say", "[chart]") {
  // Five single charts with the same axes: the mean pixel of a point is affine in its coordinates.
  const auto place = [](double x, double y, bool logarithmic) {
    Chart chart;
    chart.x.range = logarithmic ? std::array<double, 2>{1, 100} : std::array<double, 2>{0, 2};
    chart.y.range = {{0, 1}};
    chart.x.logarithmic = logarithmic;
    chart.series = {series_of(ChartSeries::Kind::points, {{x, y}}, kRed)};
    return *middle_of(drawn({chart}), kRed);
  };
  const auto low = place(0.2, 0.2, false), high = place(1.8, 0.8, false);
  const auto centre = place(1.0, 0.5, false);
  CHECK(high[0] - low[0] > 600);
  CHECK(low[1] - high[1] > 250);
  CHECK(centre[0] == Approx((low[0] + high[0]) / 2).margin(1));
  CHECK(centre[1] == Approx((low[1] + high[1]) / 2).margin(1));
  const auto one = place(2, 0.5, true), ten = place(10, 0.5, true), fifty = place(50, 0.5, true);
  CHECK(ten[0] - one[0] == Approx(fifty[0] - ten[0]).margin(1));  // both a factor of 5

  Chart chart;
  chart.x.range = {{0, 2}};
  chart.y.range = {{0, 1}};
  chart.markers = {{"", 1.0, kGreen, ChartSeries::Pattern::solid}};
  const PngImage plain = drawn({chart});
  CHECK((*middle_of(plain, kGreen))[0] == Approx(centre[0]).margin(1));
  chart.markers[0].label = "marker";
  CHECK(drawn({chart}).count(kGreen) > plain.count(kGreen));  // its sign in the legend
  chart.legend = LegendPlace::none;
  CHECK(drawn({chart}).count(kGreen) == plain.count(kGreen));
}

TEST_CASE("the area of bars and bands is that of their numbers", "[chart]") {
  Chart chart;
  chart.x.range = {{0, 10}};
  chart.y.range = {{0, 4}};
  ChartSeries bars = series_of(ChartSeries::Kind::bars, {{1, 1}, {3, 3}, {8, 2}}, kBlue);
  bars.bar_width = 1;
  chart.series = {bars};
  const int three = drawn({chart}).count(kBlue);
  chart.series[0].points = {{5, 2}};
  const int one = drawn({chart}).count(kBlue);
  CHECK(three == Approx(3.0 * one).epsilon(0.02));
  chart.series.clear();
  ChartBand band;
  band.points = {{4, 1, 2}, {6, 1, 2}};  // 2 × 1, as one bar
  band.color = kBlue;
  band.opacity = 1.0;
  chart.bands = {band};
  CHECK(drawn({chart}).count(kBlue) == Approx(one).epsilon(0.03));
}

TEST_CASE("a line is broken where there is no number", "[chart]") {
  Chart chart;
  chart.x.range = {{0, 4}};
  chart.y.range = {{0, 2}};
  chart.series = {series_of(ChartSeries::Kind::line, {{0, 1}, {4, 1}}, kRed)};
  const int whole = drawn({chart}).count(kRed);
  chart.series[0].points = {{0, 1}, {1, 1}, {2, std::nan("")}, {3, 1}, {4, 1}};
  CHECK(drawn({chart}).count(kRed) == Approx(whole / 2.0).epsilon(0.05));
}

TEST_CASE("charts stand below and beside one another in the size that is asked for", "[chart]") {
  std::vector<Chart> charts(3);
  const Color colors[] = {kRed, kGreen, kBlue};
  for (std::size_t n = 0; n < 3; ++n)
    charts[n].series = {series_of(ChartSeries::Kind::line, {{0, 0}, {1, 1}}, colors[n])};
  ChartPage page;
  page.width = 500;
  page.height = 300;
  const PngImage stacked = drawn(charts, page);
  CHECK(stacked.width == 500);
  CHECK(stacked.height == 900);
  for (int n = 0; n < 3; ++n) {
    CHECK((*middle_of(stacked, colors[n]))[1] == Approx(300 * n + 140).margin(40));
  }
  page.columns = 2;
  const PngImage grid = drawn(charts, page);
  CHECK(grid.width == 1000);
  CHECK(grid.height == 600);
  CHECK((*middle_of(grid, kGreen))[0] > 500);
  CHECK((*middle_of(grid, kBlue))[1] > 300);
}

TEST_CASE("what a chart cannot be drawn of is refused", "[chart]") {
  const auto refused = [](const std::vector<Chart>& charts, const ChartPage& page,
                          const std::string& words) {
    CHECK_THROWS_MATCHES(draw_charts(charts, page), std::invalid_argument, Message(words));
  };
  ChartPage page;
  refused({}, page, "charts is empty; expected one or more");
  std::vector<Chart> charts(1);
  page.columns = 0;
  refused(charts, page, "columns is 0; expected 1 to 16");
  page = {};
  page.width = 63;
  refused(charts, page,
          "width is 63 pixels for each of 1 charts; expected 64 to 8192, and at most 16384 in all");
  page = {};
  page.height = 6000;
  refused(std::vector<Chart>(3), page,
          "height is 6000 pixels for each of 3 charts; expected 64 to 8192, and at most 16384 in "
          "all");
  page = {};
  charts[0].y.range = {{2, 1}};
  refused(charts, page, "range of the y axis is 2 … 1; expected growing finite numbers");
  charts[0].y.range.reset();
  charts[0].x.range = {{0, 1}};
  charts[0].x.logarithmic = true;
  refused(charts, page, "range of the x axis is 0 … 1; expected growing positive numbers");
  charts[0].x.range.reset();
  charts[0].series = {series_of(ChartSeries::Kind::bars, {{1, 1}}, kRed)};
  charts[0].series[0].label = "h";
  refused(charts, page, "bars of series \"h\" stand on a logarithmic axis; expected linear axes");
}

TEST_CASE("a chart without a display server is an error, not an abort", "[chart]") {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nonexistent", 1);
  ChartPage page;
  page.private_display = true;
  CHECK_THROWS_WITH(draw_charts(std::vector<Chart>(1), page), Contains("Xvfb"));
  setenv("PATH", path.c_str(), 1);
}

}  // namespace
