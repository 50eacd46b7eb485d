#include "scene_widget.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include <QVTKOpenGLNativeWidget.h>
#include <vtkActor.h>
#include <vtkAxesActor.h>
#include <vtkBoundingBox.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkCaptionActor2D.h>
#include <vtkCellData.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkLight.h>
#include <vtkLightCollection.h>
#include <vtkLightKit.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOrientationMarkerWidget.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <QEvent>
#include <QTimer>
#include <QVBoxLayout>

#include "theme.hpp"

namespace shape3d::apps::viewer {
namespace {

// Keys belong to the window: VTK's own (w: wireframe, e: exit, 3: stereo …) are off.
class TurnStyle : public vtkInteractorStyleTrackballCamera {
 public:
  static TurnStyle* New();
  vtkTypeMacro(TurnStyle, vtkInteractorStyleTrackballCamera) TurnStyle(const TurnStyle&) = delete;
  TurnStyle& operator=(const TurnStyle&) = delete;
  void OnChar() override {}

 protected:
  TurnStyle() = default;
  ~TurnStyle() override = default;
};
vtkStandardNewMacro(TurnStyle)

    void set_text(vtkCaptionActor2D* caption, const QColor& color) {
  vtkTextProperty* text = caption->GetCaptionTextProperty();
  text->SetColor(color.redF(), color.greenF(), color.blueF());
  text->ShadowOff();
  text->ItalicOff();
  text->BoldOn();
}

}  // namespace

SceneSurface::SceneSurface()
    : actor_(vtkSmartPointer<vtkActor>::New()),
      full_(vtkSmartPointer<vtkPolyDataMapper>::New()),
      coarse_(vtkSmartPointer<vtkPolyDataMapper>::New()) {
  full_->ScalarVisibilityOff();
  coarse_->ScalarVisibilityOff();
  // What is drawn while turning stays on the graphics card beside the full surface.
  actor_->SetMapper(full_);
  vtkProperty* material = actor_->GetProperty();
  material->SetInterpolationToPhong();
  material->SetAmbient(0.08);
  material->SetDiffuse(0.92);
  material->SetSpecular(0.18);
  material->SetSpecularPower(24.0);
}

SceneSurface::~SceneSurface() = default;

vtkActor* SceneSurface::actor() const { return actor_; }

vtkProperty* SceneSurface::property() const { return actor_->GetProperty(); }

void SceneSurface::set_geometry(vtkPolyData* full, vtkPolyData* coarse) {
  // The same data again would go to the graphics card again.
  if (full_->GetInput() != full) full_->SetInputData(full);
  has_coarse_ = coarse != nullptr;
  if (has_coarse_) coarse_->SetInputData(coarse);
  set_coarse(is_coarse_);
}

void SceneSurface::set_colors(vtkUnsignedCharArray* colors, bool of_triangles) {
  vtkPolyData* data = full_->GetInput();
  if (data == nullptr) return;
  data->GetCellData()->SetScalars(of_triangles ? colors : nullptr);
  data->GetPointData()->SetScalars(of_triangles ? nullptr : colors);
  if (of_triangles) {
    full_->SetScalarModeToUseCellData();
  } else {
    full_->SetScalarModeToUsePointData();
  }
  full_->SetColorModeToDirectScalars();
  full_->SetScalarVisibility(true);
  data->Modified();
}

void SceneSurface::set_visible(bool visible) { actor_->SetVisibility(visible); }

void SceneSurface::set_coarse(bool coarse) {
  is_coarse_ = coarse;
  actor_->SetMapper(coarse && has_coarse_ ? coarse_ : full_);
}

struct SceneWidget::Parts {
  vtkNew<vtkLightKit> lights;
  vtkNew<vtkAxesActor> axes;
  vtkNew<vtkOrientationMarkerWidget> marker;
  vtkNew<TurnStyle> style;
  vtkNew<vtkCallbackCommand> begin, end, moved;
};

SceneWidget::SceneWidget(QWidget* parent)
    : QWidget(parent),
      window_(vtkSmartPointer<vtkGenericOpenGLRenderWindow>::New()),
      renderer_(vtkSmartPointer<vtkRenderer>::New()),
      gl_(new QVTKOpenGLNativeWidget(this)),
      parts_(std::make_unique<Parts>()) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(gl_);
  setMinimumSize(120, 100);
  window_->SetMultiSamples(0);
  window_->AddRenderer(renderer_);
  renderer_->SetUseFXAA(true);
  renderer_->GradientBackgroundOn();
  renderer_->AutomaticLightCreationOff();
  parts_->lights->SetKeyLightIntensity(0.86);
  parts_->lights->SetKeyLightWarmth(0.54);
  parts_->lights->SetFillLightWarmth(0.47);
  parts_->lights->SetKeyToFillRatio(2.4);
  parts_->lights->SetKeyToHeadRatio(3.5);
  parts_->lights->SetKeyLightAngle(46.0, -30.0);
  parts_->lights->AddLightsToRenderer(renderer_);
  // The two lights from behind go: each light costs time in each pixel, and they add a rim only.
  vtkLightCollection* lights = renderer_->GetLights();
  for (int n = 3; n < lights->GetNumberOfItems(); ++n)
    vtkLight::SafeDownCast(lights->GetItemAsObject(n))->SwitchOff();
  gl_->setRenderWindow(window_);
  gl_->setEnableHiDPI(true);
  gl_->installEventFilter(this);
  window_->GetInteractor()->SetInteractorStyle(parts_->style);

