#include "growth_plot.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPen.h>
#include <vtkPlot.h>
#include <vtkPlotPoints.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include "common/private_display.hpp"
#include "statistics.hpp"

namespace shape3d::bench {
namespace {

struct Line {
  std::string label;
  std::array<double, 3> color;
  int marker, pen;
  std::vector<std::array<double, 2>> points;  ///< Millions of triangles, seconds.
};

std::vector<Line> lines(const std::vector<VolumeResult>& results) {
  std::vector<Line> lines{
      {"dissertation, ZMC", {0.35, 0.35, 0.35}, vtkPlotPoints::SQUARE, vtkPen::DASH_LINE, {}},
      {"dissertation, Lewiner's MC",
       {0.6, 0.6, 0.6},
       vtkPlotPoints::CIRCLE,
       vtkPen::DASH_LINE,
       {}}};
  for (const CtSize& size : kCtSizes) {
    lines[0].points.push_back({size.zmc_triangles, size.zmc_seconds});
    lines[1].points.push_back({size.mc_triangles, size.mc_seconds});
  }
  struct Style {
    Method method;
    int threads;
    std::array<double, 3> color;
    int marker, pen;
  };
  const Style styles[] = {
      {Method::lewiner, 1, {0.75, 0.45, 0.1}, vtkPlotPoints::CIRCLE, vtkPen::SOLID_LINE},
      {Method::marching_cubes, 1, {0.55, 0.3, 0.65}, vtkPlotPoints::DIAMOND, vtkPen::SOLID_LINE},
      {Method::flying_edges, 1, {0.8, 0.15, 0.15}, vtkPlotPoints::PLUS, vtkPen::SOLID_LINE},
      {Method::flying_edges, 2, {0.8, 0.15, 0.15}, vtkPlotPoints::PLUS, vtkPen::DOT_LINE},
      {Method::zmc_compact, 1, {0.1, 0.35, 0.75}, vtkPlotPoints::SQUARE, vtkPen::SOLID_LINE},
      {Method::zmc_compact, 2, {0.1, 0.35, 0.75}, vtkPlotPoints::SQUARE, vtkPen::DOT_LINE},
      {Method::zmc_compact_reused, 1, {0.1, 0.6, 0.45}, vtkPlotPoints::SQUARE, vtkPen::SOLID_LINE},
      {Method::zmc_compact_reused, 2, {0.1, 0.6, 0.45}, vtkPlotPoints::SQUARE, vtkPen::DOT_LINE}};
  for (const Style& style : styles) {
    Line line{to_string(style.method) + (style.threads == 1 ? ", 1 thread" : ", 2 threads"),
              style.color,
              style.marker,
              style.pen,
              {}};
    for (const VolumeResult& r : results) {
      const SubjectResult* s = r.find(style.method, style.threads);
      if (r.published == nullptr || s == nullptr) continue;
      line.points.push_back({static_cast<double>(s->last.triangles) / 1e6, spread(s->wall).median});
    }
    if (!line.points.empty()) lines.push_back(line);
  }
  return lines;
}

void add(vtkChartXY* chart, const Line& line) {
  vtkNew<vtkTable> table;
  vtkNew<vtkDoubleArray> x, y;
  x->SetName("triangles");
  y->SetName(line.label.c_str());
  for (const std::array<double, 2>& point : line.points) {
    x->InsertNextValue(point[0]);
    y->InsertNextValue(point[1]);
  }
  table->AddColumn(x);
  table->AddColumn(y);
  auto* plot = vtkPlotPoints::SafeDownCast(chart->AddPlot(vtkChart::LINE));
  plot->SetInputData(table, 0, 1);
  plot->SetLabel(line.label);
  plot->SetColor(line.color[0], line.color[1], line.color[2]);
  plot->SetWidth(2.5F);
  plot->GetPen()->SetLineType(line.pen);
  plot->SetMarkerStyle(line.marker);
  plot->SetMarkerSize(10);
}

void set_axis(vtkAxis* axis, const char* title, double least, double most,
              const std::vector<double>& ticks, const char* format) {
  axis->SetTitle(title);
  axis->GetTitleProperties()->SetFontSize(20);
  axis->GetLabelProperties()->SetFontSize(18);
  axis->LogScaleOn();
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetUnscaledRange(least, most);
  vtkNew<vtkDoubleArray> places;
  vtkNew<vtkStringArray> labels;
  for (const double tick : ticks) {
    char text[32];
    std::snprintf(text, sizeof text, format, tick);
    places->InsertNextValue(std::log10(tick));  // places on a logarithmic axis
    labels->InsertNextValue(text);
  }
  axis->SetCustomTickPositions(places, labels);
}

}  // namespace

std::string growth_plot(const std::vector<VolumeResult>& results) {
  const apps::PrivateDisplay display;
  setenv("DISPLAY", display.name().c_str(), 1);
  vtkNew<vtkContextView> view;
  view->GetRenderWindow()->SetOffScreenRendering(1);
  view->GetRenderWindow()->SetSize(1200, 850);
  view->GetRenderer()->SetBackground(1, 1, 1);
  vtkNew<vtkChartXY> chart;
  view->GetScene()->AddItem(chart);
  for (const Line& line : lines(results)) add(chart, line);
  set_axis(chart->GetAxis(vtkAxis::BOTTOM), "triangles, millions", 0.25, 14,
           {0.3, 0.5, 1, 2, 3, 5, 10}, "%g");
  set_axis(chart->GetAxis(vtkAxis::LEFT), "seconds", 0.002, 20,
           {0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10}, "%g");
  chart->SetShowLegend(true);
  chart->GetLegend()->SetHorizontalAlignment(vtkChartLegend::LEFT);
  chart->GetLegend()->SetVerticalAlignment(vtkChartLegend::TOP);
  chart->GetLegend()->SetLabelSize(16);
  view->GetRenderWindow()->SetMultiSamples(8);
  view->Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(view->GetRenderWindow());
  image->ReadFrontBufferOff();
  vtkNew<vtkPNGWriter> writer;
  writer->WriteToMemoryOn();
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)),
          static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

}  // namespace shape3d::bench
