#include "image_widget.hpp"

#include <algorithm>

#include <QPainter>

namespace shape3d::apps::viewer {

QImage image_of(const Raster& raster) {
  return QImage(raster.rgb.data(), raster.width, raster.height, 3 * raster.width,
                QImage::Format_RGB888)
      .copy();
}

ImageWidget::ImageWidget(QWidget* parent) : QWidget(parent), theme_(make_theme(true)) {
  setMinimumSize(160, 100);
}

void ImageWidget::set_image(const Raster& image, const QString& title,
                            const std::optional<ColorScale>& scale) {
  image_ = image_of(image);
  title_ = title;
  scale_ = scale;
  update();
}

void ImageWidget::clear() {
  image_ = {};
  title_.clear();
  scale_.reset();
  update();
}

void ImageWidget::set_theme(const Theme& theme) {
  theme_ = theme;
  update();
}

void ImageWidget::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), theme_.field);
  if (image_.isNull()) return;
  const int line = painter.fontMetrics().height();
  constexpr int kGap = 8, kBar = 14;
  // Room for the bar and its numbers.
  const int right =
      scale_ ? kBar + 2 * kGap + painter.fontMetrics().horizontalAdvance("-0.0000") : 0;
  const QRect room(kGap, line + kGap, width() - 2 * kGap - right, height() - line - 2 * kGap);
  const QSize size = image_.size().scaled(room.size(), Qt::KeepAspectRatio);
  const QRect place(room.x() + (room.width() - size.width()) / 2,
                    room.y() + (room.height() - size.height()) / 2, size.width(), size.height());
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.drawImage(place, image_);
  painter.setPen(theme_.text);
  painter.drawText(QRect(kGap, kGap / 2, width() - 2 * kGap, line), Qt::AlignCenter, title_);
  if (scale_) paint_bar(painter, QRect(place.right() + 2 * kGap, place.y(), kBar, place.height()));
}

void ImageWidget::paint_bar(QPainter& painter, const QRect& bar) {
  for (int y = 0; y < bar.height(); ++y) {
    const Color color = color_at(scale_->map, 1.0 - y / std::max(1.0, bar.height() - 1.0));
    painter.fillRect(bar.x(), bar.y() + y, bar.width(), 1,
                     QColor::fromRgbF(color[0], color[1], color[2]));
  }
  const int line = painter.fontMetrics().height();
  for (const Tick& tick : ticks_of(*scale_, std::max(2, bar.height() / (2 * line)))) {
    const int y =
        bar.bottom() - static_cast<int>(scale_->share_of(tick.value) * (bar.height() - 1));
    painter.drawLine(bar.right() + 1, y, bar.right() + 4, y);
    painter.drawText(QRect(bar.right() + 7, y - line / 2, 80, line),
                     Qt::AlignLeft | Qt::AlignVCenter, QString::fromStdString(tick.label));
  }
}

}  // namespace shape3d::apps::viewer
