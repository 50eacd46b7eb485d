#include "slice_widget.hpp"

#include <algorithm>
#include <cmath>

#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>

#include "document.hpp"

namespace shape3d::apps::viewer {

SliceWidget::SliceWidget(Document& document, int axis, QWidget* parent)
    : QWidget(parent), document_(document), axis_(axis), theme_(make_theme(true)) {
  setMouseTracking(true);
  setMinimumSize(120, 100);
  setAttribute(Qt::WA_OpaquePaintEvent);
  connect(&document_, &Document::volume_changed, this, &SliceWidget::take_volume);
  connect(&document_, &Document::window_changed, this, &SliceWidget::update_image);
  connect(&document_, &Document::cursor_changed, this, [this] {
    if (slice() != shown_) update_image();
    update();
  });
  take_volume();
}

void SliceWidget::take_volume() {
  geometry_.reset();
  box_.reset();
  zoom_ = 1.0;
  pan_ = {};
  if (const auto volume = document_.volume()) geometry_.emplace(volume->volume.view, axis_);
  update_image();
}

std::int64_t SliceWidget::slice() const {
  return static_cast<std::int64_t>(std::lround(document_.cursor()[axis_]));
}

void SliceWidget::update_image() {
  const auto volume = document_.volume();
  image_old_ = volume && geometry_ && !live_;
  if (image_old_) return;
  if (!volume || !geometry_) {
    image_ = {};
  } else {
    shown_ = std::clamp<std::int64_t>(slice(), 0, geometry_->slices() - 1);
    const std::vector<std::uint8_t> grey =
        slice_image(volume->volume.view, *geometry_, shown_, document_.window());
    image_ = QImage(geometry_->columns(), geometry_->rows(), QImage::Format_Grayscale8);
    for (int row = 0; row < image_.height(); ++row) {
      const auto from = grey.begin() + static_cast<std::ptrdiff_t>(row) * image_.width();
      std::copy(from, from + image_.width(), image_.scanLine(row));
    }
  }
  outlines_old_ = true;
  emit image_changed();
  update();
}

void SliceWidget::set_outline_maker(OutlineMaker maker) {
  outline_maker_ = std::move(maker);
  refresh_outlines();
}

void SliceWidget::refresh_outlines() {
  outlines_old_ = true;
  update();
}

void SliceWidget::set_box(const std::optional<VoxelBox>& box) {
  box_ = box;
  update();
}

void SliceWidget::set_box_tool(bool on) {
  box_tool_ = on;
  setCursor(on ? Qt::CrossCursor : Qt::ArrowCursor);
}

void SliceWidget::set_live(bool live) {
  live_ = live;
  if (live_ && image_old_) update_image();
}

void SliceWidget::set_theme(const Theme& theme) {
  theme_ = theme;
  update();
}

void SliceWidget::set_zoom(double zoom, const QPointF& pan) {
  zoom_ = std::clamp(zoom, 0.2, 40.0);
  pan_ = pan;
  update();
}

double SliceWidget::scale() const {
  const auto [across, down] = geometry_->size();
  constexpr double kMargin = 6.0;
  const double fit = std::min((width() - kMargin) / across, (height() - kMargin) / down);
  return std::max(fit, 1e-9) * zoom_;
}

QPointF SliceWidget::corner() const {
  const auto [across, down] = geometry_->size();
  const double s = scale();
  return {width() / 2.0 - s * (across / 2.0 - pan_.x()),
          height() / 2.0 - s * (down / 2.0 - pan_.y())};
}

QPointF SliceWidget::pixel_of(const Eigen::Vector3d& lattice) const {
  if (!geometry_) return {};
  const auto [x, y] = geometry_->place(lattice);
  return corner() + scale() * QPointF(x, y);
}

Eigen::Vector3d SliceWidget::lattice_at(const QPointF& pixel) const {
  if (!geometry_) return Eigen::Vector3d::Zero();
  const QPointF place = (pixel - corner()) / scale();
  return geometry_->lattice({place.x(), place.y()}, static_cast<double>(shown_));
}

std::array<int, 2> SliceWidget::plane_axes() const {
  return axis_ == 0   ? std::array<int, 2>{1, 2}
         : axis_ == 1 ? std::array<int, 2>{0, 2}
                      : std::array<int, 2>{0, 1};
}

void SliceWidget::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), theme_.slice_background);
  if (image_.isNull()) return;
  update_background();
  painter.drawImage(0, 0, background_);
  painter.setRenderHint(QPainter::Antialiasing);
  paint_lines(painter);
  paint_box(painter);
  paint_cursor(painter);
  paint_texts(painter);
}

