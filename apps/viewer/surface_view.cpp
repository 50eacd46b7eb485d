#include "surface_view.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QShortcut>
#include <QSlider>
#include <QTimer>
#include <nlohmann/json.hpp>

#include "document.hpp"
#include "four_up.hpp"
#include "model/heap.hpp"
#include "model/isovalues.hpp"
#include "model/surface_data.hpp"
#include "scene_widget.hpp"
#include "surface_item.hpp"
#include "surface_panel.hpp"
#include "volume_view.hpp"

namespace shape3d::apps::viewer {
namespace {

constexpr int kSliderSteps = 1000;
constexpr int kTidy = 1000;   // ms after a full surface, when drawing has freed what it needed
constexpr int kSettle = 250;  // ms without a change of the value before the full surface is made

}  // namespace

SurfaceView::SurfaceView(Document& document)
    : View("surface", "Isosurface"), document_(document), four_up_(new FourUp(document)) {
  settle_ = new QTimer(this);
  settle_->setSingleShot(true);
  settle_->setInterval(kSettle);
  tidy_ = new QTimer(this);
  tidy_->setSingleShot(true);
  tidy_->setInterval(kTidy);
  connect(tidy_, &QTimer::timeout, this, [] { trim_heap(); });
  make_panel();
  make_shortcuts();
  four_up_->set_planes_visible(false);
  four_up_->set_outline_maker([this](const SliceGeometry& geometry, std::int64_t slice) {
    std::vector<Outline> outlines;
    if (!volume_ || !contours_->isChecked()) return outlines;
    for (const auto& item : items_) {
      if (item->mesh || !item->visible) continue;
      Outline outline;
      outline.color = item->color;
      outline.lines = item->contour(volume_->volume.view, geometry, slice);
      outlines.push_back(std::move(outline));
    }
    return outlines;
  });
  connect(&document_, &Document::volume_changed, this, &SurfaceView::take_volume);
  connect(&document_, &Document::meshes_changed, this, &SurfaceView::take_meshes);
  connect(four_up_, &FourUp::window_edited, &document_, &Document::window_edited);
  connect(settle_, &QTimer::timeout, this, [this] {
    if (Item* item = selected(); item != nullptr && !slider_->isSliderDown()) request(*item, false);
  });
}

SurfaceView::~SurfaceView() = default;

QWidget* SurfaceView::content() { return four_up_; }

QString SurfaceView::missing() const {
  if (document_.volume() || !document_.meshes().empty()) return {};
  if (document_.loading() > 0) return "Reading …";
  return "Open a volume or a mesh: drop a file here, or press Ctrl+O";
}

void SurfaceView::make_panel() {
  SurfacePanel* panel = new SurfacePanel(kSliderSteps);
  panel_ = panel;
  list_ = panel->list;
  add_ = panel->add;
  remove_ = panel->remove;
  color_ = panel->color;
  slider_ = panel->slider;
  opacity_ = panel->opacity;
  isovalue_ = panel->isovalue;
  below_ = panel->below;
  contours_ = panel->contours;
  marks_ = panel->marks;
  visible_ = panel->visible;
  method_ = panel->method;
  facts_ = panel->facts;
  connect(list_, &QListWidget::currentRowChanged, this, [this] { show_selected(); });
  connect(add_, &QPushButton::clicked, this, &SurfaceView::add_surface);
  connect(remove_, &QPushButton::clicked, this, &SurfaceView::remove_selected);
  connect(color_, &QPushButton::clicked, this, &SurfaceView::choose_color);
  connect(slider_, &QSlider::valueChanged, this, &SurfaceView::slider_moved);
  connect(slider_, &QSlider::sliderPressed, this,
          [this] { four_up_->scene()->set_interacting(true); });
  connect(slider_, &QSlider::sliderReleased, this, [this] {
    settle_->stop();
    four_up_->scene()->set_interacting(false);
    if (Item* item = selected()) request(*item, false);
    emit edited();
  });
  connect(isovalue_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
          [this](double value) {
            set_isovalue(value, false);
            emit edited();
          });
  connect(below_, &QCheckBox::clicked, this, [this](bool on) {
    if (Item* item = selected()) {
      item->below = on;
      request(*item, false);
      show_list();
    }
    emit edited();
  });
  connect(opacity_, &QSlider::valueChanged, this, [this](int percent) {
    if (Item* item = selected()) {
      item->opacity = percent / 100.0;
      style(*item);
    }
    if (!opacity_->isSliderDown()) emit edited();
  });
  connect(opacity_, &QSlider::sliderReleased, this, &View::edited);
  connect(visible_, &QCheckBox::clicked, this, [this](bool on) {
    if (Item* item = selected()) {
      item->visible = on;
      style(*item);
      four_up_->refresh_outlines();
    }
    emit edited();
  });
  connect(contours_, &QCheckBox::clicked, this, [this] {
    four_up_->refresh_outlines();
    emit edited();
  });
  connect(marks_, &QCheckBox::clicked, this, [this] {
    request_all();
    show_marks();
    emit edited();
  });
  connect(method_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    request_all();
    emit edited();
  });
  show_selected();
}

