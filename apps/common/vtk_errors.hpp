#pragma once

#include <string>

#include <vtkSmartPointer.h>

class vtkCallbackCommand;
class vtkCommand;
class vtkObject;

namespace shape3d::apps {

/// Collects what a VTK object reports as an error instead of printing it.
class VtkErrors {
 public:
  VtkErrors();
  ~VtkErrors();
  VtkErrors(const VtkErrors&) = delete;
  VtkErrors& operator=(const VtkErrors&) = delete;

  /// Errors and warnings of this object no longer reach the terminal.
  void observe(vtkObject* object);
  /// For objects that hand an observer on to helpers of theirs.
  [[nodiscard]] vtkCommand* command() const;
  [[nodiscard]] bool any() const { return !first_.empty(); }
  /// The first error as one line, without VTK's own place in its source.
  [[nodiscard]] const std::string& first() const { return first_; }

 private:
  static void on_event(vtkObject* caller, unsigned long event, void* self, void* text);

  vtkSmartPointer<vtkCallbackCommand> command_;
  std::string first_;
};

}  // namespace shape3d::apps
