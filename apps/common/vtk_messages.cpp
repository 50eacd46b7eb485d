#include "vtk_messages.hpp"

#include <vtkLogger.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <iostream>
#include <sstream>

#include "text.hpp"

namespace shape3d::apps {
namespace {

// VTK's "ERROR: In file, line n\nvtkClass (0x…): text" without what comes before the text; one
// line.
std::string plain(const std::string& message) {
  std::string_view text = trim(message);
  if (text.substr(0, 10) == "ERROR: In " || text.substr(0, 12) == "Warning: In ") {
    const std::size_t end = text.find('\n');
    if (end != std::string_view::npos) text = trim(text.substr(end));
  }
  const std::size_t object = text.find("): ");
  if (text.substr(0, 3) == "vtk" && object != std::string_view::npos)
    text = trim(text.substr(object + 3));
  std::string result;
  for (const std::string_view word : split_words(text)) {
    result += result.empty() ? "" : " ";
    result += word;
  }
  return result;
}

}  // namespace

class VtkMessages::Window : public vtkOutputWindow {
 public:
  static Window* New();
  Window(const Window&) = delete;
  void operator=(const Window&) = delete;

  void DisplayText(const char* /*text*/) override {}
  void DisplayDebugText(const char* /*text*/) override {}
  void DisplayErrorText(const char* text) override { keep(text, error); }
  void DisplayWarningText(const char* text) override { keep(text, warning); }
  void DisplayGenericWarningText(const char* text) override { keep(text, warning); }

  std::string error;
  std::string warning;

 protected:
  Window() = default;
  ~Window() override = default;

 private:
  static void keep(const char* text, std::string& first) {
    if (first.empty() && text != nullptr) first = plain(text);
  }
};

vtkStandardNewMacro(VtkMessages::Window);

struct VtkMessages::State {
  vtkSmartPointer<vtkOutputWindow> previous;
  vtkLogger::Verbosity previous_verbosity = vtkLogger::VERBOSITY_WARNING;
  vtkSmartPointer<Window> window;
  std::ostringstream sink;
  std::streambuf* previous_cerr = nullptr;
};

VtkMessages::VtkMessages() : state_(std::make_unique<State>()) {
  state_->previous = vtkOutputWindow::GetInstance();
  state_->window = vtkSmartPointer<Window>::New();
  vtkOutputWindow::SetInstance(state_->window);
  // VTK's log writes errors to standard error beside the output window.
  state_->previous_verbosity = vtkLogger::GetCurrentVerbosityCutoff();
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  // GDCM, which decompresses DICOM pixels, writes to std::cerr.
  state_->previous_cerr = std::cerr.rdbuf(state_->sink.rdbuf());
}

VtkMessages::~VtkMessages() {
  std::cerr.rdbuf(state_->previous_cerr);
  vtkLogger::SetStderrVerbosity(state_->previous_verbosity);
  vtkOutputWindow::SetInstance(state_->previous);
}

std::string VtkMessages::first_error() const { return state_->window->error; }

std::string VtkMessages::first_warning() const { return state_->window->warning; }

std::string VtkMessages::first_gdcm_error() const {
  // "Error: In file, line n, function f\ntext\n\n"
  const std::string printed = state_->sink.str();
  std::size_t at = printed.find("Error: In ");
  if (at == std::string::npos) return {};
  at = std::min(printed.find('\n', at), printed.size());
  const std::size_t end = printed.find("\n\n", at);
  const std::string text = plain(printed.substr(at, end == std::string::npos ? end : end - at));
  return text.empty() ? "an error without a text" : text;
}

}  // namespace shape3d::apps
