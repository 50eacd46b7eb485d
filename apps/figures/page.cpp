#include "page.hpp"

#include <cmath>
#include <cstdlib>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkGlyph3D.h>
#include <vtkImageShrink3D.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSMPTools.h>
#include <vtkSphereSource.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTubeFilter.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include "common/child_process.hpp"
#include "common/private_display.hpp"

namespace shape3d::apps {
namespace {

constexpr int kSamples = 2;  // a pixel is the mean of kSamples² rendered ones
constexpr double kDepth = 2000.0;

vtkProperty* add_actor(vtkRenderer* renderer, vtkAlgorithm* source, const Color& color) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->SetColor(color[0], color[1], color[2]);
  property->SetAmbient(0.35);
  property->SetDiffuse(0.65);
  renderer->AddActor(actor);
  return property;
}

void add_light(vtkRenderer* renderer, double x, double y, double z, double intensity) {
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(x, y, z);
  light->SetFocalPoint(0, 0, 0);
  light->SetIntensity(intensity);
  renderer->AddLight(light);
}

vtkIdType add_point(vtkPoints* points, const Eigen::Vector3d& p) {
  return points->InsertNextPoint(p.data());
}

}  // namespace

void Page::triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                    const Color& front, const Color& back, double opacity) {
  triangles_[{front, back, opacity}].push_back({a, b, c});
}

void Page::rod(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
               const Color& color) {
  rods_[{radius, color}].push_back({a, b});
}

void Page::broken_rod(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
                      const Color& color) {
  const int pieces = std::max(2, static_cast<int>((b - a).norm() / (8.0 * radius)));
  for (int i = 0; i < pieces; ++i) {
    const double from = (i + 0.25) / pieces, to = (i + 0.75) / pieces;
    rod(a + from * (b - a), a + to * (b - a), radius, color);
  }
}

void Page::ball(const Eigen::Vector3d& centre, double radius, const Color& color) {
  balls_[{radius, color}].push_back(centre);
}

void Page::text(double x, double y, double size, const std::string& line, Align align, bool bold) {
  lines_.push_back({x, y, size, line, align, bold});
}

std::string Page::draw() const {
  vtkSMPTools::Initialize(1);
  vtkSMPTools::SetBackend("Sequential");
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1.0, 1.0, 1.0);
  renderer->AutomaticLightCreationOff();
  add_light(renderer, -0.5, 0.7, 1.0, 0.9);
  add_light(renderer, 0.8, -0.2, 0.7, 0.35);

  std::vector<vtkSmartPointer<vtkPolyData>> kept;
  const auto keep = [&kept](vtkPoints* points) {
    kept.push_back(vtkSmartPointer<vtkPolyData>::New());
    kept.back()->SetPoints(points);
    return kept.back().Get();
  };
  bool opaque = true;
  for (const auto& [style, triangles] : triangles_) {
    const auto& [front, back, opacity] = style;
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    for (const Corners& t : triangles) {
      const vtkIdType ids[3] = {add_point(points, t.a), add_point(points, t.b),
                                add_point(points, t.c)};
      cells->InsertNextCell(3, ids);
    }
    vtkPolyData* data = keep(points);
    data->SetPolys(cells);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkNew<vtkProperty> behind;
    for (vtkProperty* property : {actor->GetProperty(), behind.Get()}) {
      const Color& color = property == behind.Get() ? back : front;
      property->SetColor(color[0], color[1], color[2]);
      property->SetOpacity(opacity);
      property->SetInterpolationToFlat();
      property->SetAmbient(0.7);
      property->SetDiffuse(0.36);
    }
    actor->SetBackfaceProperty(behind);
    renderer->AddActor(actor);
    opaque = opaque && opacity >= 1.0;
  }
  for (const auto& [style, segments] : rods_) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    for (const Segment& s : segments) {
      const vtkIdType ids[2] = {add_point(points, s.a), add_point(points, s.b)};
      cells->InsertNextCell(2, ids);
    }
    vtkPolyData* data = keep(points);
    data->SetLines(cells);
    vtkNew<vtkTubeFilter> tube;
    tube->SetInputData(data);
    tube->SetRadius(style.first);
    tube->SetNumberOfSides(12);
    tube->CappingOn();
    add_actor(renderer, tube, style.second);
  }
  for (const auto& [style, centres] : balls_) {
    vtkNew<vtkPoints> points;
    for (const Eigen::Vector3d& p : centres) add_point(points, p);
    vtkPolyData* data = keep(points);
    for (const bool outline : {false, true}) {
      vtkNew<vtkSphereSource> sphere;
      sphere->SetRadius(style.first * (outline ? 1.22 : 1.0));
      sphere->SetThetaResolution(24);
      sphere->SetPhiResolution(16);
      vtkNew<vtkGlyph3D> glyph;
      glyph->SetInputData(data);
      glyph->SetSourceConnection(sphere->GetOutputPort());
      glyph->ScalingOff();
      vtkProperty* property =
          add_actor(renderer, glyph, outline ? Color{0.12, 0.12, 0.12} : style.second);
      if (outline) {
        property->FrontfaceCullingOn();
        property->LightingOff();
      }
    }
  }
  for (const Line& line : lines_) {
    vtkNew<vtkTextActor> actor;
    actor->SetInput(line.text.c_str());
    actor->SetPosition(kSamples * line.x, kSamples * line.y);
    vtkTextProperty* property = actor->GetTextProperty();
    property->SetFontSize(static_cast<int>(kSamples * line.size));
    property->SetColor(0.1, 0.1, 0.1);
    property->SetBold(line.bold ? 1 : 0);
    if (line.align == Align::centre) property->SetJustificationToCentered();
    renderer->AddActor2D(actor);
  }

  vtkCamera* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetParallelScale(0.5 * height_);
  camera->SetFocalPoint(0.5 * width_, 0.5 * height_, 0.0);
  camera->SetPosition(0.5 * width_, 0.5 * height_, kDepth);
  camera->SetViewUp(0, 1, 0);
  camera->SetClippingRange(0.5 * kDepth, 1.5 * kDepth);
  if (!opaque) {
    renderer->SetUseDepthPeeling(1);
    renderer->SetMaximumNumberOfPeels(12);
    renderer->SetOcclusionRatio(0.0);
  }
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetAlphaBitPlanes(1);
  window->SetSize(kSamples * width_, kSamples * height_);
  window->AddRenderer(renderer);
  window->Render();
  vtkNew<vtkWindowToImageFilter> capture;
  capture->SetInput(window);
  capture->ReadFrontBufferOff();
  capture->SetInputBufferTypeToRGB();
  vtkNew<vtkImageShrink3D> shrink;
  shrink->SetInputConnection(capture->GetOutputPort());
  shrink->SetShrinkFactors(kSamples, kSamples, 1);
  shrink->MeanOn();
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(shrink->GetOutputPort());
  writer->SetCompressionLevel(9);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)),
          static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

std::string Page::png() const {
  const PrivateDisplay display;
  ChildResult result = run_in_child([&] {
    setenv("DISPLAY", display.name().c_str(), 1);
    return draw();
  });
  if (!result.ok) throw PictureError("the picture could not be drawn: " + result.error);
  return std::move(result.output);
}

}  // namespace shape3d::apps
