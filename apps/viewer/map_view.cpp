#include "map_view.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QLabel>
#include <QListWidget>
#include <QSplitter>
#include <QVBoxLayout>
#include <nlohmann/json.hpp>

#include "common/color_map.hpp"
#include "common/error.hpp"
#include "common/model_io.hpp"
#include "common/text.hpp"
#include "document.hpp"
#include "model_text.hpp"
#include "som_widget.hpp"
#include "theme.hpp"
#include "thumbnail_grid.hpp"

namespace shape3d::apps::viewer {
namespace {

namespace fs = std::filesystem;

}  // namespace

MapView::MapView(Document& document)
    : View("map", "Map"),
      document_(document),
      content_(new QSplitter(Qt::Vertical)),
      som_(new SomWidget),
      grid_(new ThumbnailGrid) {
  content_->addWidget(som_);
  content_->addWidget(grid_);
  content_->setStretchFactor(0, 3);
  content_->setStretchFactor(1, 1);
  content_->setSizes({420, 240});
  content_->setChildrenCollapsible(false);
  grid_->set_picture_size(96);
  grid_->setMinimumHeight(120);
  grid_->set_pictures([this](std::int64_t key) { return picture(key); });
  make_panel();
  connect(som_, &SomWidget::clicked, this, [this](int unit) {
    choose(unit);
    emit edited();
  });
  connect(grid_, &ThumbnailGrid::clicked, this,
          [this](int cell, int /*modifiers*/) { open_shape(static_cast<std::size_t>(cell)); });
  connect(&document_, &Document::collection_changed, this, &MapView::take_collection);
  connect(&pictures_, &LibraryPictures::changed, grid_, &ThumbnailGrid::refresh);
  connect(&pictures_, &LibraryPictures::busy_changed, this, &MapView::busy_changed);
  connect(&pictures_, &LibraryPictures::failed, this, &MapView::failed);
}

MapView::~MapView() = default;

QWidget* MapView::content() { return content_; }

QString MapView::missing() const {
  if (map_) return {};
  return "Open the map of a collection: drop its file (.model) here, or press Ctrl+O.\n"
         "'shape3d train som' makes one. With the shape library (.db), units show their shapes.";
}

void MapView::make_panel() {
  panel_ = new QWidget;
  auto* column = new QVBoxLayout(panel_);
  auto* map = new QGroupBox("Map");
  auto* form = new QFormLayout(map);
  about_ = new QLabel;
  about_->setWordWrap(true);
  about_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  form->addRow(about_);
  labels_ = new QComboBox;
  labels_->setObjectName("labels");
  labels_->addItem("Classes", "class");
  labels_->addItem("Nearest shapes", "shape");
  form->addRow("Labels", labels_);
  borders_ = new QCheckBox("Borders of clusters");
  borders_->setObjectName("borders");
  borders_->setChecked(true);
  form->addRow(borders_);
  column->addWidget(map);
  auto* unit = new QGroupBox("Unit");
  auto* unit_column = new QVBoxLayout(unit);
  unit_ = new QLabel;
  unit_->setObjectName("unit");
  unit_->setWordWrap(true);
  unit_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  unit_column->addWidget(unit_);
  list_ = new QListWidget;
  list_->setObjectName("shapes");
  unit_column->addWidget(list_, 1);
  column->addWidget(unit, 1);

  connect(labels_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    som_->set_labels(labels_->currentData() == "shape");
    emit edited();
  });
  connect(borders_, &QCheckBox::clicked, this, [this](bool on) {
    som_->set_borders(on);
    emit edited();
  });
  connect(list_, &QListWidget::itemActivated, this,
          [this] { open_shape(static_cast<std::size_t>(list_->currentRow())); });
}

bool MapView::takes(const std::string& path) const {
  return lower_case(fs::path(path).extension().string()) == kModelExtension;
}

void MapView::open(const std::string& path) {
  const std::string whole = fs::absolute(path).lexically_normal().string();
  read_ = std::make_shared<const CollectionMap>(read_collection_map(whole));
  document_.set_collection_map(whole);
}

void MapView::take_collection() {
  const bool other_map = read_ != nullptr || document_.collection_map().empty();
  if (other_map) map_ = std::exchange(read_, nullptr);
  take_library();
  if (other_map) {
    som_->set_map(map_);
    if (!map_) {
      about_->clear();
    } else {
      const learning::SomGrid& grid = map_->model.som.grid;
      about_->setText(QString("<b>%1</b><br>%2 × %3 units, %4 shapes<br>%5")
                          .arg(text_of(fs::path(map_->path).filename().string()).toHtmlEscaped())
                          .arg(grid.rows)
                          .arg(grid.columns)
                          .arg(map_->shapes())
                          .arg(text_of(map_->descriptor).toHtmlEscaped().replace(",", ", ")));
    }
  }
  show_unit();
  emit ready_changed();
}

void MapView::take_library() {
  pictures_.clear();
  shapes_.clear();
  library_.reset();
  library_error_.clear();
  if (!map_ || document_.library().empty()) return;
  try {
    library_ = std::make_unique<ShapeLibrary>(document_.library(), ShapeLibrary::Access::read);
    shapes_ = shapes_of_units(*map_, *library_);
  } catch (const std::exception& error) {
    // Another collection's library: the map is shown without shapes.
    library_.reset();
    library_error_ = error.what();
  }
}

