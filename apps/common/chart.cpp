#include "chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlot.h>
#include <vtkPlotArea.h>
#include <vtkPlotPoints.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include "offscreen.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

constexpr int kTitleSize = 24, kAxisTitleSize = 21, kLabelSize = 18, kLegendSize = 17;

bool drawable(const ChartAxis& axis, double value) {
  return std::isfinite(value) && (!axis.logarithmic || value > 0.0);
}

struct Ends {
  std::array<double, 2> x, y;
};

Ends ends_of(const Chart& chart) {
  std::vector<double> x, y;
  for (const ChartSeries& series : chart.series) {
    const double half = series.kind == ChartSeries::Kind::bars ? series.bar_width / 2 : 0.0;
    for (const auto& point : series.points) {
      x.insert(x.end(), {point[0] - half, point[0] + half});
      y.push_back(point[1]);
    }
    if (series.kind == ChartSeries::Kind::bars) y.push_back(0.0);
  }
  for (const ChartBand& band : chart.bands) {
    for (const auto& point : band.points) {
      x.push_back(point[0]);
      y.insert(y.end(), {point[1], point[2]});
    }
  }
  for (const ChartMarker& marker : chart.markers) x.push_back(marker.x);
  Ends ends{axis_ends(chart.x, x), axis_ends(chart.y, y)};
  const bool bars =
      std::any_of(chart.series.begin(), chart.series.end(),
                  [](const ChartSeries& series) { return series.kind == ChartSeries::Kind::bars; });
  // Bars stand on the axis.
  if (bars && !chart.y.range && *std::min_element(y.begin(), y.end()) >= 0.0) ends.y[0] = 0.0;
  return ends;
}

vtkSmartPointer<vtkTable> table_of(const std::string& label, std::size_t columns) {
  auto table = vtkSmartPointer<vtkTable>::New();
  for (std::size_t c = 0; c < columns; ++c) {
    vtkNew<vtkDoubleArray> column;
    const std::string name = c == 0 ? "x" : c == 1 ? label : "upper";
    column->SetName(name.empty() ? "y" : name.c_str());
    table->AddColumn(column);
  }
  return table;
}

void append(vtkTable* table, std::initializer_list<double> row) {
  vtkIdType c = 0;
  for (const double value : row) {
    vtkDoubleArray::SafeDownCast(table->GetColumn(c++))->InsertNextValue(value);
  }
}

int pen_type(ChartSeries::Pattern pattern) {
  switch (pattern) {
    case ChartSeries::Pattern::solid:
      return vtkPen::SOLID_LINE;
    case ChartSeries::Pattern::dashed:
      return vtkPen::DASH_LINE;
    case ChartSeries::Pattern::dotted:
      return vtkPen::DOT_LINE;
  }
  return vtkPen::SOLID_LINE;
}

int marker_style(ChartSeries::Marker marker) {
  switch (marker) {
    case ChartSeries::Marker::none:
      return vtkPlotPoints::NONE;
    case ChartSeries::Marker::circle:
      return vtkPlotPoints::CIRCLE;
    case ChartSeries::Marker::square:
      return vtkPlotPoints::SQUARE;
    case ChartSeries::Marker::diamond:
      return vtkPlotPoints::DIAMOND;
    case ChartSeries::Marker::plus:
      return vtkPlotPoints::PLUS;
    case ChartSeries::Marker::cross:
      return vtkPlotPoints::CROSS;
  }
  return vtkPlotPoints::NONE;
}

void name_plot(vtkPlot* plot, const std::string& label) {
  plot->SetLabel(label);
  plot->SetLegendVisibility(!label.empty());
}

void add_area(vtkChartXY* chart, const std::string& label, const Color& color, double opacity,
              vtkTable* table) {
  auto* area = vtkPlotArea::SafeDownCast(chart->AddPlot(vtkChart::AREA));
  area->SetInputData(table);
  area->SetInputArray(0, "x");
  area->SetInputArray(1, table->GetColumnName(1));
  area->SetInputArray(2, "upper");
  name_plot(area, label);
  area->GetBrush()->SetColorF(color[0], color[1], color[2], opacity);
}

