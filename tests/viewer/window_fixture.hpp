#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <QImage>
#include <QPoint>
#include <Qt>

#include "document.hpp"
#include "main_window.hpp"

class QSlider;
class QWidget;

namespace shape3d::test {

/// A window of the viewer on a display without a screen. The display and the application are made
/// once a process.
class WindowFixture {
 public:
  /// @param width, height  Of the window, pixels.
  explicit WindowFixture(int width = 1280, int height = 720);
  ~WindowFixture();

  apps::viewer::MainWindow& window() { return *window_; }
  apps::viewer::Document& document() { return window_->document(); }
  template <class View>
  View& view(const char* name) {
    return dynamic_cast<View&>(*window_->view_named(name));
  }
  /// Brings a view to the front and waits until all is done.
  void show(const char* name);
  /// Lets the window work until it is at rest. @return whether it came to rest within 90 s.
  bool settle();
  /// Lets the window work until something holds. @return whether it came to hold within 90 s.
  bool wait_until(const std::function<bool()>& holds);
  /// A picture of a widget, its 3D parts as well.
  static QImage grab(QWidget* widget);

 private:
  std::unique_ptr<apps::viewer::MainWindow> window_;
};

/// Presses a button, moves in steps, and releases it, as a hand does.
void drag(QWidget* widget, const QPoint& from, const QPoint& to, Qt::MouseButton button,
          int steps = 8, const std::function<void()>& before_release = {},
          Qt::KeyboardModifiers modifiers = Qt::NoModifier);
/// Moves without a button.
void hover(QWidget* widget, const QPoint& at, Qt::KeyboardModifiers modifiers = Qt::NoModifier);
/// Turns the wheel by notches.
void wheel(QWidget* widget, const QPoint& at, int notches,
           Qt::KeyboardModifiers modifiers = Qt::NoModifier);
/// The place of a slider's handle for a value.
QPoint handle_of(const QSlider* slider, int value);

/// A volume of int16 samples f(i, j, k) in memory.
std::shared_ptr<const apps::viewer::OpenVolume> made_volume(
    const std::array<std::int64_t, 3>& dims,
    const std::function<double(std::int64_t, std::int64_t, std::int64_t)>& sample,
    const std::array<double, 3>& spacing = {1.0, 1.0, 1.0});

/// Values 1000 − 20·distance from the middle of n³ samples: the isosurface of v is a sphere of
/// radius (1000 − v)/20.
std::shared_ptr<const apps::viewer::OpenVolume> ball_volume(int n);

/// Pixels within `tolerance` of a colour in each channel.
int count_color(const QImage& image, const QColor& color, int tolerance = 40);
/// Pixels that differ by more than `tolerance` in a channel.
int changed_pixels(const QImage& a, const QImage& b, int tolerance = 12);
/// Mean of a channel-averaged picture, 0 … 255.
double mean_grey(const QImage& image);
/// Pixels whose right or lower neighbour differs by more than `step` of grey.
int edge_count(const QImage& image, int step = 40);

}  // namespace shape3d::test
