#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace shape3d::test {

/// A file or folder of the development data, which is not part of the sources: `relative` below the
/// folder that the environment variable SHAPE3D_DATA names. Empty when the variable is not set or
/// nothing is there; the test then says so with WARN and ends.
std::optional<std::filesystem::path> test_data(const std::string& relative);

/// A new folder that is removed, with all in it, at the end of the scope.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace shape3d::test
