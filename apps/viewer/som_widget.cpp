#include "som_widget.hpp"

#include <algorithm>
#include <cmath>

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include "common/color_map.hpp"
#include "common/error.hpp"
#include "model/collection_map.hpp"
#include "model_text.hpp"
#include "theme.hpp"

namespace shape3d::apps::viewer {
namespace {

using learning::SomLattice;

constexpr int kMargin = 16, kHead = 34, kFoot = 58;
const QColor kInk(30, 30, 30), kFaintInk(95, 95, 95);

}  // namespace

SomWidget::SomWidget(QWidget* parent) : QWidget(parent) {
  setMouseTracking(true);
  setMinimumSize(400, 240);
  set_theme(make_theme(true));
}

void SomWidget::set_map(std::shared_ptr<const CollectionMap> map) {
  map_ = std::move(map);
  chosen_ = hovered_ = -1;
  update();
}

void SomWidget::set_labels(bool shape_names) {
  shape_names_ = shape_names;
  update();
}

void SomWidget::set_borders(bool on) {
  borders_ = on;
  update();
}

void SomWidget::set_chosen(int unit) {
  chosen_ = unit;
  update();
}

void SomWidget::set_theme(const Theme& theme) {
  background_ = theme.field;
  text_ = theme.text;
  faint_ = theme.faint_text;
  accent_ = theme.accent;
  update();
}

SomWidget::Frame SomWidget::frame(bool right) const {
  Frame frame;
  const double width = (this->width() - 3 * kMargin) / 2.0;
  frame.area = QRectF(kMargin + (right ? width + kMargin : 0.0), kHead, width,
                      std::max(1, height() - kHead - kFoot));
  if (!map_) return frame;
  // Both parts have the box of the units and of the elements between them on a toroid.
  const Eigen::MatrixXd &x = map_->u_matrix.x, &y = map_->u_matrix.y;
  const double left = map_->places.col(0).minCoeff() - 0.55,
               top = map_->places.col(1).minCoeff() - 0.62;
  const double wide = std::max(map_->places.col(0).maxCoeff() + 0.55, x.maxCoeff() + 0.3) - left;
  const double tall = std::max(map_->places.col(1).maxCoeff() + 0.62, y.maxCoeff() + 0.35) - top;
  frame.scale = std::min(frame.area.width() / wide, frame.area.height() / tall);
  const QPointF corner(frame.area.center().x() - frame.scale * wide / 2, frame.area.top());
  frame.origin = corner - frame.scale * QPointF(left, top);
  return frame;
}

QPolygonF SomWidget::cell(const Frame& frame, double x, double y, double pitch) const {
  QPolygonF polygon;
  const bool hexagonal = map_->model.som.grid.lattice == SomLattice::hexagonal;
  const int corners = hexagonal ? 6 : 4;
  const double radius = hexagonal ? pitch / std::sqrt(3.0) : pitch / std::sqrt(2.0);
  for (int k = 0; k < corners; ++k) {
    const double angle = (hexagonal ? M_PI / 6 : M_PI / 4) + 2 * M_PI * k / corners;
    polygon << frame.to_widget(x + radius * std::cos(angle), y + radius * std::sin(angle));
  }
  return polygon;
}

QPointF SomWidget::place_of(int unit) const {
  return frame(true).to_widget(map_->places(unit, 0), map_->places(unit, 1));
}

QPointF SomWidget::place_in_matrix(int unit) const {
  return frame(false).to_widget(map_->places(unit, 0), map_->places(unit, 1));
}

int SomWidget::unit_at(const QPointF& place) const {
  if (!map_) return -1;
  for (const bool right : {false, true}) {
    const Frame part = frame(right);
    for (int unit = 0; unit < map_->units(); ++unit) {
      if (cell(part, map_->places(unit, 0), map_->places(unit, 1), 1.0)
              .containsPoint(place, Qt::OddEvenFill))
        return unit;
    }
  }
  return -1;
}

QString SomWidget::label_of(int unit) const {
  const std::string text = shape_names_ || map_->class_names.empty()
                               ? map_->model.names[static_cast<std::size_t>(unit)]
                               : map_->class_of(unit);
  return QString::fromStdString(printable(text));
}

void SomWidget::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), background_);
  if (!map_) return;
  painter.setRenderHint(QPainter::Antialiasing);
  QFont bold = font();
  bold.setBold(true);
  const Frame left = frame(false), right = frame(true);
  painter.setFont(bold);
  painter.setPen(text_);
  for (const bool second : {false, true}) {
    const Frame& part = second ? right : left;
    painter.drawText(QRectF(part.area.left(), 0, part.area.width(), kHead), Qt::AlignCenter,
                     second ? "Units: labels and numbers of shapes" : "U-matrix");
  }
  painter.setFont(font());
  paint_u_matrix(painter, left);
  paint_bar(painter, left);
  paint_units(painter, right);
  if (borders_) paint_borders(painter, right);
  for (const Frame* part : {&left, &right}) {
    if (hovered_ >= 0 && hovered_ != chosen_) mark(painter, *part, hovered_, faint_, 2.0);
    if (chosen_ >= 0) mark(painter, *part, chosen_, accent_, 4.0);
  }
}

