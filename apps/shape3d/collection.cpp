#include "collection.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "common/byte_source.hpp"
#include "common/error.hpp"
#include "common/mesh_io.hpp"
#include "common/text.hpp"
#include "program.hpp"

namespace shape3d::apps {
namespace {

namespace fs = std::filesystem;

void require_folder(const std::string& folder) {
  std::error_code error;
  if (fs::is_directory(folder, error)) return;
  throw FileError(folder, fs::exists(folder, error) ? "is not a folder, expected one"
                                                    : "does not exist, expected a folder");
}

// "1234" / 100 → "12"
std::string divided(const std::string& id, std::string_view divisor, const std::string& pattern) {
  const auto number = parse_unsigned(id), by = parse_unsigned(divisor);
  if (!by || *by == 0) {
    throw UsageError("--path " + pattern + ": has {id/" + std::string(divisor) +
                     "}, expected a number such as 100");
  }
  if (!number) {
    throw UsageError("--path " + pattern + ": model " + in_quotes(id) +
                     " is not a number, expected one for {id/" + std::string(divisor) + "}");
  }
  return std::to_string(*number / *by);
}

std::string name_of(const std::string& path) { return fs::path(path).filename().string(); }

// "Train" or "Test" by the name of a class file; empty: neither.
std::string part_of(const std::string& class_file) {
  const std::string name = lower_case(name_of(class_file));
  if (name.find("train") != std::string::npos) return "Train";
  return name.find("test") != std::string::npos ? "Test" : "";
}

void add_folder_model(Collection& collection, std::map<std::string, int>& places,
                      const std::string& of_class, const std::string& id, const fs::path& path) {
  const auto [place, is_new] =
      places.insert({of_class, static_cast<int>(collection.classes.size())});
  if (is_new) collection.classes.push_back(of_class);
  collection.models.push_back({id, path.string(), place->second});
}

std::vector<fs::path> meshes_below(const std::string& folder) {
  std::vector<fs::path> paths;
  try {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file() && mesh_format(entry.path().string())) {
        paths.push_back(entry.path());
      }
    }
  } catch (const fs::filesystem_error& error) {
    throw FileError(folder, "cannot be listed: " + error.code().message());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

learning::Classification read_classification(const std::string& path) {
  const MappedFile file(path);
  try {
    return learning::parse_classification(file.bytes());
  } catch (const std::invalid_argument& error) {
    throw FileError(path, error.what());
  }
}

std::string model_path(const std::string& pattern, const std::string& id,
                       const learning::Classification::Class& of_class) {
  std::string path;
  bool has_id = false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '{') {
      path += pattern[i];
      continue;
    }
    const std::size_t end = pattern.find('}', i);
    const std::string word = pattern.substr(i + 1, end == std::string::npos ? end : end - i - 1);
    if (end != std::string::npos && word == "id") {
      path += id;
    } else if (end != std::string::npos && word.rfind("id/", 0) == 0) {
      path += divided(id, std::string_view(word).substr(3), pattern);
    } else if (end != std::string::npos && word == "class") {
      path += of_class.name;
    } else if (end != std::string::npos && word == "class_path") {
      path += of_class.full_name;
    } else {
      throw UsageError("--path " + pattern + ": has '{" + word +
                       "', expected {id}, {id/N}, {class} or {class_path}");
    }
    has_id = has_id || word.rfind("id", 0) == 0;
    i = end;
  }
  if (!has_id) throw UsageError("--path " + pattern + ": has no {id}, expected one");
  return path;
}

Collection princeton_collection(const std::string& class_file, const std::string& folder,
                                const std::string& pattern) {
  const learning::Classification classification = read_classification(class_file);
  if (classification.models.empty()) {
    throw FileError(class_file, "has no models, expected some");
  }
  require_folder(folder);
  std::vector<std::string> paths;
  for (const auto& model : classification.models) {
    paths.push_back(model_path(pattern, model.id,
                               classification.classes[static_cast<std::size_t>(model.of_class)]));
  }
  Collection result;
  result.source = class_file;
  for (const auto& one : classification.classes) result.classes.push_back(one.full_name);
  const fs::path roots[] = {fs::path(folder), fs::path(folder) / "db"};
  for (const fs::path& root : roots) {
    result.models.clear();
    result.missing.clear();
    std::vector<int> found(result.classes.size());
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const auto& model = classification.models[i];
      const fs::path path = root / paths[i];
      std::error_code error;
      if (fs::is_regular_file(path, error)) {
        result.models.push_back({model.id, path.string(), model.of_class});
        ++found[static_cast<std::size_t>(model.of_class)];
      } else {
        result.missing.push_back("model " + model.id + " has no file " + path.string());
      }
    }
    result.empty.clear();
    for (std::size_t c = 0; c < found.size(); ++c) {
      if (found[c] == 0 && classification.classes[c].models > 0) {
        result.empty.push_back(result.classes[c]);
      }
    }
    if (!result.models.empty()) return result;
  }
  throw FileError(folder, "has none of the " + std::to_string(paths.size()) + " models of " +
                              class_file + ", expected files such as " +
                              (fs::path(folder) / paths.front()).string());
}

FolderCollections folder_collections(const std::string& folder) {
  require_folder(folder);
  FolderCollections result;
  result.train.source = result.test.source = folder;
  std::map<std::string, int> train_places, test_places;
  std::size_t outside = 0;
  for (const fs::path& path : meshes_below(folder)) {
    const fs::path below = path.lexically_relative(folder);
    std::string of_class;
    bool is_train = false, is_split = false;
    for (const fs::path& part : below.parent_path()) {
      const std::string word = part.string(), lower = lower_case(word);
      if (!is_split && (lower == "train" || lower == "test")) {
        is_split = true;
        is_train = lower == "train";
      } else if (of_class.empty()) {
        of_class = word;
      }
    }
    if (of_class.empty()) {
      ++outside;
      continue;
    }
    add_folder_model(is_train ? result.train : result.test, is_train ? train_places : test_places,
                     of_class, below.string(), path);
  }
  if (result.train.models.empty() && result.test.models.empty()) {
    throw FileError(folder, outside == 0
                                ? "has no mesh, expected folders of classes with meshes (" +
                                      std::string(".ply, .obj, .off, .stl or .vtp") + ")"
                                : "has meshes, but none in the folder of a class");
  }
  return result;
}

std::string class_file_of_level(const std::string& class_file, const std::string& level) {
  const fs::path given(class_file);
  const std::string part = part_of(class_file);
  const std::string folder_name = given.parent_path().filename().string();
  if (folder_name == level || lower_case(given.stem().string()) == lower_case(level + part)) {
    return class_file;
  }
  std::vector<fs::path> tried;
  for (const fs::path& above : {given.parent_path().parent_path(), given.parent_path()}) {
    tried.push_back(above / level / (level + part + ".cla"));
    if (!part.empty()) tried.push_back(above / level / (lower_case(part) + ".cla"));
  }
  tried.push_back(given.parent_path() / (level + part + ".cla"));
  for (const fs::path& path : tried) {
    std::error_code error;
    if (fs::is_regular_file(path, error)) return path.string();
  }
  std::string places;
  for (const fs::path& path : tried) places += (places.empty() ? "" : ", ") + path.string();
  throw UsageError("--classes " + level + ": there is no such class file of " + class_file +
                   ", looked for " + places);
}

}  // namespace shape3d::apps