  const auto connect_event = [this](vtkCallbackCommand* command, vtkObject* source,
                                    unsigned long event, auto* function) {
    command->SetClientData(this);
    command->SetCallback(function);
    source->AddObserver(event, command);
  };
  connect_event(
      parts_->begin, parts_->style, vtkCommand::StartInteractionEvent,
      +[](vtkObject*, unsigned long, void* self, void*) {
        static_cast<SceneWidget*>(self)->set_interacting(true);
      });
  connect_event(
      parts_->end, parts_->style, vtkCommand::EndInteractionEvent,
      +[](vtkObject*, unsigned long, void* self, void*) {
        static_cast<SceneWidget*>(self)->set_interacting(false);
      });
  connect_event(
      parts_->moved, renderer_->GetActiveCamera(), vtkCommand::ModifiedEvent,
      +[](vtkObject*, unsigned long, void* self, void*) {
        emit static_cast<SceneWidget*>(self)->turned();
      });
  parts_->axes->SetXAxisLabelText("L");
  parts_->axes->SetYAxisLabelText("P");
  parts_->axes->SetZAxisLabelText("S");
  parts_->marker->SetOrientationMarker(parts_->axes);
  parts_->marker->SetInteractor(window_->GetInteractor());
  parts_->marker->SetViewport(0.0, 0.0, 0.2, 0.25);
  parts_->marker->SetEnabled(1);
  parts_->marker->InteractiveOff();
  set_theme(make_theme(true));
}

SceneWidget::~SceneWidget() {
  parts_->marker->SetEnabled(0);
  parts_->style->RemoveObserver(parts_->begin);
  parts_->style->RemoveObserver(parts_->end);
  renderer_->GetActiveCamera()->RemoveObserver(parts_->moved);
}

vtkRenderer* SceneWidget::renderer() const { return renderer_; }

vtkGenericOpenGLRenderWindow* SceneWidget::window() const { return window_; }

vtkCamera* SceneWidget::camera() const { return renderer_->GetActiveCamera(); }

std::shared_ptr<SceneSurface> SceneWidget::add_surface() {
  auto surface = std::make_shared<SceneSurface>();
  renderer_->AddActor(surface->actor());
  surfaces_.push_back(surface);
  return surface;
}

void SceneWidget::remove(const std::shared_ptr<SceneSurface>& surface) {
  if (!surface) return;
  renderer_->RemoveActor(surface->actor());
  surfaces_.erase(std::remove_if(surfaces_.begin(), surfaces_.end(),
                                 [&surface](const std::weak_ptr<SceneSurface>& other) {
                                   const auto held = other.lock();
                                   return !held || held == surface;
                                 }),
                  surfaces_.end());
}

void SceneWidget::redraw() {
  if (waiting_) return;
  waiting_ = true;
  QTimer::singleShot(0, this, [this] {
    waiting_ = false;
    if (isVisible()) static_cast<void>(draw_now());
  });
}