void SurfaceView::make_shortcuts() {
  const auto add_key = [this](const QKeySequence& key, auto what) {
    connect(new QShortcut(key, four_up_), &QShortcut::activated, this, what);
  };
  add_key(Qt::Key_C, [this] { contours_->click(); });
  add_key(Qt::Key_H, [this] { marks_->click(); });
  add_key(Qt::Key_P, [this] {
    four_up_->set_planes_visible(!four_up_->planes_visible());
    emit edited();
  });
  add_key(Qt::Key_F, [this] {
    method_->setCurrentIndex(1 - method_->currentIndex());
    request_all();
    emit edited();
  });
  add_key(Qt::Key_BracketLeft, [this] { slider_->setValue(slider_->value() - 1); });
  add_key(Qt::Key_BracketRight, [this] { slider_->setValue(slider_->value() + 1); });
}

void SurfaceView::take_volume() {
  const auto volume = document_.volume();
  if (volume == volume_) return;
  worker_.reset();
  for (std::size_t n = items_.size(); n-- > 0;) {
    if (!items_[n]->mesh) drop(n);
  }
  volume_ = volume;
  if (volume_) {
    worker_ = std::make_unique<IsoWorker>(
        std::shared_ptr<const Volume>(volume_, &volume_->volume), [this](IsoResult result) {
          call_later(this,
                     [this, result = std::move(result)]() mutable { take(std::move(result)); });
        });
    const bool integers = volume_->volume.view.type != zmc::SampleType::float32 &&
                          volume_->volume.view.type != zmc::SampleType::float64;
    const QSignalBlocker quiet(isovalue_);
    isovalue_->setRange(volume_->minimum, volume_->maximum);
    isovalue_->setDecimals(integers ? 1 : 4);
    isovalue_->setSingleStep(std::max((volume_->maximum - volume_->minimum) / 200.0, 1e-4));
    next_color_ = 0;
    ready_to_look_ = true;
    Item& item =
        add_item(default_isovalue(volume_->volume.view, volume_->minimum, volume_->maximum));
    request(item, false);
  }
  show_list();
  list_->setCurrentRow(0);
  show_selected();
  emit busy_changed();
}

void SurfaceView::take_meshes() {
  for (std::size_t n = items_.size(); n-- > 0;) {
    const auto& meshes = document_.meshes();
    if (items_[n]->mesh && std::find(meshes.begin(), meshes.end(), items_[n]->mesh) == meshes.end())
      drop(n);
  }
  for (const auto& mesh : document_.meshes()) {
    const bool known = std::any_of(items_.begin(), items_.end(),
                                   [&mesh](const auto& item) { return item->mesh == mesh; });
    if (known) continue;
    Item& item = add_item(0.0);
    item.mesh = mesh;
    const vtkSmartPointer<vtkPolyData> data = mesh_data(mesh->mesh);
    item.surface->set_geometry(data, level_of_detail(data, IsoWorker::kDetailTriangles));
    item.shown.triangles = mesh->mesh.F.rows();
    item.shown.vertices = mesh->mesh.V.rows();
    style(item);
    four_up_->scene()->look(document_.volume()         ? LookFrom::oblique
                            : mesh->mesh.space.empty() ? LookFrom::upright
                                                       : LookFrom::oblique);
  }
  show_list();
  if (list_->currentRow() < 0) list_->setCurrentRow(0);
  show_selected();
}

