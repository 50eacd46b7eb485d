#pragma once

#include <memory>
#include <vector>

#include <QColor>
#include <QPolygonF>
#include <QWidget>

namespace shape3d::apps::viewer {

struct CollectionMap;
struct Theme;

/// The U-matrix of a map and its units with labels, side by side as in Fig. 4.6. A click chooses a
/// unit.
class SomWidget : public QWidget {
  Q_OBJECT

 public:
  explicit SomWidget(QWidget* parent = nullptr);

  void set_map(std::shared_ptr<const CollectionMap> map);
  /// @param shape_names  The names of the shapes nearest to the prototypes instead of classes.
  void set_labels(bool shape_names);
  void set_borders(bool on);  ///< Between clusters of units.
  void set_chosen(int unit);  ///< −1: none.
  [[nodiscard]] int chosen() const { return chosen_; }
  void set_theme(const Theme& theme);

  /// The middle of a unit in the right part, and in the left one.
  [[nodiscard]] QPointF place_of(int unit) const;
  [[nodiscard]] QPointF place_in_matrix(int unit) const;
  /// The unit at a place of either part; −1: none.
  [[nodiscard]] int unit_at(const QPointF& place) const;

 signals:
  /// @param unit  −1: none, beside the map.
  void clicked(int unit);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;
  bool event(QEvent* event) override;

 private:
  // Where one of the two parts is: a place (x, y) of the map is at origin + scale (x, y).
  struct Frame {
    QPointF origin;
    double scale = 1.0;
    QRectF area;
    [[nodiscard]] QPointF to_widget(double x, double y) const {
      return origin + scale * QPointF(x, y);
    }
  };
  [[nodiscard]] Frame frame(bool right) const;
  [[nodiscard]] QPolygonF cell(const Frame& frame, double x, double y, double pitch) const;
  void paint_u_matrix(QPainter& painter, const Frame& frame);
  void paint_bar(QPainter& painter, const Frame& frame);
  void paint_units(QPainter& painter, const Frame& frame);
  void paint_borders(QPainter& painter, const Frame& frame);
  void mark(QPainter& painter, const Frame& frame, int unit, const QColor& color, double width);
  [[nodiscard]] QString label_of(int unit) const;

  std::shared_ptr<const CollectionMap> map_;
  bool shape_names_ = false, borders_ = true;
  int chosen_ = -1, hovered_ = -1;
  QColor background_, text_, faint_, accent_;
};

}  // namespace shape3d::apps::viewer
