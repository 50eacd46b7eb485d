#pragma once

#include <QWidget>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QListWidget;
class QPushButton;
class QSlider;

namespace shape3d::apps::viewer {

/// The controls of SurfaceView.
class SurfacePanel : public QWidget {
 public:
  explicit SurfacePanel(int slider_steps);

  QListWidget* list;
  QPushButton *add, *remove, *color;
  QSlider *slider, *opacity;
  QDoubleSpinBox* isovalue;
  QCheckBox *below, *contours, *marks, *visible;
  QComboBox* method;
  QLabel* facts;
};

}  // namespace shape3d::apps::viewer