void SomWidget::paint_u_matrix(QPainter& painter, const Frame& frame) {
  const learning::UMatrix& u = map_->u_matrix;
  ColorScale scale;
  scale.lower = u.values.minCoeff();
  scale.upper = u.values.maxCoeff();
  for (Eigen::Index i = 0; i < u.values.rows(); ++i) {
    for (Eigen::Index j = 0; j < u.values.cols(); ++j) {
      const QColor color = to_qt(color_at(scale.map, scale.share_of(u.values(i, j))));
      // With a pen of its own colour: no gaps between neighbours.
      painter.setPen(QPen(color, 1.0));
      painter.setBrush(color);
      painter.drawPolygon(cell(frame, u.x(i, j), u.y(i, j), 0.5));
    }
  }
  // A mark where a unit is, so that both parts can be compared.
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(255, 255, 255, 220));
  const double radius = std::max(1.0, 0.03 * frame.scale);
  for (int unit = 0; unit < map_->units(); ++unit)
    painter.drawEllipse(frame.to_widget(map_->places(unit, 0), map_->places(unit, 1)), radius,
                        radius);
}

void SomWidget::paint_bar(QPainter& painter, const Frame& frame) {
  const learning::UMatrix& u = map_->u_matrix;
  ColorScale scale;
  scale.lower = u.values.minCoeff();
  scale.upper = u.values.maxCoeff();
  const double width = 0.6 * frame.area.width();
  const double foot = frame.to_widget(0.0, map_->places.col(1).maxCoeff() + 0.62).y();
  const QRectF bar(frame.area.center().x() - width / 2,
                   std::min<double>(foot, height() - kFoot) + 8, width, 10);
  QLinearGradient gradient(bar.topLeft(), bar.topRight());
  for (int n = 0; n <= 32; ++n) gradient.setColorAt(n / 32.0, to_qt(color_at(scale.map, n / 32.0)));
  painter.fillRect(bar, gradient);
  painter.setPen(text_);
  for (const Tick& tick : ticks_of(scale, 5)) {
    const double x = bar.left() + scale.share_of(tick.value) * bar.width();
    painter.drawLine(QPointF(x, bar.bottom()), QPointF(x, bar.bottom() + 3));
    painter.drawText(QRectF(x - 40, bar.bottom() + 3, 80, 14),
                     Qt::AlignHCenter | Qt::AlignTop | Qt::TextDontClip,
                     QString::fromStdString(tick.label));
  }
  painter.setPen(faint_);
  painter.drawText(QRectF(frame.area.left(), bar.bottom() + 18, frame.area.width(), 16),
                   Qt::AlignHCenter | Qt::AlignTop | Qt::TextDontClip,
                   "distance of neighbouring prototypes");
}

