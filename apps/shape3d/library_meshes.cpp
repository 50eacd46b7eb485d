#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include "common/error.hpp"
#include "common/mesh_io.hpp"
#include "library_arguments.hpp"

namespace shape3d::apps {
namespace {

namespace fs = std::filesystem;

std::string absolute_name(const fs::path& path) {
  return fs::absolute(path).lexically_normal().string();
}

// The name of the folder that divides the meshes into classes; empty: the file is not in one.
std::string class_folder(const fs::path& relative) {
  return relative.has_parent_path() ? relative.begin()->string() : "";
}

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

}  // namespace

std::vector<NamedMesh> named_meshes(const LibraryAddArguments& arguments,
                                    const Settings& settings) {
  if (arguments.meshes.empty()) throw UsageError("no mesh and no folder is named");
  std::vector<NamedMesh> meshes;
  std::set<std::string> seen;
  std::size_t again = 0;
  const auto add = [&](const fs::path& path, const std::string& folder) {
    NamedMesh mesh{absolute_name(path), std::nullopt};
    if (arguments.class_from_folder && !folder.empty()) mesh.class_name = folder;
    if (seen.insert(mesh.path).second) {
      meshes.push_back(std::move(mesh));
    } else {
      ++again;
    }
  };
  for (const std::string& name : arguments.meshes) {
    std::error_code error;
    if (fs::is_directory(name, error)) {
      for (const fs::path& file : meshes_below(name)) {
        add(file, class_folder(file.lexically_relative(name)));
      }
    } else {
      add(name, fs::path(absolute_name(name)).parent_path().filename().string());
    }
  }
  if (again > 0) {
    warn(settings, std::to_string(again) + " meshes are named more than once");
  }
  return meshes;
}

}  // namespace shape3d::apps
