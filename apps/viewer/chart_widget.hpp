#pragma once

#include <memory>

#include <QWidget>

#include "common/chart.hpp"
#include "theme.hpp"

namespace shape3d::apps::viewer {

/// A chart in the window, in the colours of the theme.
class ChartWidget : public QWidget {
 public:
  explicit ChartWidget(QWidget* parent = nullptr);
  ~ChartWidget() override;

  /// Takes the place of the chart before.
  void set_chart(const Chart& chart);
  void clear();
  void set_theme(const Theme& theme);
  [[nodiscard]] const Chart& chart() const { return chart_; }

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  void draw();

  struct Parts;
  std::unique_ptr<Parts> parts_;
  Chart chart_;
  Theme theme_;
};

}  // namespace shape3d::apps::viewer
