#include <algorithm>
#include <array>
#include <stdexcept>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include "common/chart.hpp"
#include "common/raster.hpp"
#include "show_parts.hpp"

namespace shape3d::apps {
namespace {

constexpr int kPanelWidth = 480, kPanelHeight = 420, kChartHeight = 420, kHeadHeight = 44;

Raster raster_of(const std::string& png) {
  vtkNew<vtkPNGReader> reader;
  reader->SetMemoryBuffer(png.data());
  reader->SetMemoryBufferLength(static_cast<vtkIdType>(png.size()));
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  const int* dims = image->GetDimensions();
  const int components = image->GetNumberOfScalarComponents();
  Raster raster = make_raster(dims[0], dims[1], {1, 1, 1});
  const auto* bytes = static_cast<const unsigned char*>(image->GetScalarPointer());
  for (int y = 0; y < dims[1]; ++y) {
    for (int x = 0; x < dims[0]; ++x) {
      // VTK's rows run upwards.
      const std::ptrdiff_t from =
          (static_cast<std::ptrdiff_t>(dims[1] - 1 - y) * dims[0] + x) * components;
      const std::size_t to = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(dims[0]) +
                                  static_cast<std::size_t>(x));
      for (int c = 0; c < 3; ++c) {
        raster.rgb[to + static_cast<std::size_t>(c)] = bytes[from + (components < 3 ? 0 : c)];
      }
    }
  }
  return raster;
}

std::string draw_bars(const Eigen::VectorXd& vector, int width) {
  ChartSeries bars;
  bars.kind = ChartSeries::Kind::bars;
  bars.bar_width = vector.size() > 200 ? 1.0 : 0.8;
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    bars.points.push_back({static_cast<double>(i), vector[i]});
  }
  Chart chart;
  chart.title = std::to_string(vector.size()) + " numbers";
  chart.x.title = "number of the element";
  chart.x.range = {-0.6, static_cast<double>(vector.size()) - 0.4};
  chart.y.title = "value";
  chart.legend = LegendPlace::none;
  chart.series.push_back(bars);
  ChartPage page;
  page.width = width;
  page.height = kChartHeight;
  return draw_charts({chart}, page);
}

}  // namespace

std::string draw_shown(const ShownParts& parts, const descriptors::Descriptor& descriptor,
                       const Eigen::VectorXd& vector) {
  // One row of up to three, or two rows.
  const int count = static_cast<int>(parts.panels.size());
  const int columns = count <= 3 ? count : (count + 1) / 2;
  const int rows = (count + columns - 1) / columns;
  const int width = std::max(3, columns) * kPanelWidth;
  PictureOptions options;
  options.width = columns * kPanelWidth;
  options.height = rows * kPanelHeight;
  const Raster panels = raster_of(draw_panels(parts.panels, options, columns));
  const Raster bars = raster_of(draw_bars(vector, width));

  Raster page = make_raster(width, kHeadHeight + panels.height + bars.height, {1, 1, 1});
  // A long description in as small a size as it needs.
  const std::string spec = descriptor.to_string();
  int size = 22;
  while (size > 9 && text_width(spec, size) > width - 20) --size;
  draw_text(page, spec, width / 2, 29, size, TextAlign::centre);
  paste(page, panels, (width - panels.width) / 2, kHeadHeight);
  paste(page, bars, 0, kHeadHeight + panels.height);
  return to_png(page);
}

}  // namespace shape3d::apps
