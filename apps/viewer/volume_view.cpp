#include "volume_view.hpp"

#include <cmath>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileInfo>
#include <QFormLayout>
#include <QGroupBox>
#include <QLabel>
#include <QShortcut>
#include <QVBoxLayout>
#include <nlohmann/json.hpp>

#include "common/text.hpp"
#include "document.hpp"
#include "four_up.hpp"
#include "scene_widget.hpp"

namespace shape3d::apps::viewer {

QString missing_volume(const Document& document) {
  if (document.volume()) return {};
  if (document.loading() > 0) return "Reading …";
  return "Open a volume: drop a file or a DICOM folder here, or press Ctrl+O";
}

VolumeView::VolumeView(Document& document)
    : View("volume", "Volume"), document_(document), four_up_(new FourUp(document)) {
  make_panel();
  connect(four_up_, &FourUp::window_edited, &document_, &Document::window_edited);
  // In the slices of any view: the window is a parameter of this one.
  connect(&document_, &Document::window_edited, this, &View::edited);
  connect(&document_, &Document::window_changed, this, &VolumeView::show_window);
  connect(&document_, &Document::volume_changed, this, &VolumeView::show_facts);
  const auto add_step = [this](Qt::Key key, int step) {
    auto* shortcut = new QShortcut(key, four_up_);
    connect(shortcut, &QShortcut::activated, this, [this, step] {
      const auto volume = document_.volume();
      if (!volume) return;
      Eigen::Vector3d place = document_.cursor();
      place[2] += step;
      document_.set_cursor(place);
    });
  };
  add_step(Qt::Key_PageUp, 1);
  add_step(Qt::Key_PageDown, -1);
  auto* planes = new QShortcut(Qt::Key_P, four_up_);
  connect(planes, &QShortcut::activated, planes_, &QCheckBox::click);
}

VolumeView::~VolumeView() = default;

QWidget* VolumeView::content() { return four_up_; }

QString VolumeView::missing() const { return missing_volume(document_); }

void VolumeView::make_panel() {
  panel_ = new QWidget;
  auto* column = new QVBoxLayout(panel_);
  auto* window = new QGroupBox("Window");
  auto* form = new QFormLayout(window);
  preset_ = new QComboBox;
  preset_->setObjectName("preset");
  preset_->addItem("Automatic", "automatic");
  for (const WindowPreset& preset : kWindowPresets)
    preset_->addItem(QString::fromUtf8(preset.title.data(), static_cast<int>(preset.title.size())),
                     QString::fromUtf8(preset.name.data(), static_cast<int>(preset.name.size())));
  preset_->addItem("Own", "own");
  form->addRow("Preset", preset_);
  for (QDoubleSpinBox** box : {&level_, &width_}) {
    *box = new QDoubleSpinBox;
    (*box)->setRange(-1e9, 1e9);
    (*box)->setDecimals(1);
    (*box)->setKeyboardTracking(false);
    (*box)->setSingleStep(10.0);
  }
  width_->setMinimum(1e-3);
  width_->setDecimals(3);
  level_->setObjectName("level");
  width_->setObjectName("width");
  form->addRow("Level", level_);
  form->addRow("Width", width_);
  auto* hint = new QLabel("Right drag in a slice changes both.");
  hint->setWordWrap(true);
  form->addRow(hint);
  column->addWidget(window);

  planes_ = new QCheckBox("Slices in the 3D view");
  planes_->setChecked(true);
  column->addWidget(planes_);

  auto* about = new QGroupBox("Volume");
  auto* about_column = new QVBoxLayout(about);
  facts_ = new QLabel;
  facts_->setWordWrap(true);
  facts_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  about_column->addWidget(facts_);
  column->addWidget(about);
  column->addStretch(1);

  connect(preset_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    const std::string name = preset_->currentData().toString().toStdString();
    const auto volume = document_.volume();
    if (name == "automatic" && volume) document_.set_window(volume->automatic);
    if (const auto preset = window_preset(name)) document_.set_window(*preset);
    emit edited();
  });
  for (QDoubleSpinBox* box : {level_, width_}) {
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this] {
      document_.set_window({level_->value(), width_->value()});
      emit edited();
    });
  }
  connect(planes_, &QCheckBox::clicked, this, [this](bool on) {
    four_up_->set_planes_visible(on);
    emit edited();
  });
}