double SceneWidget::draw_now() {
  const auto start = std::chrono::steady_clock::now();
  window_->Render();
  ++frames_;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void SceneWidget::look(LookFrom from, SceneWidget* other) {
  struct Place {
    std::array<double, 3> from, up;  // in LPS
  };
  static constexpr std::array<Place, 8> kPlaces{{{{0, -1, 0}, {0, 0, 1}},
                                                 {{0, 1, 0}, {0, 0, 1}},
                                                 {{1, 0, 0}, {0, 0, 1}},
                                                 {{-1, 0, 0}, {0, 0, 1}},
                                                 {{0, 0, 1}, {0, -1, 0}},
                                                 {{0, 0, -1}, {0, -1, 0}},
                                                 {{0.62, -1, 0.28}, {0, 0, 1}},
                                                 {{0.5, 0.35, 1}, {0, 1, 0}}}};
  const Place& place = kPlaces[static_cast<std::size_t>(from)];
  vtkCamera* eye = camera();
  eye->SetFocalPoint(0, 0, 0);
  eye->SetPosition(place.from.data());
  eye->SetViewUp(place.up.data());
  eye->SetViewAngle(30.0);
  other_ = other;
  fit();
  redraw();
}

// Moves the camera along the line of sight until the corners of the bounds just fit: a corner at
// (x, y) across and z towards the eye, from the middle, needs |x| <= (d - z) tan(angle / 2) aspect,
// and |y| <= (d - z) tan(angle / 2), of the distance d.
void SceneWidget::fit() {
  vtkBoundingBox box;
  for (SceneWidget* scene : {this, other_.data()}) {
    double bounds[6];
    if (scene == nullptr) continue;
    scene->renderer_->ComputeVisiblePropBounds(bounds);
    if (vtkMath::AreBoundsInitialized(bounds)) box.AddBounds(bounds);
  }
  if (box.IsValid() == 0) return;
  using Eigen::Vector3d;
  const auto vector = [](const double* numbers) {
    return Vector3d(numbers[0], numbers[1], numbers[2]);
  };
  Vector3d middle, half;
  box.GetCenter(middle.data());
  box.GetLengths(half.data());
  half /= 2.0;
  vtkCamera* eye = camera();
  const Vector3d back = (vector(eye->GetPosition()) - vector(eye->GetFocalPoint())).normalized();
  const Vector3d right = vector(eye->GetViewUp()).cross(back).normalized(), up = back.cross(right);
  constexpr double kFilled = 0.92;
  const double down = kFilled * std::tan(eye->GetViewAngle() * M_PI / 360.0);
  const double across = down * std::max(1, gl_->width()) / std::max(1, gl_->height());
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d at =
        half.cwiseProduct(Vector3d((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                                   (corner & 4) != 0 ? 1.0 : -1.0));
    distance = std::max(distance, at.dot(back) + std::max(std::abs(at.dot(right)) / across,
                                                          std::abs(at.dot(up)) / down));
  }
  if (!(distance > 0.0)) distance = 1.0;
  const Vector3d place = middle + distance * back;
  eye->SetFocalPoint(middle.data());
  eye->SetPosition(place.data());
  renderer_->ResetCameraClippingRange();
  fitted_ = camera_numbers(eye);
}

void SceneWidget::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  if (!fitted_.empty() && camera_numbers(camera()) == fitted_) fit();
}

void SceneWidget::set_axes_visible(bool visible) {
  parts_->marker->SetEnabled(visible ? 1 : 0);
  redraw();
}

void SceneWidget::set_transparency(bool on) {
  renderer_->SetUseDepthPeeling(on);
  renderer_->SetMaximumNumberOfPeels(6);
  renderer_->SetOcclusionRatio(0.05);
  window_->SetAlphaBitPlanes(on ? 1 : 0);
}

void SceneWidget::set_theme(const Theme& theme) {
  renderer_->SetBackground(theme.scene_low.redF(), theme.scene_low.greenF(),
                           theme.scene_low.blueF());
  renderer_->SetBackground2(theme.scene_high.redF(), theme.scene_high.greenF(),
                            theme.scene_high.blueF());
  for (vtkCaptionActor2D* caption :
       {parts_->axes->GetXAxisCaptionActor2D(), parts_->axes->GetYAxisCaptionActor2D(),
        parts_->axes->GetZAxisCaptionActor2D()})
    set_text(caption, theme.text);
  redraw();
}

void SceneWidget::set_interacting(bool interacting) {
  interacting_ = interacting;
  for (const auto& entry : surfaces_) {
    if (const auto surface = entry.lock()) surface->set_coarse(interacting);
  }
  renderer_->SetUseFXAA(!interacting);
}

bool SceneWidget::eventFilter(QObject* object, QEvent* event) {
  if (event->type() == QEvent::MouseButtonDblClick) {
    emit maximise();
    return true;
  }
  return QWidget::eventFilter(object, event);
}

std::vector<double> camera_numbers(vtkCamera* camera) {
  std::vector<double> numbers;
  for (const double* triple : {camera->GetPosition(), camera->GetFocalPoint(), camera->GetViewUp()})
    numbers.insert(numbers.end(), triple, triple + 3);
  numbers.push_back(camera->GetViewAngle());
  return numbers;
}

void set_camera(vtkCamera* camera, const std::vector<double>& numbers) {
  if (numbers.size() != 10 ||
      !std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
    throw std::invalid_argument("camera has " + std::to_string(numbers.size()) +
                                " numbers; expected 10 finite ones");
  camera->SetPosition(numbers.data());
  camera->SetFocalPoint(numbers.data() + 3);
  camera->SetViewUp(numbers.data() + 6);
  camera->SetViewAngle(numbers[9]);
}

}  // namespace shape3d::apps::viewer
