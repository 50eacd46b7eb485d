#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

namespace shape3d::apps {

/// A text out of a file, or a path that one names, for messages: control characters, which would
/// speak to the terminal, become '?'.
/// @param lines  Line ends stay.
[[nodiscard]] inline std::string printable(std::string text, bool lines = false) {
  for (char& c : text) {
    if (((c >= 0 && c < ' ') || c == '\x7f') && !(lines && c == '\n')) c = '?';
  }
  return text;
}

/// A file cannot be read, written or understood. what() is "<path>: <sentence>": the sentence names
/// the value found and what was expected.
class FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& path, const std::string& sentence)
      : std::runtime_error(printable(path.string()) + ": " + printable(sentence, true)),
        path_(path) {}

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace shape3d::apps