SurfaceView::Item& SurfaceView::add_item(double isovalue) {
  auto item = std::make_unique<Item>();
  item->id = next_id_++;
  item->isovalue = isovalue;
  item->color = surface_color(next_color_++);
  SceneWidget* scene = four_up_->scene();
  item->surface = scene->add_surface();
  item->surface->actor()->SetVisibility(0);
  scene->renderer()->AddActor(item->zero_actor);
  scene->renderer()->AddActor(item->line_actor);
  items_.push_back(std::move(item));
  style(*items_.back());
  return *items_.back();
}

void SurfaceView::drop(std::size_t index) {
  Item& item = *items_[index];
  if (worker_ && !item.mesh) worker_->forget(item.id);
  SceneWidget* scene = four_up_->scene();
  scene->remove(item.surface);
  scene->renderer()->RemoveActor(item.zero_actor);
  scene->renderer()->RemoveActor(item.line_actor);
  items_.erase(items_.begin() + static_cast<std::ptrdiff_t>(index));
  scene->redraw();
}

SurfaceView::Item* SurfaceView::item_of(int id) {
  const auto found =
      std::find_if(items_.begin(), items_.end(), [id](const auto& item) { return item->id == id; });
  return found == items_.end() ? nullptr : found->get();
}

SurfaceView::Item* SurfaceView::selected() const {
  const int row = list_->currentRow();
  return row >= 0 && row < static_cast<int>(items_.size())
             ? items_[static_cast<std::size_t>(row)].get()
             : nullptr;
}

double SurfaceView::isovalue() const {
  const Item* item = selected();
  return item == nullptr ? 0.0 : item->isovalue;
}

std::int64_t SurfaceView::triangles() const {
  const Item* item = selected();
  return item == nullptr ? 0 : item->shown.triangles;
}

double SurfaceView::surface_megabytes() const {
  double kibibytes = 0.0;
  for (const auto& item : items_) {
    if (item->shown.data) kibibytes += static_cast<double>(item->shown.data->GetActualMemorySize());
  }
  return kibibytes / 1024.0;
}

IsoWish SurfaceView::wish_of(const Item& item) const {
  IsoWish wish;
  wish.isovalue = item.isovalue;
  wish.inside = item.below ? zmc::Inside::below : zmc::Inside::above;
  wish.flying_edges = method_->currentIndex() == 1;
  wish.marks = marks_->isChecked();
  return wish;
}

void SurfaceView::request(Item& item, bool coarse) {
  if (!worker_ || item.mesh) return;
  if (!active_) {  // made when the view comes to the front
    waiting_ = true;
    return;
  }
  if (coarse) {
    IsoWish wish = wish_of(item);
    for (int axis = 0; contours_->isChecked() && axis < 3; ++axis)
      wish.slices[static_cast<std::size_t>(axis)] = four_up_->slice(axis)->slice();
    worker_->request_coarse(item.id, wish);
  } else {
    item.wished = worker_->request_full(item.id, wish_of(item));
  }
  emit busy_changed();
}

void SurfaceView::request_all() {
  for (const auto& item : items_) request(*item, false);
}

void SurfaceView::take(IsoResult result) {
  Item* item = item_of(result.surface);
  // A result that a newer one has overtaken, or of a surface that has gone.
  if (item == nullptr || !worker_ || result.wish < item->newest) {
    emit busy_changed();
    return;
  }
  if (result.stage != IsoStage::coarse) tidy_->start();
  if (result.stage == IsoStage::detail) {
    if (result.wish == item->newest && item->shown.stage == IsoStage::full && item->shown.data)
      item->surface->set_geometry(item->shown.data, result.data);
    emit busy_changed();
    return;
  }
  item->newest = result.wish;
  item->surface->actor()->SetVisibility(item->visible && result.data != nullptr);
  if (result.data) item->surface->set_geometry(result.data, nullptr);
  if (!result.error.empty()) emit failed(QString::fromStdString(result.error));
  (result.stage == IsoStage::coarse ? coarse_updates_ : full_updates_) += 1;
  item->shown = std::move(result);
  item->zero_mapper->SetInputData(item->shown.zero_faces);
  item->line_mapper->SetInputData(item->shown.nonmanifold);
  show_marks();
  if (item->shown.data && ready_to_look_) {
    ready_to_look_ = false;
    four_up_->scene()->look(LookFrom::oblique);
  }
  four_up_->scene()->redraw();
  four_up_->refresh_outlines();
  show_facts();
  emit busy_changed();
}