void SomWidget::paint_units(QPainter& painter, const Frame& frame) {
  QFont small = font();
  small.setPixelSize(std::clamp(static_cast<int>(0.2 * frame.scale), 8, 15));
  painter.setFont(small);
  const QFontMetricsF metrics(small);
  const double wide = 0.92 * frame.scale;
  for (int unit = 0; unit < map_->units(); ++unit) {
    const auto at = static_cast<std::size_t>(unit);
    const bool empty = map_->model.hits[at] == 0;
    const double x = map_->places(unit, 0), y = map_->places(unit, 1);
    painter.setPen(QPen(background_, 1.0));
    painter.setBrush(empty ? faint_.darker(background_.lightness() < 128 ? 240 : 90)
                           : to_qt(light_color(map_->model.labels[at])));
    painter.drawPolygon(cell(frame, x, y, 1.0));
    if (empty || frame.scale < 28.0) continue;
    const QPointF middle = frame.to_widget(x, y);
    const QRectF line(middle.x() - wide / 2, middle.y() - metrics.height(), wide, metrics.height());
    painter.setPen(kInk);
    painter.drawText(line, Qt::AlignCenter | Qt::TextDontClip,
                     metrics.elidedText(label_of(unit), Qt::ElideRight, wide));
    painter.setPen(kFaintInk);
    painter.drawText(line.translated(0, metrics.height()), Qt::AlignCenter | Qt::TextDontClip,
                     QString::number(map_->model.hits[at]));
  }
  painter.setFont(font());
}

// The edge between two cells: neighbours share it, and their middles are 1 apart.
void SomWidget::paint_borders(QPainter& painter, const Frame& frame) {
  painter.setPen(QPen(background_.lightness() < 128 ? QColor(Qt::black) : kInk,
                      std::max(2.5, 0.05 * frame.scale), Qt::SolidLine, Qt::RoundCap));
  const bool hexagonal = map_->model.som.grid.lattice == SomLattice::hexagonal;
  const double half = (hexagonal ? 1.0 / std::sqrt(3.0) : 1.0) / 2;
  for (int a = 0; a < map_->units(); ++a) {
    for (int b = a + 1; b < map_->units(); ++b) {
      if (map_->model.clusters[static_cast<std::size_t>(a)] ==
          map_->model.clusters[static_cast<std::size_t>(b)])
        continue;
      const Eigen::RowVector2d way = map_->places.row(b) - map_->places.row(a);
      if (way.norm() > 1.01) continue;
      const Eigen::RowVector2d middle = (map_->places.row(a) + map_->places.row(b)) / 2;
      const Eigen::RowVector2d along(-half * way.y(), half * way.x());
      const Eigen::RowVector2d from = middle - along, to = middle + along;
      painter.drawLine(frame.to_widget(from.x(), from.y()), frame.to_widget(to.x(), to.y()));
    }
  }
}

void SomWidget::mark(QPainter& painter, const Frame& frame, int unit, const QColor& color,
                     double width) {
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(color, width, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  painter.drawPolygon(cell(frame, map_->places(unit, 0), map_->places(unit, 1), 1.0));
}

void SomWidget::mousePressEvent(QMouseEvent* event) {
  if (map_ && event->button() == Qt::LeftButton) emit clicked(unit_at(event->localPos()));
}

void SomWidget::mouseMoveEvent(QMouseEvent* event) {
  const int unit = unit_at(event->localPos());
  if (unit == hovered_) return;
  hovered_ = unit;
  setCursor(unit < 0 ? Qt::ArrowCursor : Qt::PointingHandCursor);
  update();
}

void SomWidget::leaveEvent(QEvent* /*event*/) {
  hovered_ = -1;
  update();
}

bool SomWidget::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip || !map_) return QWidget::event(event);
  auto* help = static_cast<QHelpEvent*>(event);
  const int unit = unit_at(help->pos());
  QString text;
  if (unit >= 0) {
    text = QString("row %1, column %2: %3 shapes")
               .arg(map_->row(unit) + 1)
               .arg(map_->column(unit) + 1)
               .arg(map_->model.hits[static_cast<std::size_t>(unit)]);
    const QString label = label_of(unit);
    if (!label.isEmpty()) text += ", " + label;
  }
  QToolTip::showText(help->globalPos(), text, this);
  return true;
}

}  // namespace shape3d::apps::viewer
