#include "four_up.hpp"

#include <cmath>

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTexture.h>
#include <QGridLayout>
#include <QLabel>
#include <QVBoxLayout>
#include <nlohmann/json.hpp>

#include "document.hpp"
#include "model/place_text.hpp"
#include "scene_widget.hpp"

namespace shape3d::apps::viewer {

// A slice as a textured quadrilateral at its place. What is black, as the air round a patient, is
// left out, so that the slices do not hide one another.
struct FourUp::Plane {
  vtkNew<vtkImageData> image;
  vtkNew<vtkTexture> texture;
  vtkNew<vtkPoints> corners;
  vtkNew<vtkPolyData> data;
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkActor> actor;

  Plane() {
    corners->SetNumberOfPoints(4);
    vtkNew<vtkCellArray> cells;
    cells->InsertNextCell({0, 1, 2, 3});
    vtkNew<vtkFloatArray> coordinates;
    coordinates->SetNumberOfComponents(2);
    for (const auto& [u, v] : {std::pair{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}})
      coordinates->InsertNextTuple2(u, v);
    data->SetPoints(corners);
    data->SetPolys(cells);
    data->GetPointData()->SetTCoords(coordinates);
    mapper->SetInputData(data);
    texture->SetInputData(image);
    texture->InterpolateOn();
    texture->SetWrap(vtkTexture::ClampToEdge);
    actor->SetMapper(mapper);
    actor->SetTexture(texture);
    actor->GetProperty()->LightingOff();
    actor->ForceOpaqueOn();  // alpha is 0 or 1
  }

  void set(const SliceWidget& slice, const zmc::VolumeView& volume) {
    const QImage& grey = slice.image();
    image->SetDimensions(grey.width(), grey.height(), 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 4);
    auto* to = static_cast<unsigned char*>(image->GetScalarPointer());
    for (int row = 0; row < grey.height(); ++row) {
      const unsigned char* from = grey.constScanLine(row);
      for (int column = 0; column < grey.width(); ++column, to += 4) {
        to[0] = to[1] = to[2] = from[column];
        to[3] = from[column] == 0 ? 0 : 255;
      }
    }
    image->Modified();
    const auto [across, down] = slice.geometry()->size();
    const auto k = static_cast<double>(slice.slice());
    vtkIdType n = 0;
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {across, 0.0}, {across, down}, {0.0, down}})
      corners->SetPoint(n++, volume.world(slice.geometry()->lattice({x, y}, k)).data());
    corners->Modified();
    data->Modified();
  }
};

// The edges of the volume's box.
struct FourUp::Frame {
  vtkNew<vtkPolyData> data;
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkActor> actor;

  Frame() {
    mapper->SetInputData(data);
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetColor(0.5, 0.55, 0.62);
    actor->SetVisibility(0);
  }

  void set(const zmc::VolumeView& volume) {
    vtkNew<vtkPoints> points;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      Eigen::Vector3d p;
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[static_cast<Eigen::Index>(axis)] =
            (corner >> axis & 1) != 0 ? static_cast<double>(volume.dims[axis]) - 0.5 : -0.5;
      points->InsertNextPoint(volume.world(p).data());
    }
    vtkNew<vtkCellArray> lines;
    for (vtkIdType a = 0; a < 8; ++a) {
      for (const vtkIdType bit : {1, 2, 4}) {
        if ((a & bit) == 0) lines->InsertNextCell({a, a | bit});
      }
    }
    data->SetPoints(points);
    data->SetLines(lines);
    data->Modified();
  }
};

FourUp::FourUp(Document& document, QWidget* parent)
    : QWidget(parent),
      document_(document),
      scene_(new SceneWidget(this)),
      grid_(new QGridLayout),
      readout_(new QLabel(this)),
      frame_(std::make_unique<Frame>()) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addLayout(grid_, 1);
  readout_->setContentsMargins(8, 3, 8, 3);
  readout_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  column->addWidget(readout_);
  grid_->setSpacing(2);
  for (int axis = 0; axis < 3; ++axis) {
    auto* slice = new SliceWidget(document_, axis, this);
    slices_[index(axis)] = slice;
    planes_[index(axis)] = std::make_unique<Plane>();
    scene_->renderer()->AddActor(planes_[index(axis)]->actor);
    connect(slice, &SliceWidget::image_changed, this, [this, axis] { update_plane(axis); });
    connect(slice, &SliceWidget::window_edited, this, &FourUp::window_edited);
    connect(slice, &SliceWidget::hovered, this, [this](const Eigen::Vector3d& place) {
      mouse_ = place;
      update_readout();
    });
    connect(slice, &SliceWidget::left, this, [this] {
      mouse_.reset();
      update_readout();
    });
    connect(slice, &SliceWidget::maximise, this,
            [this, slice] { show_only(alone_ == slice ? nullptr : slice); });
  }
  connect(scene_, &SceneWidget::maximise, this,
          [this] { show_only(alone_ == scene_ ? nullptr : scene_); });
  scene_->renderer()->AddActor(frame_->actor);
  connect(&document_, &Document::volume_changed, this, &FourUp::take_volume);
  connect(&document_, &Document::cursor_changed, this, &FourUp::update_readout);
  take_volume();
}

FourUp::~FourUp() = default;