bool SurfaceView::busy() const {
  return (worker_ && worker_->busy()) || settle_->isActive() || (active_ && waiting_);
}

double SurfaceView::slider_value() const {
  if (!volume_) return 0.0;
  const double share = slider_->value() / static_cast<double>(kSliderSteps);
  const double value = volume_->minimum + share * (volume_->maximum - volume_->minimum);
  const bool fine = volume_->maximum - volume_->minimum < 2.0 * kSliderSteps ||
                    volume_->volume.view.type == zmc::SampleType::float32 ||
                    volume_->volume.view.type == zmc::SampleType::float64;
  return fine ? value : std::round(value);
}

void SurfaceView::slider_moved() {
  set_isovalue(slider_value(), true);
  if (!slider_->isSliderDown()) {  // keys, wheel: the full surface when they come to rest
    settle_->start();
    emit edited();
  }
}

void SurfaceView::set_isovalue(double isovalue, bool dragging) {
  Item* item = selected();
  if (item == nullptr || item->mesh) return;
  item->isovalue = isovalue;
  request(*item, dragging);
  if (!dragging) {
    const QSignalBlocker quiet(slider_);
    slider_->setValue(
        static_cast<int>(std::lround(kSliderSteps * (isovalue - volume_->minimum) /
                                     std::max(volume_->maximum - volume_->minimum, 1e-300))));
  } else {
    const QSignalBlocker quiet(isovalue_);
    isovalue_->setValue(isovalue);
  }
  list_->currentItem()->setText(item->title());
  if (!worker_ || !worker_->busy()) four_up_->refresh_outlines();  // else with the surface
}

void SurfaceView::add_surface() {
  if (!volume_) return;
  const Item* item = selected();
  const double from =
      item == nullptr || item->mesh
          ? default_isovalue(volume_->volume.view, volume_->minimum, volume_->maximum)
          : item->isovalue;
  // Half-way to the nearer end of the window, where there is something else to see.
  const double to = document_.window().level;
  Item& added = add_item(std::clamp(std::abs(to - from) > 1e-9 ? (from + to) / 2.0 : from,
                                    volume_->minimum, volume_->maximum));
  added.opacity = 0.4;
  style(added);
  request(added, false);
  show_list();
  list_->setCurrentRow(static_cast<int>(items_.size()) - 1);
  emit edited();
}

void SurfaceView::remove_selected() {
  const int row = list_->currentRow();
  if (row < 0 || items_[static_cast<std::size_t>(row)]->mesh) return;
  drop(static_cast<std::size_t>(row));
  show_list();
  list_->setCurrentRow(std::min(row, static_cast<int>(items_.size()) - 1));
  four_up_->refresh_outlines();
  emit edited();
}

void SurfaceView::choose_color() {
  Item* item = selected();
  if (item == nullptr) return;
  const QColor chosen = QColorDialog::getColor(item->color, panel_, "Colour of the surface");
  if (!chosen.isValid()) return;
  item->color = chosen;
  style(*item);
  show_list();
  four_up_->refresh_outlines();
  emit edited();
}

void SurfaceView::style(Item& item) {
  vtkProperty* material = item.surface->property();
  material->SetColor(item.color.redF(), item.color.greenF(), item.color.blueF());
  material->SetOpacity(item.opacity);
  const bool has_data = item.mesh != nullptr || item.shown.data != nullptr;
  item.surface->actor()->SetVisibility(item.visible && has_data);
  const bool transparent = std::any_of(items_.begin(), items_.end(), [](const auto& other) {
    return other->visible && other->opacity < 1.0;
  });
  four_up_->scene()->set_transparency(transparent);
  show_marks();
  four_up_->scene()->redraw();
}

void SurfaceView::show_marks() {
  for (const auto& item : items_) {
    const bool on = marks_->isChecked() && item->visible;
    item->zero_actor->SetVisibility(on && item->shown.zero_faces);
    item->line_actor->SetVisibility(on && item->shown.nonmanifold);
  }
  four_up_->scene()->redraw();
}

void SurfaceView::show_list() {
  const QSignalBlocker quiet(list_);
  const int row = list_->currentRow();
  list_->clear();
  for (const auto& item : items_) {
    QPixmap swatch(14, 14);
    swatch.fill(item->color);
    QIcon icon(swatch);
    icon.addPixmap(swatch, QIcon::Selected);  // not tinted
    list_->addItem(new QListWidgetItem(icon, item->title()));
  }
  list_->setCurrentRow(std::min(row, list_->count() - 1));
  show_selected();
}

