#include "thumbnail_grid.hpp"

#include <algorithm>

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include "theme.hpp"

namespace shape3d::apps::viewer {
namespace {

constexpr int kFrame = 5, kGap = 14, kMargin = 14;

}  // namespace

/// What is scrolled.
class ThumbnailGrid::Sheet : public QWidget {
 public:
  explicit Sheet(ThumbnailGrid& grid) : grid_(grid) { setMouseTracking(true); }

 protected:
  void paintEvent(QPaintEvent* event) override {
    QPainter painter(this);
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    grid_.paint(painter, event->rect());
  }
  void mouseMoveEvent(QMouseEvent* event) override { hover(grid_.cell_at(event->pos())); }
  void leaveEvent(QEvent* /*event*/) override { hover(-1); }
  void mousePressEvent(QMouseEvent* event) override {
    grid_.pressed_ = event->button() == Qt::LeftButton ? grid_.cell_at(event->pos()) : -1;
  }
  void mouseReleaseEvent(QMouseEvent* event) override {
    const int cell = grid_.cell_at(event->pos());
    const bool click = cell >= 0 && cell == grid_.pressed_;
    grid_.pressed_ = -1;
    if (click) emit grid_.clicked(cell, static_cast<int>(event->modifiers()));
  }
  bool event(QEvent* event) override {
    if (event->type() == QEvent::ToolTip) {
      auto* help = static_cast<QHelpEvent*>(event);
      const int cell = grid_.cell_at(help->pos());
      QToolTip::showText(help->globalPos(),
                         cell < 0 ? QString() : grid_.cells_[static_cast<std::size_t>(cell)].tip,
                         this);
      return true;
    }
    return QWidget::event(event);
  }

 private:
  void hover(int cell) {
    if (cell == grid_.hovered_) return;
    grid_.hovered_ = cell;
    setCursor(cell < 0 ? Qt::ArrowCursor : Qt::PointingHandCursor);
    update();
  }

  ThumbnailGrid& grid_;
};

ThumbnailGrid::ThumbnailGrid(QWidget* parent) : QScrollArea(parent), sheet_(new Sheet(*this)) {
  setFrameShape(QFrame::NoFrame);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setWidget(sheet_);
  set_theme(make_theme(true));
}

void ThumbnailGrid::set_pictures(std::function<QImage(std::int64_t)> picture) {
  picture_ = std::move(picture);
  sheet_->update();
}

void ThumbnailGrid::set_cells(std::vector<ThumbnailCell> cells) {
  cells_ = std::move(cells);
  hovered_ = pressed_ = -1;
  arrange();
}

void ThumbnailGrid::set_picture_size(int pixels) {
  least_size_ = pixels;
  arrange();
}

void ThumbnailGrid::set_heading(const QString& heading) {
  heading_ = heading;
  arrange();
}

void ThumbnailGrid::set_theme(const Theme& theme) {
  background_ = theme.field;
  text_ = theme.text;
  faint_ = theme.faint_text;
  accent_ = theme.accent;
  QPalette colors = palette();
  colors.setColor(QPalette::Window, background_);
  setPalette(colors);
  sheet_->update();
}

void ThumbnailGrid::refresh() { sheet_->update(); }

bool ThumbnailGrid::event(QEvent* event) {
  if (event->type() == QEvent::FontChange || event->type() == QEvent::Show) arrange();
  return QScrollArea::event(event);
}

void ThumbnailGrid::resizeEvent(QResizeEvent* event) {
  QScrollArea::resizeEvent(event);
  arrange();
}

QRect ThumbnailGrid::place(std::size_t cell) const {
  const int box = size_ + 2 * kFrame, line = fontMetrics().lineSpacing();
  const int height = box + 3 * line + 6;
  const int top = kMargin + (heading_.isEmpty() ? 0 : 2 * line);
  const auto number = static_cast<int>(cell);
  return {kMargin + number % columns_ * (box + kGap), top + number / columns_ * (height + kGap),
          box, height};
}

void ThumbnailGrid::arrange() {
  const int width = viewport()->width(), box = least_size_ + 2 * kFrame;
  columns_ = std::max(1, (width - 2 * kMargin + kGap) / (box + kGap));
  size_ = std::max(least_size_, (width - 2 * kMargin + kGap) / columns_ - kGap - 2 * kFrame);
  const int bottom =
      cells_.empty() ? 4 * fontMetrics().lineSpacing() : place(cells_.size() - 1).bottom();
  sheet_->resize(width, std::max(bottom + kMargin, viewport()->height()));
  sheet_->update();
}

int ThumbnailGrid::cell_at(const QPoint& at) const {
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (place(cell).contains(at)) return static_cast<int>(cell);
  }
  return -1;
}

