#include "viewer_program.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <QApplication>
#include <QTimer>
#include <nlohmann/json.hpp>

#include "benchmark.hpp"
#include "common/error.hpp"
#include "common/interrupt.hpp"
#include "common/private_display.hpp"
#include "common/text.hpp"
#include "display_check.hpp"
#include "main_window.hpp"
#include "output_image.hpp"

namespace shape3d::apps::viewer {
namespace {

constexpr int kFailure = 1, kUsage = 2;

class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Arguments {
  std::vector<std::string> files;
  std::string view, out, size = "1280x720", state, part = "window";
  std::string save_session, load_session;
  bool offscreen = false, light = false, benchmark = false;
  double timeout = 600.0;
  QSize pixels;
};

int fail(const std::string& sentence, int status) {
  std::cerr << "shape3d-viewer: " << sentence << '\n';
  return status;
}

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option("FILE", arguments.files,
                 "Volumes (DICOM folder, .nii, .nrrd, .mha, .mhd, .vti), meshes (.ply, .obj, .off, "
                 ".stl, .vtp), a shape library (.db), the map of a collection (.model), sessions "
                 "(.json)");
  app.add_option("--view", arguments.view, "The view in front: volume, surface, segmentation …")
      ->type_name("NAME");
  app.add_flag("--offscreen", arguments.offscreen,
               "Draw a picture without a display, write it to --out and end");
  app.add_option("-o,--out", arguments.out, "The picture (.png)")->type_name("FILE");
  app.add_option("--part", arguments.part,
                 "Of the picture: the whole window, or the view alone (default window)")
      ->check(CLI::IsMember({"window", "view"}))
      ->type_name("PART");
  app.add_option("--size", arguments.size,
                 "Pixels of the window (default 1280x720); from 1600 rows on, everything is drawn "
                 "twice as large")
      ->type_name("WxH");
  app.add_option("--state", arguments.state,
                 "Parameters of the view, JSON as in session files: '{\"isovalue\": 300}'")
      ->type_name("JSON");
  app.add_flag("--light", arguments.light, "Light background");
  app.add_option("--load-session", arguments.load_session, "Show what a session file holds")
      ->type_name("FILE");
  app.add_option("--save-session", arguments.save_session,
                 "Write a session file when the program ends")
      ->type_name("FILE");
  app.add_option("--timeout", arguments.timeout,
                 "Seconds that --offscreen waits for work to end (default 600)")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  app.add_flag("--benchmark", arguments.benchmark,
               "Measure opening, dragging, turning and memory with generated volumes, without a "
               "display; prints a table in Markdown");
  app.footer(
      "Examples:\n"
      "  shape3d-viewer scan/\n"
      "  shape3d-viewer --offscreen --view surface --state '{\"isovalue\": 226}' -o bone.png "
      "scan/\n"
      "Keys: '?' in the window lists them.");
}

void check(Arguments& arguments) {
  if (arguments.benchmark && !(arguments.files.empty() && arguments.out.empty()))
    throw UsageError("--benchmark takes no files and no --out");
  if (arguments.offscreen && arguments.out.empty())
    throw UsageError("--offscreen needs --out, the picture to write");
  if (!arguments.out.empty() && !arguments.offscreen)
    throw UsageError("--out is for --offscreen; in the window, S saves a picture");
  if (!arguments.out.empty() && lower_case(arguments.out).rfind(".png") + 4 != arguments.out.size())
    throw UsageError("--out " + arguments.out + ": expected a name that ends in .png");
  const std::size_t cross = arguments.size.find('x');
  const auto width = parse_integer(arguments.size.substr(0, cross)),
             height = cross == std::string::npos ? std::nullopt
                                                 : parse_integer(arguments.size.substr(cross + 1));
  if (!width || !height || *width < 640 || *height < 400 || *width > 8192 || *height > 8192)
    throw UsageError("--size " + arguments.size +
                     ": expected WIDTHxHEIGHT in pixels, from 640x400 to 8192x8192");
  arguments.pixels = QSize(static_cast<int>(*width), static_cast<int>(*height));
  if (!arguments.state.empty() && !nlohmann::json::accept(arguments.state))
    throw UsageError("--state " + arguments.state + ": expected JSON, as {\"isovalue\": 300}");
}

// Lets the window work until there is nothing left to do.
void wait_for(MainWindow& window, double timeout) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout);
  int quiet = 0;  // a view may begin work in a later turn of the loop
  while (quiet < 5) {
    QApplication::processEvents(QEventLoop::AllEvents, 20);
    quiet = window.busy() ? 0 : quiet + 1;
    if (quiet == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (std::chrono::steady_clock::now() > end)
      throw std::runtime_error("the view is still at work after " + to_text(timeout) +
                               " s; --timeout S waits longer");
  }
}

