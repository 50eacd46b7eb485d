#include "window_fixture.hpp"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include <QApplication>
#include <QMouseEvent>
#include <QSlider>
#include <QStandardPaths>
#include <QStyleOptionSlider>
#include <QWheelEvent>
#include <catch2/catch.hpp>

#include "common/private_display.hpp"
#include "display_check.hpp"

namespace shape3d::test {
namespace {

using namespace apps::viewer;

// Lives until the process ends: a QApplication is not made twice, and the server ends with us.
void require_application() {
  static bool made = false;
  if (made) return;
  made = true;
  auto* display = new apps::PrivateDisplay;
  setenv("DISPLAY", display->name().c_str(), 1);
  setenv("QT_QPA_PLATFORM", "xcb", 1);
  qInstallMessageHandler([](QtMsgType, const QMessageLogContext&, const QString&) {});
  QStandardPaths::setTestModeEnabled(true);
  set_surface_format();
  static int argc = 1;
  static char name[] = "viewer-test";
  static char* argv[] = {name, nullptr};
  static auto* application = new QApplication(argc, argv);
  static_cast<void>(application);
}

void send(QWidget* widget, QEvent::Type type, const QPoint& at, Qt::MouseButton button,
          Qt::MouseButtons buttons, Qt::KeyboardModifiers modifiers) {
  QMouseEvent event(type, at, widget->mapToGlobal(at), button, buttons, modifiers);
  QApplication::sendEvent(widget, &event);
  QApplication::processEvents();
}

}  // namespace

WindowFixture::WindowFixture(int width, int height) {
  require_application();
  window_ = std::make_unique<MainWindow>(false);
  window_->resize(width, height);
  window_->show();
  window_->activateWindow();
  settle();
}

WindowFixture::~WindowFixture() = default;

void WindowFixture::show(const char* name) {
  window_->show_view(name);
  REQUIRE(settle());
}

bool WindowFixture::settle() {
  int quiet = 0;
  return wait_until([&] {
    quiet = window_->busy() ? 0 : quiet + 1;
    return quiet > 5;
  });
}

bool WindowFixture::wait_until(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(90);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    QApplication::processEvents(QEventLoop::AllEvents, 20);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

QImage WindowFixture::grab(QWidget* widget) {
  return widget->grab().toImage().convertToFormat(QImage::Format_RGB32);
}

void drag(QWidget* widget, const QPoint& from, const QPoint& to, Qt::MouseButton button, int steps,
          const std::function<void()>& before_release, Qt::KeyboardModifiers modifiers) {
  send(widget, QEvent::MouseMove, from, Qt::NoButton, Qt::NoButton, modifiers);
  send(widget, QEvent::MouseButtonPress, from, button, button, modifiers);
  for (int step = 1; step <= steps; ++step)
    send(widget, QEvent::MouseMove, from + (to - from) * step / steps, Qt::NoButton, button,
         modifiers);
  if (before_release) before_release();
  send(widget, QEvent::MouseButtonRelease, to, button, Qt::NoButton, modifiers);
}

void hover(QWidget* widget, const QPoint& at, Qt::KeyboardModifiers modifiers) {
  send(widget, QEvent::MouseMove, at, Qt::NoButton, Qt::NoButton, modifiers);
}

void wheel(QWidget* widget, const QPoint& at, int notches, Qt::KeyboardModifiers modifiers) {
  QWheelEvent event(at, widget->mapToGlobal(at), QPoint(), QPoint(0, 120 * notches), Qt::NoButton,
                    modifiers, Qt::NoScrollPhase, false);
  QApplication::sendEvent(widget, &event);
  QApplication::processEvents();
}

QPoint handle_of(const QSlider* slider, int value) {
  QStyleOptionSlider option;
  option.initFrom(slider);
  option.subControls = QStyle::SC_SliderGroove | QStyle::SC_SliderHandle;
  option.orientation = slider->orientation();
  option.minimum = slider->minimum();
  option.maximum = slider->maximum();
  option.sliderPosition = value;
  option.sliderValue = value;
  return slider->style()
      ->subControlRect(QStyle::CC_Slider, &option, QStyle::SC_SliderHandle, slider)
      .center();
}

std::shared_ptr<const OpenVolume> made_volume(
    const std::array<std::int64_t, 3>& dims,
    const std::function<double(std::int64_t, std::int64_t, std::int64_t)>& sample,
    const std::array<double, 3>& spacing) {
  auto open = std::make_shared<OpenVolume>();
  open->path = "/made.mhd";
  apps::Volume& volume = open->volume;
  volume.samples.resize(2 * static_cast<std::size_t>(dims[0] * dims[1] * dims[2]));
  auto* to = reinterpret_cast<std::int16_t*>(volume.samples.data());
  open->minimum = 1e300;
  open->maximum = -1e300;
  for (std::int64_t k = 0; k < dims[2]; ++k) {
    for (std::int64_t j = 0; j < dims[1]; ++j) {
      for (std::int64_t i = 0; i < dims[0]; ++i) {
        const auto value = static_cast<std::int16_t>(std::lround(sample(i, j, k)));
        *to++ = value;
        open->minimum = std::min(open->minimum, static_cast<double>(value));
        open->maximum = std::max(open->maximum, static_cast<double>(value));
      }
    }
  }
  volume.view.data = volume.samples.data();
  volume.view.type = zmc::SampleType::int16;
  volume.view.dims = dims;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    volume.view.spacing[axis] = spacing[static_cast<std::size_t>(axis)];
  volume.format = "made";
  open->automatic = automatic_window(volume.view);
  return open;
}

std::shared_ptr<const OpenVolume> ball_volume(int n) {
  const double middle = (n - 1) / 2.0;
  return made_volume({n, n, n}, [middle](std::int64_t i, std::int64_t j, std::int64_t k) {
    const Eigen::Vector3d p(static_cast<double>(i) - middle, static_cast<double>(j) - middle,
                            static_cast<double>(k) - middle);
    return 1000.0 - 20.0 * p.norm();
  });
}

int count_color(const QImage& image, const QColor& color, int tolerance) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const QRgb pixel = image.pixel(x, y);
      count += std::abs(qRed(pixel) - color.red()) <= tolerance &&
                       std::abs(qGreen(pixel) - color.green()) <= tolerance &&
                       std::abs(qBlue(pixel) - color.blue()) <= tolerance
                   ? 1
                   : 0;
    }
  }
  return count;
}

int changed_pixels(const QImage& a, const QImage& b, int tolerance) {
  REQUIRE(a.size() == b.size());
  int count = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const QRgb p = a.pixel(x, y), q = b.pixel(x, y);
      count += std::abs(qRed(p) - qRed(q)) > tolerance ||
                       std::abs(qGreen(p) - qGreen(q)) > tolerance ||
                       std::abs(qBlue(p) - qBlue(q)) > tolerance
                   ? 1
                   : 0;
    }
  }
  return count;
}

double mean_grey(const QImage& image) {
  double sum = 0.0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) sum += qGray(image.pixel(x, y));
  }
  return sum / (image.width() * static_cast<double>(image.height()));
}

int edge_count(const QImage& image, int step) {
  int count = 0;
  for (int y = 0; y + 1 < image.height(); ++y) {
    for (int x = 0; x + 1 < image.width(); ++x) {
      const int here = qGray(image.pixel(x, y));
      count += std::abs(qGray(image.pixel(x + 1, y)) - here) > step ||
                       std::abs(qGray(image.pixel(x, y + 1)) - here) > step
                   ? 1
                   : 0;
    }
  }
  return count;
}

}  // namespace shape3d::test
