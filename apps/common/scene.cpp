#include "scene.hpp"

#include <algorithm>
#include <cmath>

#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkCamera.h>
#include <vtkCellData.h>
#include <vtkCleanPolyData.h>
#include <vtkFloatArray.h>
#include <vtkLightKit.h>
#include <vtkNew.h>
#include <vtkOpenGLRenderer.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderStepsPass.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSSAOPass.h>
#include <vtkUnsignedCharArray.h>
#include <Eigen/Geometry>

#include "offscreen.hpp"
#include "vtk_mesh.hpp"

namespace shape3d::apps {
namespace {

constexpr int kSamples = 2;  // a pixel is the mean of kSamples² rendered ones

struct NamedView {
  std::string_view name;
  View view;
  std::array<double, 3> from, up;  // in LPS: left, posterior, superior
};
constexpr NamedView kViews[] = {{"front", View::front, {0, -1, 0}, {0, 0, 1}},
                                {"back", View::back, {0, 1, 0}, {0, 0, 1}},
                                {"left", View::left, {1, 0, 0}, {0, 0, 1}},
                                {"right", View::right, {-1, 0, 0}, {0, 0, 1}},
                                {"top", View::top, {0, 0, 1}, {0, -1, 0}},
                                {"bottom", View::bottom, {0, 0, -1}, {0, -1, 0}},
                                {"oblique", View::oblique, {0.62, -1, 0.28}, {0, 0, 1}},
                                {"upright", View::upright, {0.5, 0.35, 1}, {0, 1, 0}}};

// Mean of the triangle normals at each vertex, by area. Not VTK's filter, whose threads do not
// outlive fork().
vtkSmartPointer<vtkFloatArray> vertex_normals(const MeshView& mesh) {
  std::vector<Eigen::Vector3f> sums(static_cast<std::size_t>(mesh.vertex_count),
                                    Eigen::Vector3f::Zero());
  const auto point = [&mesh](std::int64_t v) {
    return Eigen::Map<const Eigen::Vector3d>(mesh.positions + 3 * v);
  };
  std::visit(
      [&](const auto* ids) {
        for (std::int64_t t = 0; t < mesh.triangle_count; ++t, ids += 3) {
          const Eigen::Vector3d a = point(ids[0]), b = point(ids[1]), c = point(ids[2]);
          const Eigen::Vector3f normal = (b - a).cross(c - a).cast<float>();
          for (int i = 0; i < 3; ++i) sums[static_cast<std::size_t>(ids[i])] += normal;
        }
      },
      mesh.indices);
  auto normals = vtkSmartPointer<vtkFloatArray>::New();
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(mesh.vertex_count);
  for (std::int64_t v = 0; v < mesh.vertex_count; ++v) {
    const Eigen::Vector3f n = sums[static_cast<std::size_t>(v)].stableNormalized();
    std::copy(n.data(), n.data() + 3, normals->GetPointer(3 * v));
  }
  return normals;
}

void set_colors(const SceneMesh& item, vtkPolyData* data, vtkPolyDataMapper* mapper) {
  mapper->SetScalarVisibility(!item.vertex_colors.empty() || !item.triangle_colors.empty());
  mapper->SetColorModeToDirectScalars();
  if (!item.triangle_colors.empty()) {
    data->GetCellData()->SetScalars(color_array(item.triangle_colors));
    mapper->SetScalarModeToUseCellData();
  } else if (!item.vertex_colors.empty()) {
    data->GetPointData()->SetScalars(color_array(item.vertex_colors));
    mapper->SetScalarModeToUsePointData();
  }
}

vtkSmartPointer<vtkActor> make_actor(const SceneMesh& item) {
  const vtkSmartPointer<vtkPolyData> data = borrow_polydata(item.mesh);
  data->GetPointData()->SetNormals(vertex_normals(item.mesh));
  vtkNew<vtkPolyDataMapper> mapper;
  set_colors(item, data, mapper);
  vtkNew<vtkPolyDataConnectivityFilter> largest;
  vtkNew<vtkCleanPolyData> used;  // without the points of the other components
  if (item.largest_only) {
    largest->SetInputData(data);
    largest->SetExtractionModeToLargestRegion();
    used->SetInputConnection(largest->GetOutputPort());
    used->PointMergingOff();
    mapper->SetInputConnection(used->GetOutputPort());
  } else {
    mapper->SetInputData(data);
  }
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->SetColor(item.color[0], item.color[1], item.color[2]);
  property->SetOpacity(item.opacity);
  property->SetInterpolationToPhong();
  property->SetAmbient(1.0 - 0.92 * item.shading);
  property->SetDiffuse(0.92 * item.shading);
  property->SetSpecular(0.18 * item.shading);
  property->SetSpecularPower(24.0);
  if (item.edges) {
    property->EdgeVisibilityOn();
    property->SetEdgeColor(0.15, 0.15, 0.15);
  }
  if (item.mesh.space == "RAS") actor->SetScale(-1.0, -1.0, 1.0);
  return actor;
}

std::vector<vtkActor*> actors_of(vtkRenderer* renderer) {
  std::vector<vtkActor*> actors;
  vtkActorCollection* collection = renderer->GetActors();
  collection->InitTraversal();
  while (vtkActor* actor = collection->GetNextActor()) actors.push_back(actor);
  return actors;
}

// Places the camera so that every vertex is in view, with a margin, and the picture centred.
void place_camera(vtkRenderer* renderer, View view, double aspect) {
  const NamedView& place = *std::find_if(std::begin(kViews), std::end(kViews),
                                         [view](const NamedView& v) { return v.view == view; });
  const Eigen::Vector3d from = Eigen::Map<const Eigen::Vector3d>(place.from.data()).normalized();
  const Eigen::Vector3d up = Eigen::Map<const Eigen::Vector3d>(place.up.data());
  const Eigen::Vector3d right = up.cross(from).normalized(), above = from.cross(right);
  constexpr double kAngle = 20.0;  // of the view, vertically
  const double slope = std::tan(kAngle * 3.14159265358979 / 360.0);
  const std::array<double, 2> slopes{slope * aspect, slope};
  // A vertex at (a, d) across and towards the eye is in view when |a − c| ≤ slope (D − d) for the
  // centre c and the distance D of the eye: a + slope d ≤ slope D + c and −a + slope d ≤ slope D −
  // c.
  std::array<double, 2> most{-1e300, -1e300}, least{-1e300, -1e300};
  double nearest = -1e300;
  for (vtkActor* actor : actors_of(renderer)) {
    actor->GetMapper()->Update();
    vtkPoints* points = vtkPolyData::SafeDownCast(actor->GetMapper()->GetInput())->GetPoints();
    const double* scale = actor->GetScale();
    for (vtkIdType v = 0; v < points->GetNumberOfPoints(); ++v) {
      Eigen::Vector3d p;
      points->GetPoint(v, p.data());
      const Eigen::Vector3d q = p.cwiseProduct(Eigen::Vector3d(scale[0], scale[1], scale[2]));
      const double depth = q.dot(from);
      nearest = std::max(nearest, depth);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double across = q.dot(axis == 0 ? right : above);
        most[axis] = std::max(most[axis], across + slopes[axis] * depth);
        least[axis] = std::max(least[axis], -across + slopes[axis] * depth);
      }
    }
  }
  double distance = nearest;
  Eigen::Vector2d centre;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    centre[static_cast<Eigen::Index>(axis)] = (most[axis] - least[axis]) / 2;
    distance = std::max(distance, (most[axis] + least[axis]) / (2 * slopes[axis]));
  }
  constexpr double kMargin = 1.06;
  distance = nearest + kMargin * std::max(distance - nearest, 1e-9 * (1.0 + std::abs(nearest)));
  const Eigen::Vector3d focus = centre[0] * right + centre[1] * above + nearest * from;
  const Eigen::Vector3d eye = centre[0] * right + centre[1] * above + distance * from;
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->SetFocalPoint(focus[0], focus[1], focus[2]);
  camera->SetPosition(eye[0], eye[1], eye[2]);
  camera->SetViewUp(up[0], up[1], up[2]);
  camera->SetViewAngle(kAngle);
  renderer->ResetCameraClippingRange();
}

}  // namespace

