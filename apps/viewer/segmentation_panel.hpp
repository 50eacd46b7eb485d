#pragma once

#include <array>

#include <QWidget>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QProgressBar;
class QPushButton;
class QSpinBox;

namespace shape3d::apps::viewer {

/// The controls of SegmentationView.
class SegmentationPanel : public QWidget {
 public:
  SegmentationPanel();

  std::array<QSpinBox*, 6> region{};  ///< x0 x1 y0 y1 z0 z1, half-open.
  QPushButton *draw, *whole, *run, *cancel, *truth;
  QComboBox *start, *classes, *inside;
  QDoubleSpinBox *radius, *curvature;
  QCheckBox *calibrated, *charts;
  QProgressBar* progress;
  QLabel *stage, *truth_name, *facts;
};

}  // namespace shape3d::apps::viewer
