#include <algorithm>
#include <cmath>

#include "common/chart.hpp"
#include "common/slice_picture.hpp"
#include "common/text.hpp"
#include "segment_result.hpp"

namespace shape3d::apps {
namespace {

constexpr Color kBlue{0.1, 0.35, 0.9}, kRed{0.85, 0.1, 0.1}, kGreen{0.1, 0.5, 0.25},
    kOrange{0.85, 0.5, 0.1}, kGrey{0.7, 0.74, 0.8};

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

Plot histogram_plot(const levelset::Segmentation& s) {
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
  return {"histogram.png", draw_charts({chart})};
}

Plot overlap_plot(const levelset::Segmentation& s) {
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
  mark("calibrated: w = " + rounded(s.calibration.w), s.calibration.lambda, kGreen);
  chart.legend = LegendPlace::bottom_right;
  return {"overlap.png", draw_charts({chart})};
}

// The middles of six equal parts along z of what is inside, or of the region.
std::vector<std::int64_t> slices_of(const SegmentResult& result) {
  const Mask& mask = result.mask;
  const std::int64_t plane = mask.dims[0] * mask.dims[1];
  std::int64_t first = mask.dims[2], last = -1;
  for (std::int64_t k = 0; k < mask.dims[2]; ++k) {
    const auto begin = mask.samples.begin() + k * plane;
    if (std::find(begin, begin + plane, 1) == begin + plane) continue;
    first = std::min(first, k);
    last = k;
  }
  if (last < 0) {
    first = 0;
    last = mask.dims[2] - 1;
  }
  std::vector<std::int64_t> slices;
  constexpr int kSlices = 6;
  for (int n = 0; n < kSlices; ++n) {
    const std::int64_t slice =
        first +
        static_cast<std::int64_t>((n + 0.5) / kSlices * static_cast<double>(last - first + 1));
    if (slices.empty() || slices.back() != slice) slices.push_back(slice);
  }
  return slices;
}

// Between the first and the last hundredth of the intensities.
std::array<double, 2> window_of(const levelset::Histogram& histogram) {
  const double total = histogram.total();
  std::array<double, 2> window{histogram.minimum, histogram.maximum};
  double sum = 0.0;
  for (int b = 0; b < histogram.bins(); ++b) {
    if (sum < 0.01 * total) window[0] = histogram.center(b);
    if (sum < 0.99 * total) window[1] = histogram.center(b);
    sum += histogram.counts[b];
  }
  if (!(window[0] < window[1])) window = {histogram.minimum, histogram.maximum};
  return window;
}

Plot slices_plot(const SegmentResult& result) {
  const auto [black, white] = window_of(result.segmentation.histogram);
  std::vector<std::uint8_t> truth;
  zmc::VolumeView truth_view = result.roi;
  if (result.truth) {
    truth_view.data = result.truth->samples.data();
    truth_view.type = zmc::SampleType::uint8;
    truth_view.strides = {0, 0, 0};
  }
  std::vector<SlicePanel> panels;
  for (const std::int64_t slice : slices_of(result)) {
    SlicePanel panel;
    panel.title = "z = " + std::to_string(slice + result.region.lower[2]);
    panel.volume = result.roi;
    panel.slice = slice;
    panel.black = black;
    panel.white = white;
    if (result.truth)
      panel.outlines.push_back(
          {"truth", kRed, outline_of(result.roi, truth_view, 0.5, panel.axis, slice)});
    panel.outlines.push_back(
        {"segmentation", kBlue, outline_of(result.roi, result.psi, 0.0, panel.axis, slice)});
    panels.push_back(std::move(panel));
  }
  return {"slices.png", draw_slices(panels)};
}

}  // namespace

std::vector<Plot> plot_segmentation(const SegmentResult& result) {
  std::vector<Plot> plots{histogram_plot(result.segmentation)};
  if (!result.segmentation.calibration.curve.empty())
    plots.push_back(overlap_plot(result.segmentation));
  plots.push_back(slices_plot(result));
  return plots;
}

}  // namespace shape3d::apps
