#include "sphere_view.hpp"

#include <algorithm>
#include <new>
#include <stdexcept>

#include <vtkCamera.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileInfo>
#include <QFormLayout>
#include <QGroupBox>
#include <QLabel>
#include <QProgressBar>
#include <QShortcut>
#include <QSplitter>
#include <QVBoxLayout>
#include <nlohmann/json.hpp>

#include "common/vtk_mesh.hpp"
#include "document.hpp"
#include "image_widget.hpp"
#include "model/surface_data.hpp"
#include "scene_widget.hpp"

namespace shape3d::apps::viewer {

SphereView::SphereView(Document& document)
    : View("sphere", "Sphere map"), document_(document), content_(new QSplitter(Qt::Vertical)) {
  auto* scenes = new QSplitter(Qt::Horizontal);
  for (int side = 0; side < 2; ++side) {
    scenes_[side] = new SceneWidget;
    scenes_[side]->set_axes_visible(false);
    surfaces_[side] = scenes_[side]->add_surface();
    vtkProperty* material = surfaces_[side]->property();
    material->SetAmbient(0.55);  // colours are data
    material->SetDiffuse(0.5);
    material->SetSpecular(0.05);
    material->SetEdgeColor(0.1, 0.1, 0.1);
    surfaces_[side]->set_visible(false);
    scenes->addWidget(scenes_[side]);
    connect(scenes_[side], &SceneWidget::turned, this, [this, side] { link(side); });
  }
  image_ = new ImageWidget;
  content_->addWidget(scenes);
  content_->addWidget(image_);
  content_->setSizes({640, 400});
  content_->setChildrenCollapsible(false);
  make_panel();
  connect(&document_, &Document::meshes_changed, this, &SphereView::take_meshes);
  const auto next_color = new QShortcut(Qt::Key_C, content_);
  connect(next_color, &QShortcut::activated, this, [this] {
    color_->setCurrentIndex((color_->currentIndex() + 1) % color_->count());
    show_colors();
    emit edited();
  });
  connect(new QShortcut(Qt::Key_E, content_), &QShortcut::activated, edges_, &QCheckBox::click);
}

SphereView::~SphereView() { stop(); }

QWidget* SphereView::content() { return content_; }

QString SphereView::missing() const {
  if (!document_.meshes().empty()) return {};
  if (document_.loading() > 0) return "Reading …";
  return "Open a closed mesh: drop a file here, or press Ctrl+O";
}

void SphereView::make_panel() {
  panel_ = new QWidget;
  auto* column = new QVBoxLayout(panel_);
  auto* form_box = new QGroupBox("Sphere map");
  auto* form = new QFormLayout(form_box);
  mesh_ = new QComboBox;
  mesh_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  form->addRow("Mesh", mesh_);
  color_ = new QComboBox;
  color_->setObjectName("color");
  for (const SphereColorName& color : kSphereColors)
    color_->addItem(QString::fromUtf8(color.title.data(), static_cast<int>(color.title.size())),
                    QString::fromUtf8(color.name.data(), static_cast<int>(color.name.size())));
  form->addRow("Colour", color_);
  linear_ = new QCheckBox("Linear map only (fast)");
  form->addRow(linear_);
  balance_ = new QDoubleSpinBox;
  balance_->setRange(0.0, 100.0);
  balance_->setDecimals(3);
  balance_->setSingleStep(0.1);
  balance_->setToolTip("Weight of even areas against kept angles");
  form->addRow("Area balance", balance_);
  edges_ = new QCheckBox("Edges of triangles");
  form->addRow(edges_);
  progress_ = new QProgressBar;
  progress_->setRange(0, 1000);
  progress_->setMaximumHeight(10);
  progress_->setTextVisible(false);
  progress_->hide();
  form->addRow(progress_);
  column->addWidget(form_box);
  facts_ = new QLabel;
  facts_->setObjectName("facts");
  facts_->setWordWrap(true);
  facts_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  column->addWidget(facts_);
  column->addStretch(1);

  connect(mesh_, QOverload<int>::of(&QComboBox::activated), this, [this](int row) {
    if (row < 0 || row >= static_cast<int>(document_.meshes().size())) return;
    chosen_ = document_.meshes()[static_cast<std::size_t>(row)];
    look_ = true;
    if (active_) start();
    emit edited();
  });
  connect(color_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    show_colors();
    emit edited();
  });
  const auto again = [this] {
    mapped_.reset();
    if (active_) start();
    emit edited();
  };
  connect(linear_, &QCheckBox::clicked, this, again);
  connect(balance_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, again);
  balance_->setKeyboardTracking(false);
  connect(edges_, &QCheckBox::clicked, this, [this] {
    show_colors();
    emit edited();
  });
}