// Runs of points that can be drawn, each as a line of its own; the first has the legend.
void add_line(vtkChartXY* view, const Chart& chart, const ChartSeries& series) {
  vtkSmartPointer<vtkTable> table = table_of(series.label, 2);
  std::string label = series.label;
  const auto end_run = [&] {
    if (table->GetNumberOfRows() == 0) return;
    // A plot needs two points.
    if (table->GetNumberOfRows() == 1) {
      append(table, {table->GetValue(0, 0).ToDouble(), table->GetValue(0, 1).ToDouble()});
    }
    const bool points = series.kind == ChartSeries::Kind::points;
    auto* plot =
        vtkPlotPoints::SafeDownCast(view->AddPlot(points ? vtkChart::POINTS : vtkChart::LINE));
    plot->SetInputData(table, 0, 1);
    name_plot(plot, label);
    plot->SetColor(series.color[0], series.color[1], series.color[2]);
    plot->SetWidth(static_cast<float>(series.width));
    plot->GetPen()->SetLineType(pen_type(series.pattern));
    const bool round = points && series.marker == ChartSeries::Marker::none;
    plot->SetMarkerStyle(round ? vtkPlotPoints::CIRCLE : marker_style(series.marker));
    plot->SetMarkerSize(10);
    label.clear();
    table = table_of(series.label, 2);
  };
  for (const auto& point : series.points) {
    if (drawable(chart.x, point[0]) && drawable(chart.y, point[1])) {
      append(table, {point[0], point[1]});
    } else if (series.kind == ChartSeries::Kind::line) {
      end_run();
    }
  }
  end_run();
}

// Each bar is two steps of an outline that is filled down to the axis: a bar plot of VTK takes the
// width of the first two points and clips the outer bars.
void add_bars(vtkChartXY* view, const Chart& chart, const ChartSeries& series, double floor) {
  std::vector<std::array<double, 2>> bars;
  for (const auto& point : series.points) {
    if (drawable(chart.x, point[0]) && drawable(chart.y, point[1])) bars.push_back(point);
  }
  std::sort(bars.begin(), bars.end());
  const vtkSmartPointer<vtkTable> table = table_of(series.label, 3);
  const double half = series.bar_width / 2;
  for (const auto& bar : bars) {
    append(table, {bar[0] - half, floor, floor});
    append(table, {bar[0] - half, floor, bar[1]});
    append(table, {bar[0] + half, floor, bar[1]});
    append(table, {bar[0] + half, floor, floor});
  }
  if (!bars.empty()) add_area(view, series.label, series.color, 1.0, table);
}

void add_band(vtkChartXY* view, const Chart& chart, const ChartBand& band) {
  const vtkSmartPointer<vtkTable> table = table_of(band.label, 3);
  for (const auto& point : band.points) {
    if (drawable(chart.x, point[0]) && drawable(chart.y, point[1]) && drawable(chart.y, point[2]))
      append(table, {point[0], point[1], point[2]});
  }
  // VTK draws an area from three rows on.
  if (table->GetNumberOfRows() == 2) {
    const auto last = [&](vtkIdType column) { return table->GetValue(1, column).ToDouble(); };
    append(table, {last(0), last(1), last(2)});
  }
  if (table->GetNumberOfRows() > 1) add_area(view, band.label, band.color, band.opacity, table);
}

int scaled(int size, double scale) { return static_cast<int>(std::lround(size * scale)); }

