#include "segmentation_view.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QShortcut>
#include <QSpinBox>
#include <QSplitter>
#include <nlohmann/json.hpp>

#include "chart_widget.hpp"
#include "common/segmentation_charts.hpp"
#include "document.hpp"
#include "four_up.hpp"
#include "model/slice_image.hpp"
#include "scene_widget.hpp"
#include "segmentation_panel.hpp"
#include "volume_view.hpp"

namespace shape3d::apps::viewer {
namespace {

const QColor kFrontColor(80, 160, 255), kTruthColor(255, 90, 80);

}  // namespace

SegmentationView::SegmentationView(Document& document)
    : View("segmentation", "Segmentation"),
      document_(document),
      panel_(new SegmentationPanel),
      content_(new QSplitter(Qt::Vertical)),
      four_up_(new FourUp(document)) {
  content_->addWidget(four_up_);
  auto* charts = new QSplitter(Qt::Horizontal);
  charts_ = charts;
  histogram_ = new ChartWidget;
  overlap_ = new ChartWidget;
  charts->addWidget(histogram_);
  charts->addWidget(overlap_);
  charts->setSizes({1000, 1000});
  content_->addWidget(charts_);
  content_->setSizes({1000, 560});
  content_->setChildrenCollapsible(false);
  charts_->setMinimumHeight(200);
  charts_->hide();

  SceneWidget* scene = four_up_->scene();
  surface_ = scene->add_surface();
  truth_surface_ = scene->add_surface();
  surface_->property()->SetColor(kFrontColor.redF(), kFrontColor.greenF(), kFrontColor.blueF());
  truth_surface_->property()->SetColor(kTruthColor.redF(), kTruthColor.greenF(),
                                       kTruthColor.blueF());
  truth_surface_->property()->SetOpacity(0.35);
  surface_->actor()->SetVisibility(0);
  truth_surface_->actor()->SetVisibility(0);
  four_up_->set_planes_visible(false);
  four_up_->set_outline_maker([this](const SliceGeometry& geometry, std::int64_t slice) {
    return outlines(geometry, slice);
  });
  for (int axis = 0; axis < 3; ++axis) {
    connect(four_up_->slice(axis), &SliceWidget::box_edited, this,
            [this](const VoxelBox& box, bool finished) {
              set_region(box);
              if (finished) emit edited();
            });
  }
  connect(four_up_, &FourUp::window_edited, &document_, &Document::window_edited);
  connect(&document_, &Document::volume_changed, this, &SegmentationView::take_volume);
  connect_panel();
  connect(new QShortcut(Qt::Key_G, content_), &QShortcut::activated, panel_->charts,
          &QCheckBox::click);
  connect(new QShortcut(Qt::Key_D, content_), &QShortcut::activated, panel_->draw,
          &QPushButton::click);
  connect(new QShortcut(Qt::Key_Return, content_), &QShortcut::activated, this,
          &SegmentationView::run);
  connect(new QShortcut(Qt::Key_Escape, content_), &QShortcut::activated, this,
          &SegmentationView::cancel);
}

SegmentationView::~SegmentationView() = default;

QWidget* SegmentationView::content() { return content_; }

QWidget* SegmentationView::panel() { return panel_; }

QString SegmentationView::missing() const { return missing_volume(document_); }

void SegmentationView::connect_panel() {
  for (QSpinBox* spin : panel_->region)
    connect(spin, QOverload<int>::of(&QSpinBox::valueChanged), this, [this] {
      type_region();
      emit edited();
    });
  connect(panel_->draw, &QPushButton::toggled, this, [this](bool on) {
    for (int axis = 0; axis < 3; ++axis) four_up_->slice(axis)->set_box_tool(on);
  });
  connect(panel_->whole, &QPushButton::clicked, this, [this] {
    if (!volume_) return;
    set_region({{0, 0, 0}, volume_->volume.view.dims});
    emit edited();
  });
  connect(panel_->run, &QPushButton::clicked, this, &SegmentationView::run);
  connect(panel_->cancel, &QPushButton::clicked, this, &SegmentationView::cancel);
  connect(panel_->truth, &QPushButton::clicked, this, [this] {
    const QString path = QFileDialog::getOpenFileName(panel_, "A mask of the same samples");
    if (path.isEmpty()) return;
    truth_ = path.toStdString();
    panel_->truth_name->setText(QFileInfo(path).fileName());
    emit edited();
    run();
  });
  for (QComboBox* box : {panel_->start, panel_->classes, panel_->inside})
    connect(box, QOverload<int>::of(&QComboBox::activated), this, &View::edited);
  for (QDoubleSpinBox* box : {panel_->radius, panel_->curvature})
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, &View::edited);
  connect(panel_->calibrated, &QCheckBox::clicked, this, &View::edited);
  connect(panel_->charts, &QCheckBox::clicked, this, [this](bool on) {
    set_charts_visible(on);
    emit edited();
  });
}