std::optional<View> view_named(std::string_view name) {
  for (const NamedView& view : kViews) {
    if (view.name == name) return view.view;
  }
  return std::nullopt;
}

struct SceneRenderer::State {
  vtkNew<vtkRenderWindow> window;
  int width = 0, height = 0;
  Color background;
};

SceneRenderer::SceneRenderer(int width, int height, const Color& background)
    : state_(std::make_unique<State>()) {
  state_->width = width;
  state_->height = height;
  state_->background = background;
  vtkRenderWindow* window = state_->window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetAlphaBitPlanes(1);
  window->SetSize(kSamples * width, kSamples * height);
}

SceneRenderer::~SceneRenderer() = default;

Raster SceneRenderer::render(const std::vector<SceneMesh>& meshes, View view) {
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(state_->background[0], state_->background[1], state_->background[2]);
  bool opaque = true, shaded = true, empty = true;
  for (const SceneMesh& item : meshes) {
    if (item.mesh.triangle_count == 0) continue;
    renderer->AddActor(make_actor(item));
    empty = false;
    opaque = opaque && item.opacity >= 1.0;
    shaded = shaded && item.shading >= 1.0;
  }
  renderer->AutomaticLightCreationOff();
  vtkNew<vtkLightKit> lights;
  lights->SetKeyLightIntensity(0.86);
  lights->SetKeyLightWarmth(0.54);
  lights->SetFillLightWarmth(0.47);
  lights->SetKeyToFillRatio(2.4);
  lights->SetKeyToHeadRatio(3.5);
  lights->SetKeyLightAngle(46.0, -30.0);
  lights->AddLightsToRenderer(renderer);
  vtkRenderWindow* window = state_->window;
  window->AddRenderer(renderer);
  if (!empty) place_camera(renderer, view, static_cast<double>(state_->width) / state_->height);
  if (opaque && shaded && !empty) {
    double bounds[6];
    renderer->ComputeVisiblePropBounds(bounds);
    const double diagonal =
        Eigen::Vector3d(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]).norm();
    vtkNew<vtkRenderStepsPass> steps;
    vtkNew<vtkSSAOPass> occlusion;
    occlusion->SetRadius(0.05 * diagonal);
    occlusion->SetBias(0.0015 * diagonal);
    occlusion->SetKernelSize(32);
    occlusion->BlurOn();
    occlusion->SetDelegatePass(steps);
    vtkOpenGLRenderer::SafeDownCast(renderer)->SetPass(occlusion);
  } else if (!opaque) {
    renderer->SetUseDepthPeeling(1);
    renderer->SetMaximumNumberOfPeels(10);
    renderer->SetOcclusionRatio(0.0);
  }
  window->Render();
  Raster raster = raster_of(window, kSamples);
  window->RemoveRenderer(renderer);
  return raster;
}

Raster render_scene(const std::vector<SceneMesh>& meshes, View view, int width, int height,
                    const Color& background) {
  return SceneRenderer(width, height, background).render(meshes, view);
}

}  // namespace shape3d::apps