void SurfaceView::show_selected() {
  const Item* item = selected();
  const bool iso = item != nullptr && !item->mesh && volume_;
  for (QWidget* control : std::initializer_list<QWidget*>{slider_, isovalue_, below_, remove_})
    control->setEnabled(iso);
  for (QWidget* control : std::initializer_list<QWidget*>{color_, opacity_, visible_})
    control->setEnabled(item != nullptr);
  add_->setEnabled(volume_ != nullptr);
  if (item != nullptr) {
    const QSignalBlocker quiet_a(opacity_), quiet_b(slider_), quiet_c(isovalue_);
    opacity_->setValue(static_cast<int>(std::lround(100.0 * item->opacity)));
    visible_->setChecked(item->visible);
    below_->setChecked(item->below);
    QPixmap swatch(28, 14);
    swatch.fill(item->color);
    color_->setIcon(QIcon(swatch));
    if (iso) {
      isovalue_->setValue(item->isovalue);
      slider_->setValue(
          static_cast<int>(std::lround(kSliderSteps * (item->isovalue - volume_->minimum) /
                                       std::max(volume_->maximum - volume_->minimum, 1e-300))));
    }
  }
  show_facts();
}

void SurfaceView::show_facts() {
  const Item* item = selected();
  if (item == nullptr) {
    facts_->clear();
    return;
  }
  const IsoResult& shown = item->shown;
  const QLocale locale(QLocale::English);
  QString text = locale.toString(static_cast<qlonglong>(shown.triangles)) + " triangles, " +
                 locale.toString(static_cast<qlonglong>(shown.vertices)) + " vertices";
  if (!item->mesh) {
    if (shown.wish != 0 && shown.data == nullptr && shown.error.empty()) {
      text = "The surface is empty: no sample is on the other side of this value";
    } else {
      text += QString("\n%1 %2 in %3 ms")
                  .arg(shown.of.flying_edges ? "vtkFlyingEdges3D" : "ZMC",
                       shown.stage == IsoStage::coarse ? "(preview)" : "(full)",
                       QString::number(1e3 * shown.seconds, 'f', shown.seconds < 0.01 ? 1 : 0));
      if (shown.of.marks && !shown.of.flying_edges && shown.stage == IsoStage::full)
        text += QString("\n%1 zero faces, %2 non-manifold edges")
                    .arg(locale.toString(static_cast<qlonglong>(shown.counts.zero_faces)),
                         locale.toString(static_cast<qlonglong>(shown.nonmanifold_edges)));
    }
  }
  facts_->setText(text);
}

void SurfaceView::reset() {
  for (std::size_t n = items_.size(); n-- > 0;) {
    if (!items_[n]->mesh) drop(n);
  }
  next_color_ = 0;
  marks_->setChecked(false);
  contours_->setChecked(true);
  method_->setCurrentIndex(0);
  if (volume_) {
    request(add_item(default_isovalue(volume_->volume.view, volume_->minimum, volume_->maximum)),
            false);
  }
  for (const auto& item : items_) {
    item->opacity = 1.0;
    item->visible = true;
    style(*item);
  }
  show_list();
  list_->setCurrentRow(0);
  four_up_->set_planes_visible(false);
  four_up_->reset();
  four_up_->refresh_outlines();
}

std::vector<KeyHelp> SurfaceView::keys() const {
  return {{"slider", "isovalue: a coarse surface while dragging, the full one on release"},
          {"[  ]", "isovalue a step down, up"},
          {"C", "contours on the slices"},
          {"H", "zero faces (red) and non-manifold edges (blue)"},
          {"F", "ZMC or vtkFlyingEdges3D"},
          {"P", "slices in the 3D view"},
          {"left drag", "turn; in a slice: crosshair"},
          {"double click", "one of the four alone, and back"}};
}

void SurfaceView::set_theme(const Theme& theme) { four_up_->set_theme(theme); }

void SurfaceView::set_active(bool active) {
  active_ = active;
  four_up_->set_active(active);
  if (active_ && waiting_) {
    waiting_ = false;
    request_all();
  }
}

}  // namespace shape3d::apps::viewer