void SliceWidget::update_background() {
  const auto [across, down] = geometry_->size();
  const double s = scale();
  const QRectF place(corner(), QSizeF(s * across, s * down));
  const QSize pixels = size() * devicePixelRatio();
  const bool same = background_.size() == pixels && background_of_ == image_.cacheKey() &&
                    background_place_ == place && background_dark_ == theme_.dark;
  if (same) return;
  background_ = QImage(pixels, QImage::Format_RGB32);
  background_.setDevicePixelRatio(devicePixelRatio());
  background_.fill(theme_.slice_background);
  QPainter painter(&background_);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.drawImage(place, image_);
  background_of_ = image_.cacheKey();
  background_place_ = place;
  background_dark_ = theme_.dark;
}

void SliceWidget::paint_lines(QPainter& painter) {
  if (outlines_old_) {
    outlines_ = outline_maker_ ? outline_maker_(*geometry_, shown_) : std::vector<Outline>();
    outlines_old_ = false;
  }
  const double s = scale();
  const QPointF from = corner();
  painter.setBrush(Qt::NoBrush);
  for (const Outline& outline : outlines_) {
    QPen pen(outline.color, outline.width);
    if (outline.dashed) pen.setStyle(Qt::DashLine);
    painter.setPen(pen);
    for (const auto& line : outline.lines) {
      QPolygonF points;
      points.reserve(static_cast<int>(line.size()));
      for (const auto& [x, y] : line) points.append(from + s * QPointF(x, y));
      painter.drawPolyline(points);
    }
  }
}

void SliceWidget::paint_box(QPainter& painter) {
  if (!box_) return;
  Eigen::Vector3d lower, upper;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    lower[a] = static_cast<double>(box_->lower[axis]) - 0.5;
    upper[a] = static_cast<double>(box_->upper[axis]) - 0.5;
  }
  const auto across = static_cast<std::size_t>(axis_);
  const bool through = shown_ >= box_->lower[across] && shown_ < box_->upper[across];
  QPen pen(QColor(255, 200, 60), through ? 2.0 : 1.0);
  if (!through) pen.setStyle(Qt::DashLine);
  painter.setPen(pen);
  painter.setBrush(through ? QColor(255, 200, 60, 10) : QColor(0, 0, 0, 0));
  painter.drawRect(QRectF(pixel_of(lower), pixel_of(upper)).normalized());
  painter.setBrush(Qt::NoBrush);
}

void SliceWidget::paint_cursor(QPainter& painter) {
  const QPointF centre = pixel_of(document_.cursor());
  const Eigen::Matrix3d& direction = document_.volume()->volume.view.direction;
  const std::array<int, 2> axes = plane_axes();
  constexpr double kGap = 7.0;  // round the place itself
  for (std::size_t i = 0; i < 2; ++i) {
    // The line along one axis of the plane is where the slice across the other one lies.
    Eigen::Index world = 0;
    direction.col(axes[1 - i]).cwiseAbs().maxCoeff(&world);
    QColor color = axis_color(static_cast<int>(world));
    color.setAlpha(200);
    painter.setPen(QPen(color, 1.0));
    if (i == 0) {
      painter.drawLine(QPointF(0, centre.y()), QPointF(centre.x() - kGap, centre.y()));
      painter.drawLine(QPointF(centre.x() + kGap, centre.y()), QPointF(width(), centre.y()));
    } else {
      painter.drawLine(QPointF(centre.x(), 0), QPointF(centre.x(), centre.y() - kGap));
      painter.drawLine(QPointF(centre.x(), centre.y() + kGap), QPointF(centre.x(), height()));
    }
  }
}

