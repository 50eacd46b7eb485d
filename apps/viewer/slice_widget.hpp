#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <QColor>
#include <QImage>
#include <QPointF>
#include <QRectF>
#include <QString>
#include <QWidget>

#include "model/slice_image.hpp"
#include "theme.hpp"

namespace shape3d::apps::viewer {

class Document;

/// Lines over a slice, in places of SliceGeometry.
struct Outline {
  QColor color;
  double width = 1.5;  ///< Pixels.
  bool dashed = false;
  std::vector<std::vector<std::array<double, 2>>> lines;
};

/// A box of samples, lower ≤ (i, j, k) < upper.
struct VoxelBox {
  std::array<std::int64_t, 3> lower{0, 0, 0}, upper{0, 0, 0};
  friend bool operator==(const VoxelBox& a, const VoxelBox& b) {
    return a.lower == b.lower && a.upper == b.upper;
  }
};

/// A slice of the document's volume across one axis, through its crosshair.
///
/// Left drag moves the crosshair, right drag changes window and level, the wheel goes through the
/// slices, Ctrl and the wheel zoom, the middle button moves the picture. With the box tool, left
/// drag draws a box, or moves a side of the one that is there.
class SliceWidget : public QWidget {
  Q_OBJECT

 public:
  SliceWidget(Document& document, int axis, QWidget* parent = nullptr);

  /// Makes the lines over a slice; asked when the slice is another, and after refresh_outlines().
  using OutlineMaker = std::function<std::vector<Outline>(const SliceGeometry&, std::int64_t)>;
  void set_outline_maker(OutlineMaker maker);
  void refresh_outlines();

  void set_box(const std::optional<VoxelBox>& box);
  void set_box_tool(bool on);
  void set_theme(const Theme& theme);
  /// While off, as at first, the picture is not kept up to date: the view is not in front.
  void set_live(bool live);

  [[nodiscard]] int axis() const { return axis_; }
  [[nodiscard]] std::int64_t slice() const;
  [[nodiscard]] const std::optional<SliceGeometry>& geometry() const { return geometry_; }
  /// The grey picture of the slice, one pixel a sample.
  [[nodiscard]] const QImage& image() const { return image_; }
  /// Pixels of the widget at lattice coordinates, and back.
  [[nodiscard]] QPointF pixel_of(const Eigen::Vector3d& lattice) const;
  [[nodiscard]] Eigen::Vector3d lattice_at(const QPointF& pixel) const;

  [[nodiscard]] double zoom() const { return zoom_; }
  [[nodiscard]] QPointF pan() const { return pan_; }
  void set_zoom(double zoom, const QPointF& pan);

 signals:
  void image_changed();                                 ///< Another slice or window.
  void hovered(const Eigen::Vector3d& lattice);         ///< The mouse is over this place.
  void left();                                          ///< The mouse has gone.
  void window_edited();                                 ///< A drag of window and level has ended.
  void box_edited(const VoxelBox& box, bool finished);  ///< While and after it is drawn.
  void maximise();                                      ///< Double click.

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void leaveEvent(QEvent* event) override;

 private:
  enum class Drag { none, cursor, window, pan, box };

  void take_volume();
  void update_image();
  [[nodiscard]] double scale() const;    // pixels a millimetre
  [[nodiscard]] QPointF corner() const;  // of the picture, pixels
  void move_cursor(const QPointF& pixel);
  void start_box(const QPointF& pixel);
  void drag_box(const QPointF& pixel, bool finished);
  [[nodiscard]] std::array<int, 2> plane_axes() const;
  void update_background();
  void paint_lines(QPainter& painter);
  void paint_box(QPainter& painter);
  void paint_cursor(QPainter& painter);
  void paint_texts(QPainter& painter);

  Document& document_;
  int axis_;
  Theme theme_;
  std::optional<SliceGeometry> geometry_;
  std::int64_t shown_ = -1;
  QImage image_;
  // The slice as it is on the screen, and of what it was made: lines over it change more often.
  QImage background_;
  qint64 background_of_ = 0;
  QRectF background_place_;
  bool background_dark_ = true;
  OutlineMaker outline_maker_;
  std::vector<Outline> outlines_;
  bool outlines_old_ = true, live_ = false, image_old_ = false;
  std::optional<VoxelBox> box_;
  bool box_tool_ = false;
  std::array<int, 2>
      box_sides_{};  // while dragging: −1 lower, 1 upper, 0 none, for each plane axis
  double zoom_ = 1.0;
  QPointF pan_;  // millimetres
  Drag drag_ = Drag::none;
  QPointF drag_start_, pan_start_;
  Window window_start_;
};

}  // namespace shape3d::apps::viewer
