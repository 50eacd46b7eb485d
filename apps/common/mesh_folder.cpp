#include "mesh_folder.hpp"

#include <algorithm>

#include "error.hpp"
#include "mesh_io.hpp"

namespace shape3d::apps {

namespace fs = std::filesystem;

std::vector<fs::path> meshes_below(const std::string& folder) {
  std::vector<fs::path> files;
  try {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(
             folder, fs::directory_options::follow_directory_symlink)) {
      if (entry.is_regular_file() && mesh_format(entry.path().string())) {
        files.push_back(entry.path());
      }
    }
  } catch (const fs::filesystem_error& error) {
    throw FileError(folder, "cannot be looked through: " + error.code().message());
  }
  if (files.empty()) {
    throw FileError(folder, "holds no mesh, expected files .ply, .obj, .off, .stl or .vtp");
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace shape3d::apps