void SegmentationView::take_volume() {
  const auto volume = document_.volume();
  if (volume == volume_) return;
  worker_.reset();
  ++run_number_;
  volume_ = volume;
  forget_result();
  if (volume_) {
    const auto& dims = volume_->volume.view.dims;
    // The middle half along each axis: what is looked at, and soon done.
    VoxelBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t margin = dims[axis] >= 16 ? dims[axis] / 4 : 0;
      box.lower[axis] = margin;
      box.upper[axis] = dims[axis] - margin;
      for (std::size_t side = 0; side < 2; ++side) {
        const QSignalBlocker quiet(panel_->region[2 * axis + side]);
        panel_->region[2 * axis + side]->setRange(0, static_cast<int>(dims[axis]));
      }
    }
    set_region(box);
  }
  show_running();
  emit busy_changed();
}

void SegmentationView::set_region(const VoxelBox& region) {
  region_ = region;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::array<std::int64_t, 2> ends{region.lower[axis], region.upper[axis]};
    for (std::size_t side = 0; side < 2; ++side) {
      QSpinBox* spin = panel_->region[2 * axis + side];
      const QSignalBlocker quiet(spin);
      spin->setValue(static_cast<int>(ends[side]));
    }
  }
  for (int axis = 0; axis < 3; ++axis) four_up_->slice(axis)->set_box(region_);
}

void SegmentationView::type_region() {
  if (!volume_) return;
  VoxelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t size = volume_->volume.view.dims[axis];
    // Two samples at least; the end that was not typed gives way.
    box.lower[axis] = std::min<std::int64_t>(panel_->region[2 * axis]->value(), size - 2);
    box.upper[axis] = std::min<std::int64_t>(
        std::max<std::int64_t>(panel_->region[2 * axis + 1]->value(), box.lower[axis] + 2), size);
  }
  set_region(box);
}

SegmentWish SegmentationView::wish() const {
  SegmentWish wish;
  wish.volume = std::shared_ptr<const Volume>(volume_, &volume_->volume);
  wish.lower = region_.lower;
  wish.upper = region_.upper;
  const QString classes = panel_->classes->currentText();
  wish.options.mixture.classes = classes == "auto" ? 0 : classes.toInt();
  wish.options.inside.inside =
      panel_->inside->currentText() == "dark" ? levelset::Inside::dark : levelset::Inside::bright;
  wish.options.evolution.curvature = panel_->curvature->value();
  wish.options.calibrated = panel_->calibrated->isChecked();
  if (panel_->start->currentIndex() == 1) {
    wish.radius = panel_->radius->value();
    wish.seed = document_.cursor();
  }
  wish.truth = truth_;
  return wish;
}

void SegmentationView::run() {
  if (!volume_) return;
  forget_result();
  SegmentWish wanted = wish();
  if (wanted.radius > 0.0) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = wanted.seed[static_cast<Eigen::Index>(axis)];
      if (place < static_cast<double>(region_.lower[axis]) ||
          place > static_cast<double>(region_.upper[axis] - 1)) {
        emit failed("The crosshair is outside the region: a ball cannot start there");
        return;
      }
    }
  }
  const int number = ++run_number_;
  worker_ = std::make_unique<SegmentWorker>(
      [this, number](SegmentUpdate update) {
        call_later(this, [this, number, update = std::move(update)] {
          if (number == run_number_) take(update);
        });
      },
      [this, number](SegmentOutcome outcome) {
        call_later(this, [this, number, outcome = std::move(outcome)] {
          if (number == run_number_) take(outcome);
        });
      });
  worker_->start(std::move(wanted));
  show_running();
  emit busy_changed();
}

void SegmentationView::cancel() {
  if (worker_) worker_->cancel();
}

bool SegmentationView::busy() const { return worker_ != nullptr; }

void SegmentationView::take(const SegmentUpdate& update) {
  // The number of the iteration stays until the next picture of the front.
  if (frames_ == 0 || update.stage != "evolution")
    panel_->stage->setText(QString::fromStdString(update.stage) + " …");
  if (update.share >= 0.0) panel_->progress->setValue(static_cast<int>(1000 * update.share));
  if (update.front) {
    ++frames_;
    panel_->stage->setText(QString("evolution, iteration %1").arg(update.front->iteration));
    show_front(update.front);
  }
}

