#include "surface_panel.hpp"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QSlider>
#include <QVBoxLayout>

namespace shape3d::apps::viewer {

SurfacePanel::SurfacePanel(int slider_steps)
    : list(new QListWidget),
      add(new QPushButton("Add")),
      remove(new QPushButton("Remove")),
      color(new QPushButton("Colour …")),
      slider(new QSlider(Qt::Horizontal)),
      opacity(new QSlider(Qt::Horizontal)),
      isovalue(new QDoubleSpinBox),
      below(new QCheckBox("Inside is below the value")),
      contours(new QCheckBox("Contours on the slices")),
      marks(new QCheckBox("Mark zero faces and\nnon-manifold edges")),
      visible(new QCheckBox("Visible")),
      method(new QComboBox),
      facts(new QLabel) {
  auto* column = new QVBoxLayout(this);
  auto* surfaces = new QGroupBox("Surfaces");
  auto* surfaces_column = new QVBoxLayout(surfaces);
  list->setMaximumHeight(110);
  list->setObjectName("surfaces");
  color->setObjectName("color");
  surfaces_column->addWidget(list);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(add);
  buttons->addWidget(remove);
  surfaces_column->addLayout(buttons);
  column->addWidget(surfaces);

  auto* selected = new QGroupBox("Selected surface");
  auto* form = new QFormLayout(selected);
  isovalue->setKeyboardTracking(false);
  isovalue->setObjectName("isovalue");
  form->addRow("Isovalue", isovalue);
  slider->setRange(0, slider_steps);
  slider->setObjectName("isovalue-slider");
  form->addRow(slider);
  form->addRow(below);
  opacity->setRange(0, 100);
  opacity->setValue(100);
  opacity->setObjectName("opacity");
  form->addRow("Opacity", opacity);
  auto* look = new QHBoxLayout;
  look->addWidget(color);
  look->addWidget(visible);
  form->addRow(look);
  facts->setWordWrap(true);
  facts->setObjectName("facts");
  facts->setTextInteractionFlags(Qt::TextSelectableByMouse);
  form->addRow(facts);
  column->addWidget(selected);

  auto* all = new QGroupBox("All surfaces");
  auto* all_column = new QVBoxLayout(all);
  contours->setChecked(true);
  contours->setObjectName("contours");
  marks->setObjectName("marks");
  method->addItem("Zero-crossing Marching Cubes");
  method->addItem("vtkFlyingEdges3D");
  method->setObjectName("method");
  all_column->addWidget(method);
  all_column->addWidget(contours);
  all_column->addWidget(marks);
  column->addWidget(all);
  column->addStretch(1);
}

}  // namespace shape3d::apps::viewer