void set_axis(vtkAxis* axis, const ChartAxis& wish, const std::array<double, 2>& ends,
              double text_scale) {
  axis->SetTitle(wish.title);
  axis->GetTitleProperties()->SetFontSize(scaled(kAxisTitleSize, text_scale));
  axis->GetTitleProperties()->BoldOff();
  axis->GetLabelProperties()->SetFontSize(scaled(kLabelSize, text_scale));
  axis->SetLogScale(wish.logarithmic);
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetUnscaledRange(ends[0], ends[1]);
  axis->GetGridPen()->SetColorF(0.9, 0.9, 0.9);
  std::vector<std::pair<double, std::string>> ticks = wish.ticks;
  if (ticks.empty() && wish.logarithmic) ticks = logarithmic_ticks(ends[0], ends[1]);
  if (ticks.empty()) return;
  vtkNew<vtkDoubleArray> places;
  vtkNew<vtkStringArray> labels;
  for (const auto& [place, label] : ticks) {
    if (place < ends[0] || place > ends[1]) continue;
    places->InsertNextValue(wish.logarithmic ? std::log10(place) : place);
    labels->InsertNextValue(label);
  }
  axis->SetCustomTickPositions(places, labels);
}

void set_legend(vtkChartXY* chart, LegendPlace place, double text_scale) {
  chart->SetShowLegend(place != LegendPlace::none);
  vtkChartLegend* legend = chart->GetLegend();
  const bool left = place == LegendPlace::top_left || place == LegendPlace::bottom_left;
  const bool top = place == LegendPlace::top_left || place == LegendPlace::top_right;
  legend->SetHorizontalAlignment(left                           ? vtkChartLegend::LEFT
                                 : place == LegendPlace::bottom ? vtkChartLegend::CENTER
                                                                : vtkChartLegend::RIGHT);
  legend->SetVerticalAlignment(top ? vtkChartLegend::TOP : vtkChartLegend::BOTTOM);
  legend->SetLabelSize(scaled(kLegendSize, text_scale));
  legend->SetPadding(8);
}

std::string draw(const std::vector<Chart>& charts, const ChartPage& page) {
  const int columns = std::min(page.columns, static_cast<int>(charts.size()));
  const int rows = (static_cast<int>(charts.size()) + columns - 1) / columns;
  vtkNew<vtkContextView> view;
  view->GetRenderWindow()->SetOffScreenRendering(1);
  view->GetRenderWindow()->SetSize(columns * page.width, rows * page.height);
  view->GetRenderWindow()->SetMultiSamples(8);
  view->GetRenderer()->SetBackground(1, 1, 1);
  for (std::size_t n = 0; n < charts.size(); ++n) {
    const int column = static_cast<int>(n) % columns, row = static_cast<int>(n) / columns;
    vtkNew<vtkChartXY> chart;
    chart->SetAutoSize(false);
    constexpr float kGap = 12.0F;  // pixels between neighbours
    chart->SetSize(vtkRectf(static_cast<float>(column * page.width) + kGap,
                            static_cast<float>((rows - 1 - row) * page.height) + kGap,
                            static_cast<float>(page.width) - 2 * kGap,
                            static_cast<float>(page.height) - 2 * kGap));
    fill_chart(chart, charts[n]);
    view->GetScene()->AddItem(chart);
  }
  view->Render();
  return png_of(view->GetRenderWindow());
}

void require(bool condition, const std::string& sentence) {
  if (!condition) throw std::invalid_argument(sentence);
}

void validate(const ChartAxis& axis, const std::string& name) {
  if (!axis.range) return;
  const auto [lower, upper] = *axis.range;
  const bool fits = drawable(axis, lower) && drawable(axis, upper) && lower < upper;
  require(fits, "range of the " + name + " axis is " + to_text(lower) + " … " + to_text(upper) +
                    "; expected growing " + (axis.logarithmic ? "positive" : "finite") +
                    " numbers");
}

