#include "benchmark.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <thread>
#include <vector>

#include <QVTKOpenGLNativeWidget.h>
#include <QApplication>
#include <QMouseEvent>
#include <QSlider>
#include <nlohmann/json.hpp>

#include "common/volume_info.hpp"
#include "document.hpp"
#include "four_up.hpp"
#include "main_window.hpp"
#include "scene_widget.hpp"
#include "slice_widget.hpp"
#include "surface_view.hpp"

namespace shape3d::apps::viewer {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Mebibytes of "VmHWM" (greatest so far) or "VmRSS" (now) of this process.
double memory(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kibibytes = 0.0;
  while (status >> word) {
    if (word == name + ":") status >> kibibytes;
  }
  return kibibytes / 1024.0;
}

void settle(MainWindow& window) {
  int quiet = 0;
  while (quiet < 6) {
    QApplication::processEvents(QEventLoop::AllEvents, 20);
    quiet = window.busy() ? 0 : quiet + 1;
    if (quiet == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

// A gyroid, whose surface fills the volume evenly, with a little noise, as int16.
Volume gyroid(const std::array<std::int64_t, 3>& dims, double period) {
  Volume volume;
  volume.samples.resize(2 * static_cast<std::size_t>(dims[0] * dims[1] * dims[2]));
  auto* to = reinterpret_cast<std::int16_t*>(volume.samples.data());
  std::array<std::vector<float>, 3> sines, cosines;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::int64_t n = 0; n < dims[axis]; ++n) {
      const double angle = 2.0 * M_PI * static_cast<double>(n) / period;
      sines[axis].push_back(static_cast<float>(std::sin(angle)));
      cosines[axis].push_back(static_cast<float>(std::cos(angle)));
    }
  }
  std::uint32_t state = 1;
  const auto at = [](const std::vector<float>& values, std::int64_t n) {
    return values[static_cast<std::size_t>(n)];
  };
  for (std::int64_t k = 0; k < dims[2]; ++k) {
    for (std::int64_t j = 0; j < dims[1]; ++j) {
      for (std::int64_t i = 0; i < dims[0]; ++i) {
        state = state * 1664525U + 1013904223U;
        const float value = at(sines[0], i) * at(cosines[1], j) +
                            at(sines[1], j) * at(cosines[2], k) +
                            at(sines[2], k) * at(cosines[0], i);
        *to++ =
            static_cast<std::int16_t>(std::lround(1000.0F * value) + static_cast<int>(state >> 28));
      }
    }
  }
  volume.view.data = volume.samples.data();
  volume.view.type = zmc::SampleType::int16;
  volume.view.dims = dims;
  volume.format = "generated";
  return volume;
}

// What follows the reading of a file, as read_open_volume() does it.
std::shared_ptr<const OpenVolume> opened(Volume volume) {
  auto open = std::make_shared<OpenVolume>();
  open->path = "/generated";
  open->volume = std::move(volume);
  const VolumeDescription description = describe_volume(open->volume);
  open->minimum = description.minimum;
  open->maximum = description.maximum;
  open->automatic = automatic_window(open->volume.view);
  return open;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

class Table {
 public:
  void row(const std::string& what, double value, const std::string& unit, const std::string& aim) {
    char number[32];
    std::snprintf(number, sizeof number, value < 10 ? "%.2f" : "%.0f", value);
    text_ += "| " + what + " | " + number + " " + unit + " | " + aim + " |\n";
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_ = "| what | measured | aim |\n| --- | --- | --- |\n";
};

void measure_opening(MainWindow& window, Table& table) {
  window.show_view("volume");
  settle(window);
  std::vector<double> times;
  for (int round = 0; round < 3; ++round) {
    Volume volume = gyroid({512, 512, 150}, 170.0);
    const Clock::time_point start = Clock::now();
    window.document().set_volume(opened(std::move(volume)));
    QApplication::processEvents();
    static_cast<void>(window.picture(false));  // drawn, with the 3D scene
    times.push_back(seconds_since(start));
    settle(window);
    window.document().close_all();
  }
  table.row("512 × 512 × 150 int16: from the samples in memory to slices and 3D view drawn",
            median(times), "s", "≤ 2 s");
}

void measure_dragging(MainWindow& window, Table& table) {
  window.document().set_volume(opened(gyroid({256, 256, 256}, 128.0)));
  window.show_view("surface");
  settle(window);
  auto& view = dynamic_cast<SurfaceView&>(*window.view_named("surface"));
  auto* slider = view.panel()->findChild<QSlider*>("isovalue-slider");
  SceneWidget* scene = view.four_up()->scene();
  slider->setSliderDown(true);
  emit slider->sliderPressed();
  const std::int64_t updates = view.coarse_updates(), frames = scene->frames();
  const Clock::time_point start = Clock::now();
  int step = 0;
  while (seconds_since(start) < 5.0) {
    slider->setValue(400 + (step++ * 7) % 200);
    QApplication::processEvents(QEventLoop::AllEvents, 5);
  }
  const double seconds = seconds_since(start);
  const std::int64_t drawn = std::min(view.coarse_updates() - updates, scene->frames() - frames);
  table.row("256³ int16: surfaces drawn while the slider is dragged, contours on all slices",
            static_cast<double>(drawn) / seconds, "a second", "≥ 10");
  const Clock::time_point release = Clock::now();
  slider->setSliderDown(false);
  emit slider->sliderReleased();
  const std::int64_t full = view.full_updates();
  while (view.full_updates() == full) QApplication::processEvents(QEventLoop::AllEvents, 5);
  static_cast<void>(scene->draw_now());
  table.row("256³ int16: full surface drawn after release", seconds_since(release), "s", "");
  settle(window);
}

void send(QWidget* widget, QEvent::Type type, const QPoint& at, bool pressed) {
  QMouseEvent event(type, at, widget->mapToGlobal(at),
                    type == QEvent::MouseMove ? Qt::NoButton : Qt::LeftButton,
                    pressed ? Qt::LeftButton : Qt::NoButton, Qt::NoModifier);
  QApplication::sendEvent(widget, &event);
  QApplication::processEvents();
}

void measure_turning(MainWindow& window, Table& table) {
  auto& view = dynamic_cast<SurfaceView&>(*window.view_named("surface"));
  // The isovalue nearest to a million triangles: the surface shrinks away from 0.
  view.set_state({{"isovalue", 0.0}});
  settle(window);
  const double triangles = static_cast<double>(view.triangles());
  SceneWidget* scene = view.four_up()->scene();
  QWidget* gl = scene->gl_widget();
  std::vector<double> frame_times, release_times;
  for (int round = 0; round < 5; ++round) {
    QPoint at(gl->width() / 3, gl->height() / 2);
    send(gl, QEvent::MouseButtonPress, at, true);
    for (int step = 0; step < 40; ++step) {
      at += QPoint(step % 20 < 10 ? 4 : -4, 1);
      const Clock::time_point start = Clock::now();
      send(gl, QEvent::MouseMove, at, true);
      frame_times.push_back(seconds_since(start));
    }
    const Clock::time_point release = Clock::now();
    send(gl, QEvent::MouseButtonRelease, at, false);  // VTK draws within
    release_times.push_back(seconds_since(release));
  }
  char label[128];
  std::snprintf(label, sizeof label, "%.2f M triangles, %d × %d pixels: frames while turning",
                triangles / 1e6, gl->width(), gl->height());
  table.row(label, 1.0 / median(frame_times), "a second", "≥ 20");
  table.row("the same: full surface drawn after release", median(release_times), "s", "≤ 0.5 s");
}

void measure_memory(MainWindow& window, Table& table) {
  window.document().close_all();
  settle(window);
  const double before = memory("VmRSS");
  window.document().set_volume(opened(gyroid({512, 512, 150}, 170.0)));
  window.show_view("surface");
  settle(window);
  // The window at rest has given back what making the surface took.
  for (const Clock::time_point start = Clock::now(); seconds_since(start) < 1.5;)
    QApplication::processEvents(QEventLoop::AllEvents, 20);
  auto& view = dynamic_cast<SurfaceView&>(*window.view_named("surface"));
  const double samples = 2.0 * 512 * 512 * 150 / 1048576.0;
  const double surfaces = view.surface_megabytes();
  char label[160];
  std::snprintf(label, sizeof label,
                "512 × 512 × 150 int16 (%.0f MiB) with a surface of %.2f M triangles (%.0f MiB): "
                "memory of the whole program",
                samples, static_cast<double>(view.triangles()) / 1e6, surfaces);
  const double now = memory("VmRSS");
  table.row(label, now, "MiB", "");
  table.row("the same without samples and surface", now - samples - surfaces, "MiB", "≤ 300 MiB");
  table.row("of it before anything was open", std::min(before, now), "MiB", "");
}

}  // namespace

std::string measure(MainWindow& window, const std::string& renderer) {
  Table table;
  measure_memory(window, table);
  measure_opening(window, table);
  measure_dragging(window, table);
  measure_turning(window, table);
  return "Renderer: " + renderer + ", window of " + std::to_string(window.width()) + " × " +
         std::to_string(window.height()) + " pixels.\n\n" + table.text();
}

}  // namespace shape3d::apps::viewer
