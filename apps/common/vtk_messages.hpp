#pragma once

#include <memory>
#include <string>

namespace shape3d::apps {

/// While one exists, what VTK would print goes to it instead: errors and warnings of every VTK
/// object in the process. What anything writes to std::cerr (GDCM does) is dropped. Not for use
/// from several threads at a time.
class VtkMessages {
 public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  /// The first error so far without VTK's file, line and object; empty when there was none.
  [[nodiscard]] std::string first_error() const;
  /// The first warning so far, likewise.
  [[nodiscard]] std::string first_warning() const;
  /// The first error that GDCM printed. VTK's DICOM reader does not look whether it could
  /// decompress.
  [[nodiscard]] std::string first_gdcm_error() const;

 private:
  class Window;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shape3d::apps