void validate(const std::vector<Chart>& charts, const ChartPage& page) {
  require(!charts.empty(), "charts is empty; expected one or more");
  require(page.columns >= 1 && page.columns <= 16,
          "columns is " + std::to_string(page.columns) + "; expected 1 to 16");
  const auto rows = (static_cast<std::int64_t>(charts.size()) + page.columns - 1) / page.columns;
  for (const auto& [name, pixels, count] :
       {std::tuple{"width", page.width, std::int64_t{page.columns}},
        std::tuple{"height", page.height, rows}}) {
    require(pixels >= 64 && pixels <= 8192 && pixels * count <= 16384,
            std::string(name) + " is " + std::to_string(pixels) + " pixels for each of " +
                std::to_string(count) + " charts; expected 64 to 8192, and at most 16384 in all");
  }
  for (const Chart& chart : charts) {
    validate(chart.x, "x");
    validate(chart.y, "y");
    for (const ChartSeries& series : chart.series) {
      require(
          series.kind != ChartSeries::Kind::bars || !(chart.x.logarithmic || chart.y.logarithmic),
          "bars of series \"" + series.label +
              "\" stand on a logarithmic axis; expected linear axes");
    }
  }
}

}  // namespace

void fill_chart(vtkChartXY* view, const Chart& chart, double text_scale) {
  const Ends ends = ends_of(chart);
  for (const ChartBand& band : chart.bands) add_band(view, chart, band);
  for (const ChartSeries& series : chart.series) {
    if (series.kind == ChartSeries::Kind::bars) {
      add_bars(view, chart, series, ends.y[0]);
    } else {
      add_line(view, chart, series);
    }
  }
  for (const ChartMarker& marker : chart.markers) {
    ChartSeries line;
    line.label = marker.label;
    line.points = {{marker.x, ends.y[0]}, {marker.x, ends.y[1]}};
    line.color = marker.color;
    line.pattern = marker.pattern;
    add_line(view, chart, line);
  }
  view->SetTitle(chart.title);
  view->GetTitleProperties()->SetFontSize(scaled(kTitleSize, text_scale));
  set_axis(view->GetAxis(vtkAxis::BOTTOM), chart.x, ends.x, text_scale);
  set_axis(view->GetAxis(vtkAxis::LEFT), chart.y, ends.y, text_scale);
  set_legend(view, chart.legend, text_scale);
}

std::array<double, 2> axis_ends(const ChartAxis& axis, const std::vector<double>& values) {
  if (axis.range) return *axis.range;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double value : values) {
    if (!drawable(axis, value)) continue;
    const double scaled = axis.logarithmic ? std::log10(value) : value;
    least = std::min(least, scaled);
    most = std::max(most, scaled);
  }
  if (!(least <= most)) least = most = 0.0;
  constexpr double kMargin = 0.05;
  const double single = axis.logarithmic ? std::log10(2.0) : 0.5;
  const double margin = most > least ? kMargin * (most - least) : single;
  const std::array<double, 2> ends{least - margin, most + margin};
  if (!axis.logarithmic) return ends;
  return {std::pow(10.0, ends[0]), std::pow(10.0, ends[1])};
}

std::vector<std::pair<double, std::string>> logarithmic_ticks(double lower, double upper) {
  std::vector<std::pair<double, std::string>> ticks;
  const bool fine = upper < 1000.0 * lower;
  for (int power = static_cast<int>(std::floor(std::log10(lower)));
       power <= static_cast<int>(std::ceil(std::log10(upper))); ++power) {
    for (const int digit : {1, 2, 5}) {
      if (digit != 1 && !fine) continue;
      // The nearest double to the decimal, for its label.
      const double place = *parse_real(std::to_string(digit) + "e" + std::to_string(power));
      if (place >= lower && place <= upper) ticks.emplace_back(place, to_text(place));
    }
  }
  return ticks;
}

std::string draw_charts(const std::vector<Chart>& charts, const ChartPage& page) {
  validate(charts, page);
  return draw_offscreen([&] { return draw(charts, page); }, page.private_display);
}

}  // namespace shape3d::apps
