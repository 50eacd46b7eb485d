#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>

#include <shape3d/learning/classification.hpp>

#include "collection.hpp"
#include "common/error.hpp"
#include "common/mesh_folder.hpp"
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

// "m42" → "42", the id in a class file.
std::string digits_at_end(const std::string& stem) {
  const std::size_t last = stem.find_last_not_of("0123456789");
  return last == std::string::npos ? stem : stem.substr(last + 1);
}

// "a, b, c and 5 more".
std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, names.size()); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > kMost) text += " and " + std::to_string(names.size() - kMost) + " more";
  return text;
}

// Gives the meshes the classes of a file, and says what of it there is no mesh for.
void classify(std::vector<NamedMesh>& meshes, const std::string& path, const Settings& settings) {
  const learning::Classification classification = read_classification(path);
  std::map<std::string, int> class_of;
  for (const auto& model : classification.models) class_of.emplace(model.id, model.of_class);
  std::set<std::string> found;
  std::map<std::string, int> members;
  std::size_t unnamed = 0;
  for (NamedMesh& mesh : meshes) {
    const std::string stem = fs::path(mesh.path).stem().string();
    auto place = class_of.find(stem);
    if (place == class_of.end()) place = class_of.find(digits_at_end(stem));
    if (place == class_of.end()) {
      ++unnamed;
      continue;
    }
    found.insert(place->first);
    const std::string& name =
        classification.classes[static_cast<std::size_t>(place->second)].full_name;
    ++members[name];
    if (name != learning::kMiscellaneousClass) mesh.class_name = name;
  }
  if (found.empty()) {
    throw FileError(path, "names none of the " + std::to_string(meshes.size()) +
                              " meshes: their names end in no id of it");
  }
  std::vector<std::string> missing, empty, single;
  for (const auto& model : classification.models) {
    if (found.count(model.id) == 0) missing.push_back(model.id);
  }
  for (const auto& entry : classification.classes) {
    const auto place = members.find(entry.full_name);
    const int count = place == members.end() ? 0 : place->second;
    if (count == 0 && entry.models > 0) empty.push_back(entry.full_name);
    if (count == 1) single.push_back(entry.full_name);
  }
  const auto say = [&](const std::vector<std::string>& names, const std::string& what) {
    if (names.empty()) return;
    warn(settings, path + ": " + std::to_string(names.size()) + " " + what + ": " + some_of(names));
  };
  say(missing, "models are not among the meshes");
  say(empty, "classes have no mesh");
  say(single, "classes have a single mesh, which has nothing to be found");
  if (unnamed > 0) warn(settings, path + ": " + std::to_string(unnamed) + " meshes are not in it");
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
  if (!arguments.classes.empty()) classify(meshes, arguments.classes, settings);
  return meshes;
}

}  // namespace shape3d::apps
