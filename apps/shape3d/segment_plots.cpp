#include <algorithm>
#include <cmath>

#include "common/chart.hpp"
#include "common/segmentation_charts.hpp"
#include "common/slice_picture.hpp"
#include "common/text.hpp"
#include "segment_result.hpp"

namespace shape3d::apps {
namespace {

constexpr Color kBlue{0.1, 0.35, 0.9}, kRed{0.85, 0.1, 0.1};

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
  std::vector<Plot> plots{{"histogram.png", draw_charts({histogram_chart(result.segmentation)})}};
  if (!result.segmentation.calibration.curve.empty())
    plots.push_back({"overlap.png", draw_charts({overlap_chart(result.segmentation)})});
  plots.push_back(slices_plot(result));
  return plots;
}

}  // namespace shape3d::apps
