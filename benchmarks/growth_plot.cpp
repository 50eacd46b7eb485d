#include "growth_plot.hpp"

#include "common/chart.hpp"
#include "statistics.hpp"

namespace shape3d::bench {
namespace {

using apps::ChartSeries;
using Marker = ChartSeries::Marker;
using Pattern = ChartSeries::Pattern;

ChartSeries line(const std::string& label, const apps::Color& color, Marker marker,
                 Pattern pattern) {
  ChartSeries series;
  series.label = label;
  series.color = color;
  series.marker = marker;
  series.pattern = pattern;
  return series;
}

// x in millions of triangles, y in seconds.
std::vector<ChartSeries> lines(const std::vector<VolumeResult>& results) {
  std::vector<ChartSeries> lines{
      line("dissertation, ZMC", {0.35, 0.35, 0.35}, Marker::square, Pattern::dashed),
      line("dissertation, Lewiner's MC", {0.6, 0.6, 0.6}, Marker::circle, Pattern::dashed)};
  for (const CtSize& size : kCtSizes) {
    lines[0].points.push_back({size.zmc_triangles, size.zmc_seconds});
    lines[1].points.push_back({size.mc_triangles, size.mc_seconds});
  }
  struct Style {
    Method method;
    int threads;
    apps::Color color;
    Marker marker;
    Pattern pattern;
  };
  const Style styles[] = {
      {Method::lewiner, 1, {0.75, 0.45, 0.1}, Marker::circle, Pattern::solid},
      {Method::marching_cubes, 1, {0.55, 0.3, 0.65}, Marker::diamond, Pattern::solid},
      {Method::flying_edges, 1, {0.8, 0.15, 0.15}, Marker::plus, Pattern::solid},
      {Method::flying_edges, 2, {0.8, 0.15, 0.15}, Marker::plus, Pattern::dotted},
      {Method::zmc_compact, 1, {0.1, 0.35, 0.75}, Marker::square, Pattern::solid},
      {Method::zmc_compact, 2, {0.1, 0.35, 0.75}, Marker::square, Pattern::dotted},
      {Method::zmc_compact_reused, 1, {0.1, 0.6, 0.45}, Marker::square, Pattern::solid},
      {Method::zmc_compact_reused, 2, {0.1, 0.6, 0.45}, Marker::square, Pattern::dotted}};
  for (const Style& style : styles) {
    ChartSeries series =
        line(to_string(style.method) + (style.threads == 1 ? ", 1 thread" : ", 2 threads"),
             style.color, style.marker, style.pattern);
    for (const VolumeResult& r : results) {
      const SubjectResult* s = r.find(style.method, style.threads);
      if (r.published == nullptr || s == nullptr) continue;
      series.points.push_back(
          {static_cast<double>(s->last.triangles) / 1e6, spread(s->wall).median});
    }
    if (!series.points.empty()) lines.push_back(series);
  }
  return lines;
}

}  // namespace

std::string growth_plot(const std::vector<VolumeResult>& results) {
  apps::Chart chart;
  chart.series = lines(results);
  chart.x.title = "triangles, millions";
  chart.x.logarithmic = true;
  chart.x.range = {{0.25, 14}};
  chart.x.ticks = {{0.3, "0.3"}, {0.5, "0.5"}, {1, "1"}, {2, "2"}, {3, "3"}, {5, "5"}, {10, "10"}};
  chart.y.title = "seconds";
  chart.y.logarithmic = true;
  chart.y.range = {{0.002, 20}};
  chart.y.ticks = {{0.003, "0.003"}, {0.01, "0.01"}, {0.03, "0.03"}, {0.1, "0.1"},
                   {0.3, "0.3"},     {1, "1"},       {3, "3"},       {10, "10"}};
  chart.legend = apps::LegendPlace::top_left;
  apps::ChartPage page;
  page.width = 1200;
  page.height = 850;
  page.private_display = true;
  return apps::draw_charts({chart}, page);
}

}  // namespace shape3d::bench
