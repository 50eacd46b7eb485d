#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include <sys/types.h>

namespace shape3d::apps {

class EndOnInterrupt;

/// A picture could not be made. what() is a sentence.
class PictureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An X server of our own without a screen (Xvfb), which lives as long as this object; it ends with
/// this process in any case.
class PrivateDisplay {
 public:
  /// @throws PictureError  Xvfb is not installed, does not start, or does not answer within 20 s.
  PrivateDisplay();
  ~PrivateDisplay();
  PrivateDisplay(const PrivateDisplay&) = delete;
  PrivateDisplay& operator=(const PrivateDisplay&) = delete;

  /// For the environment variable DISPLAY: ":7".
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  void end();

  pid_t server_ = -1;
  std::unique_ptr<EndOnInterrupt> guard_;
  std::string name_;
};

}  // namespace shape3d::apps
