#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "picture.hpp"

class vtkChartXY;

namespace shape3d::apps {

/// Numbers drawn in a chart. Points that are not finite are left out, and those that are not
/// positive on a logarithmic axis; a line is broken there.
struct ChartSeries {
  enum class Kind { line, points, bars };
  enum class Pattern { solid, dashed, dotted };
  enum class Marker { none, circle, square, diamond, plus, cross };

  std::string label;  ///< In the legend; empty: not there.
  std::vector<std::array<double, 2>> points;
  Color color{0.1, 0.35, 0.75};
  Kind kind = Kind::line;
  Pattern pattern = Pattern::solid;
  Marker marker = Marker::none;  ///< Of a line or points; points have circles when it is none.
  double width = 2.5;            ///< Of lines, pixels.
  /// Of bars, in units of x; bars stand on the lower end of the y axis, their middle at x.
  double bar_width = 1.0;
};

/// An area between two curves, behind the series.
struct ChartBand {
  std::string label;
  std::vector<std::array<double, 3>> points;  ///< x, lower y, upper y; x grows.
  Color color{0.75, 0.82, 0.92};
  double opacity = 0.6;
};

/// A vertical line from the lower to the upper end of the y axis.
struct ChartMarker {
  std::string label;
  double x = 0.0;
  Color color{0.8, 0.15, 0.15};
  ChartSeries::Pattern pattern = ChartSeries::Pattern::dashed;
};

struct ChartAxis {
  std::string title;
  bool logarithmic = false;
  /// Lower and upper end. Empty: the numbers drawn, with a margin.
  std::optional<std::array<double, 2>> range;
  /// Places and their labels. Empty: round numbers.
  std::vector<std::pair<double, std::string>> ticks;
};

enum class LegendPlace { none, top_left, top_right, bottom_left, bottom, bottom_right };

struct Chart {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartBand> bands;
  std::vector<ChartSeries> series;
  std::vector<ChartMarker> markers;
  LegendPlace legend = LegendPlace::top_right;
};

/// Charts in a grid, row by row; those of a column stand one above the other.
struct ChartPage {
  int columns = 1;                 ///< 1 … 16.
  int width = 1100, height = 700;  ///< Pixels of each chart, 64 … 8192; of all, at most 16384.
  bool private_display = false;    ///< Never the display of the environment.
};

/// Lower and upper end of an axis: its range when that is given; else the least and greatest of
/// `values` that can be drawn, with 5 % of their distance (of its logarithm on a logarithmic axis)
/// on either side, and half a unit (a factor of 2) when they are equal or there is none.
[[nodiscard]] std::array<double, 2> axis_ends(const ChartAxis& axis,
                                              const std::vector<double>& values);

/// Round places of a logarithmic axis with their labels: powers of ten, and 2 and 5 times those
/// when the ends are less than a factor of 1000 apart.
[[nodiscard]] std::vector<std::pair<double, std::string>> logarithmic_ticks(double lower,
                                                                            double upper);

/// Puts a chart into one of VTK that has nothing in it yet, for windows that are open.
/// @param text_scale  Of the sizes of letters; draw_charts() has 1.
void fill_chart(vtkChartXY* view, const Chart& chart, double text_scale = 1.0);

/// Draws charts with VTK in a child process, as draw_png() does.
/// @return PNG bytes.
/// @throws std::invalid_argument  there is no chart; a size or the number of columns is out of
///         range; a range is empty, not finite or not positive on a logarithmic axis; bars on a
///         logarithmic axis.
/// @throws PictureError  no display works.
[[nodiscard]] std::string draw_charts(const std::vector<Chart>& charts, const ChartPage& page = {});

}  // namespace shape3d::apps