void SphereView::take_meshes() {
  const auto& meshes = document_.meshes();
  mesh_->clear();
  for (const auto& mesh : meshes)
    mesh_->addItem(QFileInfo(QString::fromStdString(mesh->path)).fileName());
  const auto found = std::find(meshes.begin(), meshes.end(), chosen_);
  // The newest, which the user has just opened.
  const bool newest = found == meshes.end() || meshes.size() > known_;
  known_ = meshes.size();
  if (meshes.empty()) {
    stop();
    chosen_ = mapped_ = nullptr;
    result_ = nullptr;
    for (const auto& surface : surfaces_) surface->set_visible(false);
    image_->clear();
    facts_->clear();
    return;
  }
  if (newest && meshes.back() != chosen_) {
    chosen_ = meshes.back();
    look_ = true;
  }
  mesh_->setCurrentIndex(
      static_cast<int>(std::find(meshes.begin(), meshes.end(), chosen_) - meshes.begin()));
  if (active_ && wanted()) start();
}

bool SphereView::wanted() const { return chosen_ && chosen_ != mapped_; }

void SphereView::stop() {
  ++number_;
  if (cancelled_) *cancelled_ = true;
  if (thread_.joinable()) thread_.join();
  working_ = false;
}

void SphereView::start() {
  stop();
  if (!wanted()) return;
  working_ = true;
  cancelled_ = std::make_shared<std::atomic<bool>>(false);
  SphereWish wish;
  wish.linear = linear_->isChecked();
  wish.area_balance = balance_->value();
  const int number = number_;
  progress_->setValue(0);
  progress_->show();
  facts_->setText("Mapping …");
  thread_ = std::thread([this, number, wish, mesh = chosen_, cancelled = cancelled_] {
    std::shared_ptr<const SphereResult> result;
    try {
      result = std::make_shared<const SphereResult>(
          map_and_color(mesh->mesh, wish, [this, number, cancelled](double share) {
            call_later(this, [this, number, share] {
              if (number == number_) progress_->setValue(static_cast<int>(1000 * share));
            });
            return !*cancelled;
          }));
    } catch (const std::bad_alloc&) {
      SphereResult failed;
      failed.error = "There is not enough memory to map this mesh";
      result = std::make_shared<const SphereResult>(std::move(failed));
    }
    call_later(this, [this, number, mesh, result] {
      if (number != number_) return;
      mapped_ = mesh;
      take(result);
    });
  });
  emit busy_changed();
}

void SphereView::take(const std::shared_ptr<const SphereResult>& result) {
  stop();
  progress_->hide();
  if (!result->error.empty()) {
    result_ = nullptr;
    for (const auto& surface : surfaces_) surface->set_visible(false);
    image_->clear();
    facts_->clear();
    emit failed(QString::fromStdString(mapped_->path + ": " + result->error));
  } else if (!result->cancelled) {
    result_ = result;
    show_geometry();
    show_colors();
  }
  emit busy_changed();
}

void SphereView::show_geometry() {
  const Mesh* meshes[2] = {&result_->mesh, &result_->sphere};
  for (int side = 0; side < 2; ++side) {
    // Colours are of vertices and triangles: there is no coarse surface for turning.
    surfaces_[side]->set_geometry(mesh_data(*meshes[side]), nullptr);
    surfaces_[side]->set_visible(true);
  }
  if (look_) {
    look_ = false;
    scenes_[0]->look(mapped_->mesh.space.empty() ? LookFrom::upright : LookFrom::oblique,
                     scenes_[1]);
  }
  link(0);
  const QLocale locale(QLocale::English);
  facts_->setText(
      QString("%1 triangles, mapped in %2 s\nangle change: median %3°, 95 % below %4°\nenergy / "
              "area %5 (1: conformal)\none to one: certified")
          .arg(locale.toString(static_cast<qlonglong>(result_->mesh.F.rows())),
               locale.toString(result_->seconds, 'f', 2),
               locale.toString(result_->median_angle_change, 'f', 2),
               locale.toString(result_->p95_angle_change, 'f', 1),
               locale.toString(result_->energy_over_area, 'f', 4)));
}