void prepare(MainWindow& window, const Arguments& arguments) {
  if (!arguments.view.empty() &&
      window.view_named(QString::fromStdString(arguments.view)) == nullptr) {
    std::string names;
    for (const View* view : window.views())
      names += (names.empty() ? "" : ", ") + view->name().toStdString();
    throw UsageError("--view " + arguments.view + ": expected one of " + names);
  }
  if (arguments.light) window.set_dark(false);
  if (!arguments.load_session.empty()) window.open(QString::fromStdString(arguments.load_session));
  for (const std::string& file : arguments.files) window.open(QString::fromStdString(file));
  if (!arguments.view.empty()) window.show_view(QString::fromStdString(arguments.view));
}

void set_state(MainWindow& window, const Arguments& arguments) {
  if (arguments.state.empty()) return;
  View* view = window.current();
  try {
    view->set_state(nlohmann::json::parse(arguments.state));
  } catch (const std::exception& error) {
    throw UsageError("--state: " + std::string(error.what()));
  }
}

int draw(MainWindow& window, const Arguments& arguments) {
  window.setAttribute(Qt::WA_DontShowOnScreen, false);
  window.show();
  wait_for(window, arguments.timeout);
  if (!arguments.view.empty()) window.show_view(QString::fromStdString(arguments.view));
  set_state(window, arguments);
  wait_for(window, arguments.timeout);
  if (!window.failures().empty()) return kFailure;  // each has been said
  const QString missing = window.current()->missing();
  if (!missing.isEmpty()) return fail(missing.toStdString(), kFailure);
  write_png(arguments.out, window.picture(arguments.part == "window"));
  if (!arguments.save_session.empty()) write_session(arguments.save_session, window.session());
  return 0;
}

int run(int argc, char** argv, const Arguments& arguments) {
  // A display of our own without --out's window ever being seen; it ends after the application.
  std::unique_ptr<PrivateDisplay> display;
  int scale = 1;
  const bool hidden = arguments.offscreen || arguments.benchmark;
  if (hidden) {
    display = std::make_unique<PrivateDisplay>();
    setenv("DISPLAY", display->name().c_str(), 1);
    setenv("QT_QPA_PLATFORM", "xcb", 1);
    scale = arguments.pixels.height() >= 1600 ? 2 : 1;
    setenv("QT_SCALE_FACTOR", std::to_string(scale).c_str(), 1);
  }
  // Qt's own remarks (a runtime folder that is not set …) are no messages of this program.
  qInstallMessageHandler([](QtMsgType type, const QMessageLogContext&, const QString& text) {
    if (type == QtCriticalMsg || type == QtFatalMsg)
      std::cerr << "shape3d-viewer: " << text.toStdString() << '\n';
  });
  const std::string renderer = require_display();
  set_surface_format();
  QApplication::setAttribute(Qt::AA_EnableHighDpiScaling);
  QApplication application(argc, argv);
  QApplication::setApplicationDisplayName("Shape3D");
  MainWindow window(!hidden);
  if (hidden) window.resize(arguments.pixels / scale);
  if (arguments.benchmark) {
    window.show();
    std::cout << measure(window, renderer);
    return 0;
  }
  prepare(window, arguments);
  if (arguments.offscreen) return draw(window, arguments);
  window.show();
  if (!arguments.state.empty()) {
    wait_for(window, arguments.timeout);
    set_state(window, arguments);
  }
  const int status = QApplication::exec();
  if (!arguments.save_session.empty()) write_session(arguments.save_session, window.session());
  return status;
}

}  // namespace

int run_viewer(int argc, char** argv) {
  install_interrupt_handler();
  Arguments arguments;
  CLI::App app("Look at volumes, surfaces, segmentations, sphere maps and collections of shapes.");
  app.name("shape3d-viewer");
  app.set_version_flag("--version", "shape3d-viewer " SHAPE3D_VERSION);
  add_options(app, arguments);
  try {
    app.parse(argc, argv);
    check(arguments);
    return run(argc, argv, arguments);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return 0;
  } catch (const CLI::CallForVersion& version) {
    std::cout << version.what() << '\n';
    return 0;
  } catch (const CLI::ParseError& error) {
    return fail(std::string(error.what()) + "; 'shape3d-viewer --help' lists the options", kUsage);
  } catch (const UsageError& error) {
    return fail(error.what(), kUsage);
  } catch (const std::bad_alloc&) {
    return fail("there is not enough memory", kFailure);
  } catch (const std::exception& error) {
    return fail(error.what(), kFailure);
  }
}

}  // namespace shape3d::apps::viewer