void VolumeView::show_window() {
  const Window& window = document_.window();
  for (const auto& [box, value] :
       {std::pair{level_, window.level}, std::pair{width_, window.width}}) {
    const QSignalBlocker quiet(box);
    box->setSingleStep(std::max(window.width / 40.0, 1e-3));
    box->setValue(value);
  }
  QString name = "own";
  const auto volume = document_.volume();
  if (volume && window == volume->automatic) name = "automatic";
  for (const WindowPreset& preset : kWindowPresets) {
    if (window == preset.window)
      name = QString::fromUtf8(preset.name.data(), static_cast<int>(preset.name.size()));
  }
  preset_->setCurrentIndex(preset_->findData(name));
}

void VolumeView::show_facts() {
  const auto volume = document_.volume();
  if (!volume) {
    facts_->clear();
    return;
  }
  const zmc::VolumeView& view = volume->volume.view;
  const auto text = [](const std::string& words) {
    return QString::fromStdString(words).toHtmlEscaped();
  };
  const auto rounded = [](double value) { return QString::number(value, 'g', 5); };
  facts_->setText(
      QString("<b>%1</b><br>%2 samples, %3<br>%4 × %5 × %6 mm apart<br>values %7 … %8<br>%9")
          .arg(text(QFileInfo(QString::fromStdString(volume->path)).fileName().toStdString()),
               text(to_text(view.dims)), text(std::string(zmc::to_string(view.type))),
               rounded(view.spacing.x()), rounded(view.spacing.y()), rounded(view.spacing.z()),
               rounded(volume->minimum), rounded(volume->maximum), text(volume->volume.format)));
}

nlohmann::json VolumeView::state() const {
  const Window& window = document_.window();
  const Eigen::Vector3d& cursor = document_.cursor();
  return {{"window", {{"level", window.level}, {"width", window.width}}},
          {"cursor", {cursor[0], cursor[1], cursor[2]}},
          {"layout", four_up_->state()}};
}

void VolumeView::set_state(const nlohmann::json& state) {
  if (state.contains("window")) {
    const nlohmann::json& given = state["window"];
    if (given.is_string()) {
      const auto preset = window_preset(given.get<std::string>());
      if (!preset)
        throw std::invalid_argument("window is " + given.dump() +
                                    "; expected lung, bone, soft-tissue or abdomen");
      document_.set_window(*preset);
    } else {
      const Window window{given.at("level").get<double>(), given.at("width").get<double>()};
      if (!std::isfinite(window.level) || !(window.width > 0.0))
        throw std::invalid_argument("window has width " + given.at("width").dump() +
                                    "; expected a positive number");
      document_.set_window(window);
    }
  }
  if (state.contains("cursor")) {
    const auto place = state["cursor"].get<std::array<double, 3>>();
    document_.set_cursor({place[0], place[1], place[2]});
  }
  if (state.contains("layout")) four_up_->set_state(state["layout"]);
  planes_->setChecked(four_up_->planes_visible());
}

void VolumeView::reset() {
  const auto volume = document_.volume();
  if (!volume) return;
  document_.set_window(volume->automatic);
  Eigen::Vector3d middle;
  for (std::size_t axis = 0; axis < 3; ++axis)
    middle[static_cast<Eigen::Index>(axis)] =
        static_cast<double>(volume->volume.view.dims[axis] / 2);
  document_.set_cursor(middle);
  four_up_->set_planes_visible(true);
  planes_->setChecked(true);
  four_up_->reset();
}

std::vector<KeyHelp> VolumeView::keys() const {
  return {{"left drag", "crosshair; also Shift and the mouse"},
          {"right drag", "window (across) and level (up and down)"},
          {"wheel", "slices; Ctrl and the wheel zoom, the middle button moves"},
          {"Page Up/Down", "slices along k"},
          {"P", "slices in the 3D view"},
          {"double click", "one of the four alone, and back"}};
}

void VolumeView::set_theme(const Theme& theme) { four_up_->set_theme(theme); }

void VolumeView::set_active(bool active) { four_up_->set_active(active); }

}  // namespace shape3d::apps::viewer
