#pragma once

#include <functional>
#include <vector>

#include <QColor>
#include <QImage>
#include <QScrollArea>
#include <QString>

namespace shape3d::apps::viewer {

struct Theme;

/// A picture in a frame with lines of text under it.
struct ThumbnailCell {
  std::int64_t key = 0;          ///< By which pictures are asked for.
  QColor frame;                  ///< Not valid: a thin line.
  QString first, second, third;  ///< Under the picture; the first one is bold.
  QString tip;
};

/// Cells row by row, as many in a row as fit; they are scrolled when there are more than the widget
/// has room for. The pictures of cells that are seen are asked for when they are.
class ThumbnailGrid : public QScrollArea {
  Q_OBJECT

 public:
  explicit ThumbnailGrid(QWidget* parent = nullptr);

  /// @param picture  Gives the picture of a key, now or in a later call: null until then.
  void set_pictures(std::function<QImage(std::int64_t)> picture);
  void set_cells(std::vector<ThumbnailCell> cells);
  [[nodiscard]] const std::vector<ThumbnailCell>& cells() const { return cells_; }
  /// Least width of a picture on screen, without its frame; they fill the width of the grid.
  void set_picture_size(int pixels);
  /// Above the cells; "": nothing.
  void set_heading(const QString& heading);
  [[nodiscard]] const QString& heading() const { return heading_; }
  void set_theme(const Theme& theme);
  /// Pictures may have come.
  void refresh();

  /// Where a cell is, in the coordinates of viewport(); the part that is hidden by scrolling as
  /// well.
  [[nodiscard]] QRect cell_area(std::size_t cell) const;
  /// Its picture, without the frame.
  [[nodiscard]] QRect picture_area(std::size_t cell) const;

 signals:
  /// @param modifiers  Qt::KeyboardModifiers of the click.
  void clicked(int cell, int modifiers);

 protected:
  bool event(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  class Sheet;
  void arrange();
  [[nodiscard]] QRect place(std::size_t cell) const;  // in the coordinates of the sheet
  [[nodiscard]] int cell_at(const QPoint& place) const;
  void paint(QPainter& painter, const QRect& region);
  void paint_cell(QPainter& painter, std::size_t cell);

  Sheet* sheet_;
  std::vector<ThumbnailCell> cells_;
  std::function<QImage(std::int64_t)> picture_;
  QString heading_;
  QColor background_, text_, faint_, accent_;
  int least_size_ = 140, size_ = 140, columns_ = 1, hovered_ = -1, pressed_ = -1;
};

}  // namespace shape3d::apps::viewer
