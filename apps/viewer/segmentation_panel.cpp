#include "segmentation_panel.hpp"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QGridLayout>
#include <QGroupBox>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>

namespace shape3d::apps::viewer {

SegmentationPanel::SegmentationPanel()
    : draw(new QPushButton("Draw in a slice")),
      whole(new QPushButton("Whole volume")),
      run(new QPushButton("Segment")),
      cancel(new QPushButton("Cancel")),
      truth(new QPushButton("Compare with a mask …")),
      start(new QComboBox),
      classes(new QComboBox),
      inside(new QComboBox),
      radius(new QDoubleSpinBox),
      curvature(new QDoubleSpinBox),
      calibrated(new QCheckBox("Calibrate the boundary")),
      charts(new QCheckBox("Charts")),
      progress(new QProgressBar),
      stage(new QLabel),
      truth_name(new QLabel),
      facts(new QLabel) {
  auto* column = new QVBoxLayout(this);
  auto* box = new QGroupBox("Region (voxels)");
  auto* grid = new QGridLayout(box);
  for (int axis = 0; axis < 3; ++axis) {
    grid->addWidget(new QLabel(QString("xyz").mid(axis, 1)), axis, 0);
    for (int side = 0; side < 2; ++side) {
      auto* spin = new QSpinBox;
      spin->setKeyboardTracking(false);
      spin->setObjectName(QString("region-%1").arg(2 * axis + side));
      region[static_cast<std::size_t>(2 * axis + side)] = spin;
      grid->addWidget(spin, axis, 1 + side);
    }
    grid->setColumnStretch(1, 1);
    grid->setColumnStretch(2, 1);
  }
  draw->setCheckable(true);
  draw->setObjectName("draw");
  whole->setObjectName("whole");
  grid->addWidget(draw, 3, 0, 1, 2);
  grid->addWidget(whole, 3, 2);
  column->addWidget(box);

  auto* model = new QGroupBox("Level set");
  auto* form = new QFormLayout(model);
  start->addItems({"the box", "a ball at the crosshair"});
  start->setObjectName("start");
  form->addRow("Start", start);
  radius->setRange(0.1, 1000.0);
  radius->setValue(5.0);
  radius->setSuffix(" mm");
  radius->setObjectName("radius");
  form->addRow("Radius", radius);
  classes->addItems({"auto", "2", "3", "4", "5", "6"});
  classes->setCurrentText("3");
  form->addRow("Classes", classes);
  inside->addItems({"bright", "dark"});
  form->addRow("Inside", inside);
  curvature->setRange(0.0, 10.0);
  curvature->setDecimals(3);
  curvature->setSingleStep(0.05);
  curvature->setSuffix(" mm");
  form->addRow("Curvature", curvature);
  calibrated->setChecked(true);
  form->addRow(calibrated);
  column->addWidget(model);

  auto* buttons = new QHBoxLayout;
  run->setObjectName("run");
  cancel->setObjectName("cancel");
  cancel->setEnabled(false);
  buttons->addWidget(run);
  buttons->addWidget(cancel);
  column->addLayout(buttons);
  progress->setRange(0, 1000);
  progress->setTextVisible(false);
  progress->setMaximumHeight(10);
  column->addWidget(progress);
  stage->setWordWrap(true);
  stage->setObjectName("stage");
  column->addWidget(stage);
  facts->setWordWrap(true);
  facts->setObjectName("facts");
  facts->setTextInteractionFlags(Qt::TextSelectableByMouse);
  column->addWidget(facts);
  column->addWidget(truth);
  truth_name->setWordWrap(true);
  column->addWidget(truth_name);
  charts->setChecked(true);
  charts->setObjectName("charts");
  column->addWidget(charts);
  column->addStretch(1);
}

}  // namespace shape3d::apps::viewer
