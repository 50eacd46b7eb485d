#include "display_check.hpp"

#include <cstdlib>
#include <stdexcept>

#include <QVTKOpenGLNativeWidget.h>
#include <QGuiApplication>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFunctions>

#include "common/child_process.hpp"
#include "common/private_display.hpp"

namespace shape3d::apps::viewer {
namespace {

std::string renderer_name() {
  set_surface_format();
  int argc = 1;
  char name[] = "shape3d-viewer";
  char* argv[] = {name, nullptr};
  const QGuiApplication application(argc, argv);
  QOffscreenSurface surface;
  surface.create();
  QOpenGLContext context;
  context.setFormat(QSurfaceFormat::defaultFormat());
  if (!context.create() || !context.makeCurrent(&surface))
    throw std::runtime_error("it offers no OpenGL");
  const QSurfaceFormat format = context.format();
  if (format.version() < qMakePair(3, 2))
    throw std::runtime_error("it offers OpenGL " + std::to_string(format.majorVersion()) + "." +
                             std::to_string(format.minorVersion()) + ", expected 3.2 or later");
  return reinterpret_cast<const char*>(context.functions()->glGetString(GL_RENDERER));
}

}  // namespace

void set_surface_format() {
  QSurfaceFormat format = QVTKOpenGLNativeWidget::defaultFormat();
  format.setSamples(0);
  QSurfaceFormat::setDefaultFormat(format);
}

std::string require_display() {
  const char* x11 = std::getenv("DISPLAY");
  const char* wayland = std::getenv("WAYLAND_DISPLAY");
  const auto is_set = [](const char* text) { return text != nullptr && *text != '\0'; };
  if (!is_set(x11) && !is_set(wayland))
    throw PictureError(
        "there is no display: DISPLAY is not set; --offscreen draws pictures without one");
  ChildResult result = run_in_child(renderer_name);
  if (result.ok) return std::move(result.output);
  const bool ended = result.error.rfind("ended", 0) == 0;
  throw PictureError(
      "no window can be opened on display " + std::string(is_set(x11) ? x11 : wayland) + ": " +
      (ended ? "it does not answer" : result.error) + "; --offscreen draws pictures without one");
}

}  // namespace shape3d::apps::viewer
