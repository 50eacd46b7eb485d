#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

namespace shape3d::apps {

/// A file cannot be read, written or understood. what() is "<path>: <sentence>": the sentence names
/// the value found and what was expected.
class FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& path, const std::string& sentence)
      : std::runtime_error(path.string() + ": " + sentence), path_(path) {}

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace shape3d::apps
