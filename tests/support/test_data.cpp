#include "support/test_data.hpp"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <stdlib.h>  // mkdtemp: POSIX

namespace shape3d::test {

std::optional<std::filesystem::path> test_data(const std::string& relative) {
  const char* root = std::getenv("SHAPE3D_DATA");
  if (root == nullptr || *root == '\0') return std::nullopt;
  std::filesystem::path path = std::filesystem::path(root) / relative;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "shape3d-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw std::system_error(errno, std::generic_category(), "cannot create " + name);
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace shape3d::test