void SegmentationView::take(SegmentOutcome outcome) {
  worker_.reset();
  outcome_ = std::move(outcome);
  if (!outcome_.error.empty()) emit failed(QString::fromStdString(outcome_.error));
  if (outcome_.front) show_front(outcome_.front);
  show_outcome();
  show_running();
  emit busy_changed();
}

void SegmentationView::show_front(const std::shared_ptr<const Front>& front) {
  front_ = front;
  const bool there = front_ && front_->surface;
  if (there) surface_->set_geometry(front_->surface, nullptr);
  surface_->actor()->SetVisibility(there);
  four_up_->refresh_outlines();
  four_up_->scene()->redraw();
}

void SegmentationView::forget_result() {
  outcome_ = {};
  frames_ = 0;
  panel_->facts->clear();
  panel_->stage->clear();
  panel_->progress->setValue(0);
  truth_surface_->actor()->SetVisibility(0);
  histogram_->clear();
  overlap_->clear();
  charts_->hide();
  show_front(nullptr);
}

void SegmentationView::show_outcome() {
  const bool truth = outcome_.truth && outcome_.truth->surface;
  if (truth) truth_surface_->set_geometry(outcome_.truth->surface, nullptr);
  truth_surface_->actor()->SetVisibility(truth);
  four_up_->scene()->set_transparency(truth);
  const auto& found = outcome_.segmentation;
  if (!found) return;
  const QLocale locale(QLocale::English);
  const auto number = [&locale](double value) { return locale.toString(value, 'g', 4); };
  const auto status = levelset::to_string(found->status);
  QString text = QString::fromUtf8(status.data(), static_cast<int>(status.size()));
  if (!outcome_.cancelled) {
    text += QString("\nvolume %1 cm³, %2 voxels")
                .arg(number(found->volume / 1000.0),
                     locale.toString(static_cast<qlonglong>(found->inside)));
    if (!found->calibration.levels.empty())
      text += "\nboundary at " + number(found->calibration.levels.front());
    text += QString("\n%1 iterations, %2 s")
                .arg(found->evolution.iterations.size())
                .arg(number(found->timings.estimation() + found->timings.evolution));
  }
  if (outcome_.agreement) {
    text += "\nDice " + locale.toString(outcome_.agreement->dice, 'f', 4);
    if (outcome_.agreement->hausdorff95)
      text += ", 95 % Hausdorff " + number(*outcome_.agreement->hausdorff95) + " mm";
  }
  for (const std::string& warning : found->warnings) text += "\n" + QString::fromStdString(warning);
  panel_->facts->setText(text);
  if (found->histogram.bins() > 0 && found->fit.mixture.size() > 0) {
    Chart chart = histogram_chart(*found);
    chart.legend = LegendPlace::top_right;
    histogram_->set_chart(chart);
    if (!found->calibration.curve.empty()) overlap_->set_chart(overlap_chart(*found));
    overlap_->setVisible(!found->calibration.curve.empty());
  }
  set_charts_visible(panel_->charts->isChecked());
}

void SegmentationView::set_charts_visible(bool visible) {
  charts_->setVisible(visible && !histogram_->chart().series.empty());
}

void SegmentationView::show_running() {
  const bool running = worker_ != nullptr;
  panel_->run->setEnabled(volume_ && !running);
  panel_->cancel->setEnabled(running);
  panel_->progress->setVisible(running);
  if (!running) panel_->stage->clear();
  panel_->stage->setVisible(running);
}

std::vector<Outline> SegmentationView::outlines(const SliceGeometry& geometry,
                                                std::int64_t slice) const {
  std::vector<Outline> result;
  if (!volume_) return result;
  const auto add = [&](const std::shared_ptr<const Front>& front, const QColor& color) {
    if (!front) return;
    const auto axis = static_cast<std::size_t>(geometry.axis());
    const std::int64_t within = slice - front->lower[axis];
    if (within < 0 || within >= front->view.dims[axis]) return;
    Outline outline;
    outline.color = color;
    outline.width = 2.0;
    outline.lines = part_contour(volume_->volume.view, geometry, front->view, 0.0, within);
    result.push_back(std::move(outline));
  };
  add(outcome_.truth, kTruthColor);
  add(front_, kFrontColor);
  return result;
}