void SphereView::show_colors() {
  if (!result_) return;
  const auto row = static_cast<std::size_t>(color_->currentIndex());
  const SphereColoring& coloring = result_->colorings[row];
  for (int side = 0; side < 2; ++side) {
    surfaces_[side]->set_colors(color_array(coloring.bytes), coloring.of_triangles);
    surfaces_[side]->property()->SetEdgeVisibility(edges_->isChecked());
    scenes_[side]->redraw();
  }
  const QString title =
      coloring.has_scale
          ? color_->currentText() + ": " + QString::fromStdString(coloring.scale.title)
          : color_->currentText() + ": x, y, z as red, green, blue";
  image_->set_image(coloring.image, title,
                    coloring.has_scale ? std::optional<ColorScale>(coloring.scale) : std::nullopt);
}

void SphereView::link(int from) {
  if (linking_) return;
  linking_ = true;
  SceneWidget* to = scenes_[1 - from];
  set_camera(to->camera(), camera_numbers(scenes_[from]->camera()));
  to->renderer()->ResetCameraClippingRange();
  to->redraw();
  linking_ = false;
}

nlohmann::json SphereView::state() const {
  return {{"color", color_->currentData().toString().toStdString()},
          {"linear", linear_->isChecked()},
          {"area_balance", balance_->value()},
          {"edges", edges_->isChecked()},
          {"mesh", chosen_ ? chosen_->path : std::string()},
          {"layout", {{"camera", camera_numbers(scenes_[0]->camera())}}}};
}

void SphereView::set_state(const nlohmann::json& state) {
  const QSignalBlocker quiet_a(linear_), quiet_b(balance_);
  if (state.contains("color")) {
    const int row = color_->findData(QString::fromStdString(state["color"].get<std::string>()));
    if (row < 0)
      throw std::invalid_argument("color is " + state["color"].dump() +
                                  "; expected normal, curvature, coordinates, angle or area");
    color_->setCurrentIndex(row);
  }
  const bool linear = linear_->isChecked();
  const double balance = balance_->value();
  if (state.contains("linear")) linear_->setChecked(state["linear"].get<bool>());
  if (state.contains("area_balance")) balance_->setValue(state["area_balance"].get<double>());
  if (state.contains("edges")) edges_->setChecked(state["edges"].get<bool>());
  if (state.contains("mesh")) {
    for (const auto& mesh : document_.meshes()) {
      if (mesh->path == state["mesh"].get<std::string>()) chosen_ = mesh;
    }
  }
  if (state.contains("layout") && state["layout"].contains("camera")) {
    set_camera(scenes_[0]->camera(), state["layout"]["camera"].get<std::vector<double>>());
    look_ = false;
    link(0);
  }
  if (linear != linear_->isChecked() || balance != balance_->value()) mapped_.reset();
  if (active_ && wanted()) start();
  show_colors();
}

void SphereView::reset() {
  const QSignalBlocker quiet_a(linear_), quiet_b(balance_);
  const bool other = linear_->isChecked() || balance_->value() != 0.0;
  color_->setCurrentIndex(0);
  linear_->setChecked(false);
  balance_->setValue(0.0);
  edges_->setChecked(false);
  look_ = true;
  if (other) mapped_.reset();
  if (wanted()) {
    start();
  } else if (result_) {
    show_geometry();
    show_colors();
  }
}

std::vector<KeyHelp> SphereView::keys() const {
  return {{"C", "the next colouring"},
          {"E", "edges of triangles"},
          {"left drag", "turn mesh and sphere together"}};
}

void SphereView::set_theme(const Theme& theme) {
  for (SceneWidget* scene : scenes_) scene->set_theme(theme);
  image_->set_theme(theme);
}

void SphereView::set_active(bool active) {
  active_ = active;
  if (active_ && wanted() && !working_) start();
  emit busy_changed();
}

}  // namespace shape3d::apps::viewer
