#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

namespace shape3d::apps {

/// A path for messages: a file may name another one, and control characters in the name would speak
/// to the terminal. They become '?'.
[[nodiscard]] inline std::string printable(const std::filesystem::path& path) {
  std::string text = path.string();
  for (char& c : text) {
    if ((c >= 0 && c < ' ') || c == '\x7f') c = '?';
  }
  return text;
}

/// A file cannot be read, written or understood. what() is "<path>: <sentence>": the sentence names
/// the value found and what was expected.
class FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& path, const std::string& sentence)
      : std::runtime_error(printable(path) + ": " + sentence), path_(path) {}

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace shape3d::apps