void SliceWidget::paint_texts(QPainter& painter) {
  const auto write = [&painter](const QPointF& at, const QString& text, const QColor& color) {
    QPainterPath path;
    path.addText(at, painter.font(), text);
    painter.setPen(QPen(QColor(0, 0, 0, 200), 3.0, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    painter.setBrush(Qt::NoBrush);
    painter.drawPath(path);
    painter.fillPath(path, color);
  };
  Eigen::Index world = 0;
  document_.volume()->volume.view.direction.col(axis_).cwiseAbs().maxCoeff(&world);
  QString name = QString::fromStdString(geometry_->name());
  name[0] = name[0].toUpper();
  const QFontMetrics metrics(painter.font());
  const int line = metrics.height();
  QFont bold = painter.font(), plain = bold;
  bold.setBold(true);
  painter.setFont(bold);
  write(QPointF(8, line), name, axis_color(static_cast<int>(world)));
  painter.setFont(plain);
  write(QPointF(8, 2 * line), QString("%1 of %2").arg(shown_ + 1).arg(geometry_->slices()),
        Qt::white);
  const auto sides = geometry_->sides();
  const QColor faint(225, 228, 232);
  const auto letter = [](const std::string& text) { return QString::fromStdString(text); };
  write(QPointF(8, height() / 2.0 + line / 3.0), letter(sides[0]), faint);
  write(QPointF(width() - 8 - metrics.horizontalAdvance(letter(sides[1])),
                height() / 2.0 + line / 3.0),
        letter(sides[1]), faint);
  write(QPointF(width() / 2.0 - metrics.averageCharWidth(), line), letter(sides[2]), faint);
  write(QPointF(width() / 2.0 - metrics.averageCharWidth(), height() - 8), letter(sides[3]), faint);
}

void SliceWidget::move_cursor(const QPointF& pixel) {
  Eigen::Vector3d place = lattice_at(pixel);
  place[axis_] = document_.cursor()[axis_];
  document_.set_cursor(place.array().round().matrix());
}

void SliceWidget::mousePressEvent(QMouseEvent* event) {
  if (image_.isNull() || drag_ != Drag::none) return;
  drag_start_ = event->localPos();
  if (event->button() == Qt::RightButton) {
    drag_ = Drag::window;
    window_start_ = document_.window();
  } else if (event->button() == Qt::MiddleButton) {
    drag_ = Drag::pan;
    pan_start_ = pan_;
  } else if (event->button() == Qt::LeftButton && box_tool_) {
    drag_ = Drag::box;
    start_box(drag_start_);
  } else if (event->button() == Qt::LeftButton) {
    drag_ = Drag::cursor;
    move_cursor(drag_start_);
  }
}

void SliceWidget::mouseMoveEvent(QMouseEvent* event) {
  if (image_.isNull()) return;
  const QPointF at = event->localPos(), way = at - drag_start_;
  switch (drag_) {
    case Drag::none:
      // As in 3D Slicer, Shift takes the crosshair along.
      if ((event->modifiers() & Qt::ShiftModifier) != 0) move_cursor(at);
      break;
    case Drag::cursor:
      move_cursor(at);
      break;
    case Drag::window: {
      const auto volume = document_.volume();
      // The side of the picture is a quarter of the range: CT has few of its intensities far out.
      const double range = 0.25 * std::max(volume->maximum - volume->minimum, 1e-12);
      document_.set_window(dragged(window_start_, way.x() / width(), way.y() / height(), range));
      break;
    }
    case Drag::pan:
      set_zoom(zoom_, pan_start_ + way / scale());
      break;
    case Drag::box:
      drag_box(at, false);
      break;
  }
  emit hovered(lattice_at(at));
}

void SliceWidget::mouseReleaseEvent(QMouseEvent* event) {
  if (drag_ == Drag::window) emit window_edited();
  if (drag_ == Drag::box) drag_box(event->localPos(), true);
  drag_ = Drag::none;
}

void SliceWidget::mouseDoubleClickEvent(QMouseEvent* /*event*/) { emit maximise(); }

void SliceWidget::wheelEvent(QWheelEvent* event) {
  if (image_.isNull()) return;
  const double notches = event->angleDelta().y() / 120.0;
  if ((event->modifiers() & Qt::ControlModifier) != 0) {
    // The place under the mouse stays there.
    const QPointF from = event->position() - QPointF(width() / 2.0, height() / 2.0);
    const double before = scale();
    set_zoom(zoom_ * std::pow(1.2, notches), pan_);
    set_zoom(zoom_, pan_ + from / scale() - from / before);
  } else {
    Eigen::Vector3d place = document_.cursor();
    place[axis_] = std::round(place[axis_]) + (notches > 0 ? 1.0 : -1.0);
    document_.set_cursor(place);
  }
  event->accept();
}

void SliceWidget::leaveEvent(QEvent* /*event*/) { emit left(); }

void SliceWidget::start_box(const QPointF& pixel) {
  const std::array<int, 2> axes = plane_axes();
  box_sides_ = {0, 0};
  const Eigen::Vector3d at = lattice_at(pixel);
  if (box_) {
    // A side within reach of the mouse is moved; elsewhere a new box begins.
    constexpr double kReach = 8.0;
    std::array<bool, 2> within{};
    std::array<int, 2> near{};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto a = static_cast<std::size_t>(axes[i]);
      const double reach = kReach / scale() / document_.volume()->volume.view.spacing[axes[i]];
      const double lower = static_cast<double>(box_->lower[a]) - 0.5,
                   upper = static_cast<double>(box_->upper[a]) - 0.5;
      within[i] = at[axes[i]] > lower - reach && at[axes[i]] < upper + reach;
      if (std::abs(at[axes[i]] - lower) <= reach) near[i] = -1;
      if (std::abs(at[axes[i]] - upper) <= reach) near[i] = 1;
    }
    if (within[0] && within[1] && (near[0] != 0 || near[1] != 0)) {
      box_sides_ = near;
      return;
    }
  }
  VoxelBox box = box_.value_or(VoxelBox{{0, 0, 0}, document_.volume()->volume.view.dims});
  for (const int axis : axes) {
    const auto a = static_cast<std::size_t>(axis);
    const std::int64_t last = document_.volume()->volume.view.dims[a] - 1;
    box.lower[a] = std::clamp<std::int64_t>(std::llround(at[axis]), 0, last - 1);
    box.upper[a] = box.lower[a] + 1;
  }
  box_ = box;
  drag_start_ = pixel;
}

void SliceWidget::drag_box(const QPointF& pixel, bool finished) {
  if (!box_) return;
  const Eigen::Vector3d at = lattice_at(pixel), start = lattice_at(drag_start_);
  VoxelBox box = *box_;
  const std::array<int, 2> axes = plane_axes();
  const bool drawing = box_sides_[0] == 0 && box_sides_[1] == 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto a = static_cast<std::size_t>(axes[i]);
    const std::int64_t size = document_.volume()->volume.view.dims[a];
    const auto node = [size](double place) {
      return std::clamp<std::int64_t>(std::llround(place), 0, size - 1);
    };
    if (drawing) {
      box.lower[a] = std::min(node(at[axes[i]]), node(start[axes[i]]));
      box.upper[a] = std::max(node(at[axes[i]]), node(start[axes[i]])) + 1;
    } else if (box_sides_[i] < 0) {
      box.lower[a] = std::min(node(at[axes[i]] + 0.5), box.upper[a] - 2);
    } else if (box_sides_[i] > 0) {
      box.upper[a] = std::max(node(at[axes[i]] - 0.5) + 1, box.lower[a] + 2);
    }
    // Two samples at least: a region of one has no inside.
    if (box.upper[a] - box.lower[a] < 2) box.upper[a] = std::min(box.lower[a] + 2, size);
    box.lower[a] = std::min(box.lower[a], box.upper[a] - 2);
  }
  box_ = box;
  emit box_edited(box, finished);
  update();
}

}  // namespace shape3d::apps::viewer
