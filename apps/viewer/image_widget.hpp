#pragma once

#include <optional>

#include <QImage>
#include <QWidget>

#include "common/color_map.hpp"
#include "common/raster.hpp"
#include "theme.hpp"

namespace shape3d::apps::viewer {

/// A picture as large as fits, with a title above and a colour bar at its right.
class ImageWidget : public QWidget {
 public:
  explicit ImageWidget(QWidget* parent = nullptr);
  void set_image(const Raster& image, const QString& title, const std::optional<ColorScale>& scale);
  void clear();
  void set_theme(const Theme& theme);
  [[nodiscard]] const QImage& image() const { return image_; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paint_bar(QPainter& painter, const QRect& bar);

  QImage image_;
  QString title_;
  std::optional<ColorScale> scale_;
  Theme theme_;
};

/// A raster as an image of Qt.
[[nodiscard]] QImage image_of(const Raster& raster);

}  // namespace shape3d::apps::viewer