nlohmann::json SegmentationView::state() const {
  nlohmann::json region = nlohmann::json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    region.push_back(region_.lower[axis]);
    region.push_back(region_.upper[axis]);
  }
  return {{"roi", region},
          {"start", panel_->start->currentIndex() == 1 ? "ball" : "box"},
          {"radius", panel_->radius->value()},
          {"classes", panel_->classes->currentText().toStdString()},
          {"inside", panel_->inside->currentText().toStdString()},
          {"curvature", panel_->curvature->value()},
          {"calibrated", panel_->calibrated->isChecked()},
          {"truth", truth_},
          {"charts", panel_->charts->isChecked()},
          {"layout", four_up_->state()}};
}

void SegmentationView::set_state(const nlohmann::json& state) {
  {
    const QSignalBlocker quiet(this);  // controls that change are no edits of the user
    set_parameters(state);
  }
  if (state.contains("run") && state["run"].get<bool>()) {
    if (!volume_) throw std::invalid_argument("there is no volume to segment; expected one");
    run();
  }
}

void SegmentationView::set_parameters(const nlohmann::json& state) {
  if (state.contains("cursor")) {  // where a ball starts; in sessions it is the volume view's
    const auto place = state["cursor"].get<std::array<double, 3>>();
    document_.set_cursor({place[0], place[1], place[2]});
  }
  if (state.contains("roi") && volume_) {
    const auto ends = state["roi"].get<std::array<std::int64_t, 6>>();
    VoxelBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lower[axis] = ends[2 * axis];
      box.upper[axis] = ends[2 * axis + 1];
      const std::int64_t size = volume_->volume.view.dims[axis];
      if (box.lower[axis] < 0 || box.upper[axis] > size || box.upper[axis] < box.lower[axis] + 2)
        throw std::invalid_argument(
            "roi along " + std::string(1, "xyz"[axis]) + " is " + std::to_string(box.lower[axis]) +
            " to " + std::to_string(box.upper[axis]) +
            "; expected two samples or more within 0 to " + std::to_string(size));
    }
    set_region(box);
  }
  const auto choose = [&state](const char* name, QComboBox* box) {
    if (!state.contains(name)) return;
    const QString text = QString::fromStdString(state[name].get<std::string>());
    const int row = box->findText(text);
    if (row < 0)
      throw std::invalid_argument(std::string(name) + " is \"" + text.toStdString() +
                                  "\"; expected one of the list");
    box->setCurrentIndex(row);
  };
  choose("classes", panel_->classes);
  choose("inside", panel_->inside);
  if (state.contains("start"))
    panel_->start->setCurrentIndex(state["start"].get<std::string>() == "ball" ? 1 : 0);
  if (state.contains("radius")) panel_->radius->setValue(state["radius"].get<double>());
  if (state.contains("curvature")) panel_->curvature->setValue(state["curvature"].get<double>());
  if (state.contains("calibrated")) panel_->calibrated->setChecked(state["calibrated"].get<bool>());
  if (state.contains("truth")) {
    truth_ = state["truth"].get<std::string>();
    panel_->truth_name->setText(QFileInfo(QString::fromStdString(truth_)).fileName());
  }
  if (state.contains("charts")) {
    panel_->charts->setChecked(state["charts"].get<bool>());
    set_charts_visible(panel_->charts->isChecked());
  }
  if (state.contains("layout")) four_up_->set_state(state["layout"]);
}

void SegmentationView::reset() {
  worker_.reset();
  ++run_number_;
  volume_.reset();
  truth_.clear();
  panel_->truth_name->clear();
  panel_->start->setCurrentIndex(0);
  panel_->classes->setCurrentText("3");
  panel_->inside->setCurrentIndex(0);
  panel_->curvature->setValue(0.0);
  panel_->calibrated->setChecked(true);
  take_volume();
  four_up_->reset();
}

std::vector<KeyHelp> SegmentationView::keys() const {
  return {{"D", "draw the region: drag in a slice, or a side of the box"},
          {"Enter", "segment"},
          {"Esc", "cancel"},
          {"G", "charts: histogram with its mixture, S(w)"},
          {"blue, red", "the front; the mask it is compared with"}};
}

void SegmentationView::set_theme(const Theme& theme) {
  four_up_->set_theme(theme);
  histogram_->set_theme(theme);
  overlap_->set_theme(theme);
}

void SegmentationView::set_active(bool active) { four_up_->set_active(active); }

}  // namespace shape3d::apps::viewer