QRect ThumbnailGrid::cell_area(std::size_t cell) const {
  return place(cell).translated(sheet_->pos());
}

QRect ThumbnailGrid::picture_area(std::size_t cell) const {
  const QRect area = cell_area(cell);
  return {area.left() + kFrame, area.top() + kFrame, size_, size_};
}

void ThumbnailGrid::paint(QPainter& painter, const QRect& region) {
  painter.fillRect(region, background_);
  if (!heading_.isEmpty()) {
    painter.setPen(text_);
    const int line = fontMetrics().lineSpacing();
    painter.drawText(QRect(kMargin, kMargin - 4, sheet_->width() - 2 * kMargin, 2 * line),
                     Qt::AlignLeft | Qt::AlignTop, heading_);
  }
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (place(cell).intersects(region)) paint_cell(painter, cell);
  }
}

void ThumbnailGrid::paint_cell(QPainter& painter, std::size_t number) {
  const ThumbnailCell& cell = cells_[number];
  const QRect area = place(number);
  const QRect box(area.left(), area.top(), size_ + 2 * kFrame, size_ + 2 * kFrame);
  const bool hovered = static_cast<int>(number) == hovered_;
  if (cell.frame.isValid()) {
    painter.fillRect(box, cell.frame);
  } else {
    painter.fillRect(box.adjusted(kFrame - 1, kFrame - 1, 1 - kFrame, 1 - kFrame), faint_);
  }
  if (hovered) {
    painter.setPen(QPen(accent_.lighter(130), 2));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(box.adjusted(-2, -2, 2, 2));
  }
  const QRect inner = box.adjusted(kFrame, kFrame, -kFrame, -kFrame);
  painter.fillRect(inner, Qt::white);
  const QImage picture = picture_ ? picture_(cell.key) : QImage();
  if (picture.isNull()) {
    painter.setPen(QColor(150, 150, 150));
    painter.drawText(inner, Qt::AlignCenter, "…");
  } else {
    // Scaled here: the painter's own scaling drops pixels when it makes pictures much smaller.
    const qreal ratio = painter.device()->devicePixelRatioF();
    QImage scaled =
        picture.scaled(inner.size() * ratio, Qt::KeepAspectRatio, Qt::SmoothTransformation);
    scaled.setDevicePixelRatio(ratio);
    const QSize size = scaled.size() / ratio;
    painter.drawImage(
        QPoint(inner.center().x() - size.width() / 2, inner.center().y() - size.height() / 2),
        scaled);
  }
  const QFont plain = font();
  QFont bold = plain;
  bold.setBold(true);
  int top = box.bottom() + 3;
  for (const QString* text : {&cell.first, &cell.second, &cell.third}) {
    const bool is_first = text == &cell.first;
    painter.setFont(is_first ? bold : plain);
    painter.setPen(text == &cell.third ? faint_ : text_);
    const QFontMetrics metrics(painter.font());
    const QRect row(box.left(), top, box.width(), metrics.lineSpacing());
    painter.drawText(
        row, Qt::AlignHCenter | Qt::AlignTop | Qt::TextDontClip,
        metrics.elidedText(*text, is_first ? Qt::ElideLeft : Qt::ElideRight, box.width()));
    top += fontMetrics().lineSpacing();
  }
  painter.setFont(plain);
}

}  // namespace shape3d::apps::viewer