void FourUp::take_volume() {
  const auto volume = document_.volume();
  frame_->actor->SetVisibility(volume != nullptr);
  mouse_.reset();
  if (volume) {
    const zmc::VolumeView& view = volume->volume.view;
    frame_->set(view);
    // Axial above left, the scene above right, the other two below, as in 3D Slicer.
    std::array<int, 3> of_world{0, 1, 2};
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Index world = 0;
      view.direction.col(axis).cwiseAbs().maxCoeff(&world);
      of_world[static_cast<std::size_t>(world)] = axis;
    }
    const bool permutation =
        of_world[0] != of_world[1] && of_world[1] != of_world[2] && of_world[0] != of_world[2];
    if (!permutation) of_world = {0, 1, 2};
    for (SliceWidget* slice : slices_) grid_->removeWidget(slice);
    grid_->removeWidget(scene_);
    grid_->addWidget(slices_[index(of_world[2])], 0, 0);
    grid_->addWidget(scene_, 0, 1);
    grid_->addWidget(slices_[index(of_world[1])], 1, 0);
    grid_->addWidget(slices_[index(of_world[0])], 1, 1);
    for (int side = 0; side < 2; ++side) {
      grid_->setRowStretch(side, 1);
      grid_->setColumnStretch(side, 1);
    }
    for (int axis = 0; axis < 3; ++axis) update_plane(axis);
    scene_->look(LookFrom::oblique);
  }
  update_readout();
}

void FourUp::update_plane(int axis) {
  Plane& plane = *planes_[index(axis)];
  const auto volume = document_.volume();
  const SliceWidget* slice = slices_[index(axis)];
  const bool visible = planes_visible_ && volume && slice->geometry() && !slice->image().isNull();
  plane.actor->SetVisibility(visible);
  if (visible) plane.set(*slice, volume->volume.view);
  scene_->redraw();
}

QString FourUp::readout() const { return readout_->text(); }

void FourUp::update_readout() {
  const auto volume = document_.volume();
  if (!volume) {
    readout_->clear();
    return;
  }
  const std::string text = place_text(volume->volume.view, mouse_ ? *mouse_ : document_.cursor());
  readout_->setText((mouse_ ? "Mouse   " : "Crosshair   ") + QString::fromStdString(text));
}

void FourUp::set_outline_maker(const SliceWidget::OutlineMaker& maker) {
  for (SliceWidget* slice : slices_) slice->set_outline_maker(maker);
}

void FourUp::refresh_outlines() {
  for (SliceWidget* slice : slices_) slice->refresh_outlines();
}

void FourUp::set_planes_visible(bool visible) {
  planes_visible_ = visible;
  for (int axis = 0; axis < 3; ++axis) update_plane(axis);
}

void FourUp::set_theme(const Theme& theme) {
  for (SliceWidget* slice : slices_) slice->set_theme(theme);
  scene_->set_theme(theme);
}

void FourUp::set_active(bool active) {
  for (SliceWidget* slice : slices_) slice->set_live(active);
  if (active) scene_->redraw();
}

void FourUp::show_only(QWidget* widget) {
  alone_ = widget;
  for (SliceWidget* slice : slices_) slice->setVisible(widget == nullptr || widget == slice);
  scene_->setVisible(widget == nullptr || widget == scene_);
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      QLayoutItem* item = grid_->itemAtPosition(row, column);
      if (item == nullptr || item->widget() != widget) continue;
      grid_->setRowStretch(row, 1);
      grid_->setRowStretch(1 - row, 0);
      grid_->setColumnStretch(column, 1);
      grid_->setColumnStretch(1 - column, 0);
    }
  }
  if (widget == nullptr) {
    for (int side = 0; side < 2; ++side) {
      grid_->setRowStretch(side, 1);
      grid_->setColumnStretch(side, 1);
    }
  }
  scene_->redraw();
}

void FourUp::reset() {
  show_only(nullptr);
  for (SliceWidget* slice : slices_) slice->set_zoom(1.0, {});
  scene_->look(LookFrom::oblique);
}

nlohmann::json FourUp::state() const {
  nlohmann::json state;
  for (int axis = 0; axis < 3; ++axis) {
    const SliceWidget* slice = slices_[index(axis)];
    state["slices"].push_back(
        {{"zoom", slice->zoom()}, {"pan", {slice->pan().x(), slice->pan().y()}}});
  }
  state["camera"] = camera_numbers(scene_->camera());
  state["planes"] = planes_visible_;
  int alone = -1;
  for (int axis = 0; axis < 3; ++axis) {
    if (alone_ == slices_[index(axis)]) alone = axis;
  }
  if (alone_ == scene_) alone = 3;
  state["alone"] = alone;
  return state;
}

void FourUp::set_state(const nlohmann::json& state) {
  if (state.contains("slices")) {
    for (int axis = 0; axis < 3; ++axis) {
      const nlohmann::json& slice = state["slices"].at(index(axis));
      const auto pan = slice.at("pan").get<std::array<double, 2>>();
      slices_[index(axis)]->set_zoom(slice.at("zoom").get<double>(), {pan[0], pan[1]});
    }
  }
  if (state.contains("camera")) {
    set_camera(scene_->camera(), state["camera"].get<std::vector<double>>());
    scene_->renderer()->ResetCameraClippingRange();
  }
  if (state.contains("planes")) set_planes_visible(state["planes"].get<bool>());
  if (state.contains("alone")) {
    const int alone = state["alone"].get<int>();
    show_only(alone == 3                 ? static_cast<QWidget*>(scene_)
              : alone >= 0 && alone <= 2 ? slices_[index(alone)]
                                         : nullptr);
  }
  scene_->redraw();
}

}  // namespace shape3d::apps::viewer