void MapView::choose(int unit) {
  som_->set_chosen(unit);
  show_unit();
}

QString MapView::about_unit() const {
  const int unit = som_->chosen();
  if (unit < 0) return "Click a unit to see its shapes.";
  const int hits = map_->model.hits[static_cast<std::size_t>(unit)];
  QString text = QString("Row %1, column %2: %3")
                     .arg(map_->row(unit) + 1)
                     .arg(map_->column(unit) + 1)
                     .arg(hits == 0   ? QString("no shape")
                          : hits == 1 ? QString("1 shape")
                                      : QString("%1 shapes").arg(hits));
  const std::string class_name = map_->class_of(unit);
  if (!class_name.empty()) text += ", most of class " + text_of(class_name);
  const std::string& name = map_->model.names[static_cast<std::size_t>(unit)];
  if (!name.empty()) text += "; nearest to its prototype: " + text_of(name);
  return text + ".";
}

void MapView::show_unit() {
  shown_.clear();
  list_->clear();
  std::vector<ThumbnailCell> cells;
  QString heading;
  if (map_) {
    const int unit = som_->chosen();
    heading = about_unit();
    unit_->setText(heading);
    if (unit >= 0 && !shapes_.empty()) shown_ = shapes_[static_cast<std::size_t>(unit)];
    if (!library_error_.empty()) {
      heading += " " + QString::fromStdString(library_error_);
    } else if (!library_) {
      heading += " Open the collection's shape library (.db) as well to see them all.";
    }
  } else {
    unit_->clear();
  }
  for (const UnitShape& shape : shown_) {
    const QString name = text_of(fs::path(shape.path).stem().string());
    const QString class_name = class_text(shape.class_name);
    list_->addItem(name + "  ·  " + class_name);
    ThumbnailCell cell;
    cell.key = shape.id;
    cell.first = name;
    cell.second = class_name;
    cell.third = "distance " + QString::number(shape.distance, 'g', 3);
    cell.tip = text_of(shape.path);
    // In the colour of its class on the map.
    if (shape.class_name) {
      const auto& names = map_->class_names;
      const auto place = std::find(names.begin(), names.end(), *shape.class_name);
      if (place != names.end()) {
        const Color color = light_color(static_cast<int>(place - names.begin()));
        cell.frame = QColor::fromRgbF(color[0], color[1], color[2]);
      }
    }
    cells.push_back(cell);
  }
  grid_->set_heading(heading);
  grid_->set_cells(std::move(cells));
  emit busy_changed();
}

void MapView::open_shape(std::size_t shape) {
  if (shape < shown_.size()) look_at(document_, shown_[shape].path);
}

QImage MapView::picture(std::int64_t key) {
  const auto shape = std::find_if(shown_.begin(), shown_.end(),
                                  [key](const UnitShape& other) { return other.id == key; });
  if (shape == shown_.end() || !library_) return pictures_.known(key);
  return pictures_.of(*library_, key, shape->path);
}

nlohmann::json MapView::state() const {
  nlohmann::json unit = nullptr;
  if (map_ && som_->chosen() >= 0)
    unit = {map_->row(som_->chosen()) + 1, map_->column(som_->chosen()) + 1};
  return {{"unit", unit},
          {"labels", labels_->currentData().toString().toStdString()},
          {"borders", borders_->isChecked()}};
}

void MapView::set_state(const nlohmann::json& state) {
  if (state.contains("labels")) {
    const auto name = state["labels"].get<std::string>();
    const int row = labels_->findData(QString::fromStdString(name));
    if (row < 0)
      throw std::invalid_argument("labels is " + state["labels"].dump() +
                                  "; expected class or shape");
    labels_->setCurrentIndex(row);
    som_->set_labels(name == "shape");
  }
  if (state.contains("borders")) {
    borders_->setChecked(state["borders"].get<bool>());
    som_->set_borders(borders_->isChecked());
  }
  if (!map_ || !state.contains("unit")) return;
  if (state["unit"].is_null()) {
    choose(-1);
    return;
  }
  const auto place = state["unit"].get<std::array<int, 2>>();
  const learning::SomGrid& grid = map_->model.som.grid;
  if (place[0] < 1 || place[0] > grid.rows || place[1] < 1 || place[1] > grid.columns)
    throw std::invalid_argument(
        "unit is " + state["unit"].dump() + "; expected [row, column] from [1, 1] to [" +
        std::to_string(grid.rows) + ", " + std::to_string(grid.columns) + "]");
  choose((place[0] - 1) * grid.columns + place[1] - 1);
}

void MapView::reset() { set_state({{"unit", nullptr}, {"labels", "class"}, {"borders", true}}); }

std::vector<KeyHelp> MapView::keys() const {
  return {{"click a unit", "shows its shapes"}, {"click a shape", "opens it"}};
}

void MapView::set_theme(const Theme& theme) {
  som_->set_theme(theme);
  grid_->set_theme(theme);
}

}  // namespace shape3d::apps::viewer
