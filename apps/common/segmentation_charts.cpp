#include "segmentation_charts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace shape3d::apps {
namespace {

constexpr Color kBlue{0.1, 0.35, 0.9}, kRed{0.85, 0.1, 0.1}, kGreen{0.1, 0.5, 0.25},
    kOrange{0.85, 0.5, 0.1}, kGrey{0.7, 0.74, 0.8};

std::string four_digits(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", number);
  return text;
}

// Bins joined to at most 256, so that bars are wider than a pixel.
ChartSeries histogram_bars(const levelset::Histogram& histogram) {
  ChartSeries series;
  series.label = "histogram H";
  series.kind = ChartSeries::Kind::bars;
  series.color = kGrey;
  const int joined = std::max(1, (histogram.bins() + 255) / 256);
  series.bar_width = joined * histogram.bin_width;
  const Eigen::ArrayXd density = histogram.density();
  for (int b = 0; b < histogram.bins(); b += joined) {
    const int n = std::min(joined, histogram.bins() - b);
    series.points.push_back({histogram.lower + (b + 0.5 * joined) * histogram.bin_width,
                             density.segment(b, n).sum() / joined});
  }
  return series;
}

template <class Density>
ChartSeries curve(const std::string& label, const Color& color,
                  const levelset::Histogram& histogram, const Density& density) {
  ChartSeries series;
  series.label = label;
  series.color = color;
  constexpr int kPoints = 800;
  for (int n = 0; n <= kPoints; ++n) {
    const double u =
        histogram.minimum + (histogram.maximum - histogram.minimum) * n / double{kPoints};
    series.points.push_back({u, density(u)});
  }
  return series;
}

}  // namespace

Chart histogram_chart(const levelset::Segmentation& s) {
  Chart chart;
  chart.title = "Intensities of the region and their mixture of " +
                std::to_string(s.fit.mixture.size()) + " Gaussians";
  chart.x.title = "intensity";
  chart.y.title = "density";
  chart.series = {
      histogram_bars(s.histogram),
      curve("mixture P", kRed, s.histogram, [&](double u) { return s.fit.mixture.density(u); }),
      curve("inside", kBlue, s.histogram, [&](double u) { return s.model.density_inside(u); }),
      curve("outside", kOrange, s.histogram, [&](double u) { return s.model.density_outside(u); })};
  chart.series[1].width = 3.0;
  for (std::size_t n = 2; n < 4; ++n) chart.series[n].pattern = ChartSeries::Pattern::dashed;
  for (const double level : s.model.levels(0.0))
    chart.markers.push_back({"level as estimated", level, {0.4, 0.4, 0.4}, {}});
  for (const double level : s.calibration.levels)
    chart.markers.push_back({"level calibrated", level, kGreen, ChartSeries::Pattern::dashed});
  return chart;
}

Chart overlap_chart(const levelset::Segmentation& s) {
  Chart chart;
  chart.title = "Overlap of the gradient with the boundary";
  chart.y.title = "S(w)";
  ChartSeries series;
  series.marker = ChartSeries::Marker::circle;
  series.color = kBlue;
  series.label = "S";
  // By intensity where each offset has one; that axis says more than w, which is near ±1.
  const bool levels = std::all_of(
      s.calibration.curve.begin(), s.calibration.curve.end(),
      [](const levelset::OverlapSample& sample) { return std::isfinite(sample.level); });
  chart.x.title = levels ? "boundary intensity" : "offset as log-odds, −2 artanh w";
  for (const levelset::OverlapSample& sample : s.calibration.curve)
    series.points.push_back({levels ? sample.level : sample.lambda, sample.overlap});
  std::sort(series.points.begin(), series.points.end());
  chart.series = {series};
  const auto mark = [&](const std::string& label, double lambda, const Color& color) {
    if (!levels) {
      chart.markers.push_back({label, lambda, color, ChartSeries::Pattern::dashed});
      return;
    }
    for (const double level : s.model.levels(lambda))
      chart.markers.push_back({label, level, color, ChartSeries::Pattern::dashed});
  };
  mark("w = 0, as estimated", 0.0, {0.4, 0.4, 0.4});
  mark("calibrated: w = " + four_digits(s.calibration.w), s.calibration.lambda, kGreen);
  chart.legend = LegendPlace::bottom;  // below the curve's maximum
  return chart;
}

}  // namespace shape3d::apps
