#include "training_set.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>

#include <shape3d/descriptors/descriptor.hpp>

#include "common/error.hpp"
#include "common/feature_table.hpp"
#include "common/shape_library.hpp"
#include "common/text.hpp"

namespace shape3d::apps {
namespace {

namespace fs = std::filesystem;

// "armadillo" of "shapes/armadillo/train/T12.obj"; empty where there is no folder.
std::string folder_class(const std::string& file) {
  fs::path folder = fs::path(file).parent_path();
  while (folder.filename() == "train" || folder.filename() == "test") folder = folder.parent_path();
  const std::string name = folder.filename().string();
  return name == "." || name == ".." ? "" : name;
}

std::string canonical(const std::string& spec) {
  try {
    return descriptors::Descriptor::parse(spec).to_string();
  } catch (const std::invalid_argument& error) {
    throw UsageError("--descriptor " + spec + ": " + error.what());
  }
}

std::string listed(const std::vector<FeatureSet>& sets) {
  std::string text;
  for (const FeatureSet& set : sets) text += (text.empty() ? "" : "; ") + set.spec;
  return text;
}

TrainingSet of_table(const TrainingSource& source) {
  FeatureTable table = read_features(source.path);
  auto found = table.sets.begin();
  if (!source.descriptor.empty()) {
    const std::string spec = canonical(source.descriptor);
    found = std::find_if(table.sets.begin(), table.sets.end(),
                         [&](const FeatureSet& set) { return set.spec == spec; });
    if (found == table.sets.end()) {
      throw FileError(source.path, "has no vectors of " + spec + ", but of: " + listed(table.sets));
    }
  }
  TrainingSet set;
  set.source = source.path;
  set.spec = found->spec;
  set.vectors = std::move(found->vectors);
  std::map<std::string, int> numbers;
  for (const FeatureFile& file : table.files) {
    set.files.push_back(file.path);
    if (source.class_from_folder) numbers.emplace(folder_class(file.path), 0);
  }
  numbers.erase("");
  for (auto& [name, number] : numbers) {
    number = static_cast<int>(set.class_names.size());
    set.class_names.push_back(name);
  }
  for (const std::string& file : set.files) {
    const auto place = numbers.find(source.class_from_folder ? folder_class(file) : "");
    set.labels.push_back(place == numbers.end() ? learning::kUnlabelled : place->second);
  }
  return set;
}

TrainingSet of_library(const TrainingSource& source) {
  if (source.class_from_folder) {
    throw UsageError(
        "--class-from-folder: not used with a library, which knows the classes: "
        "'shape3d library add --class-from-folder' sets them");
  }
  const ShapeLibrary library(source.path, ShapeLibrary::Access::read);
  LibraryDescriptor descriptor;
  try {
    descriptor = library.descriptor(source.descriptor);
  } catch (const std::invalid_argument& error) {
    throw UsageError("--descriptor " + source.descriptor + ": " + error.what());
  }
  LibraryVectors vectors = library.vectors(descriptor.spec);
  TrainingSet set;
  set.source = source.path;
  set.spec = vectors.spec;
  set.vectors = std::move(vectors.vectors);
  set.class_names = vectors.classes;
  set.labels.assign(vectors.labels.begin(), vectors.labels.end());
  std::map<std::int64_t, std::string> paths;
  for (const LibraryModel& model : library.models()) paths.emplace(model.id, model.file.path);
  for (const std::int64_t id : vectors.ids) set.files.push_back(paths[id]);
  return set;
}

// Classes of a library that have no model among the vectors.
void drop_empty_classes(TrainingSet& set) {
  const std::vector<int> sizes = class_sizes(set);
  std::vector<int> number(sizes.size(), learning::kUnlabelled);
  std::vector<std::string> kept;
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    if (sizes[c] == 0) continue;
    number[c] = static_cast<int>(kept.size());
    kept.push_back(set.class_names[c]);
  }
  for (int& label : set.labels) {
    if (label >= 0) label = number[static_cast<std::size_t>(label)];
  }
  set.class_names = std::move(kept);
}

}  // namespace

TrainingSet read_training_set(const TrainingSource& source) {
  const bool library = lower_case(fs::path(source.path).extension().string()) == ".db";
  if (!library && !feature_format(source.path)) {
    throw UsageError(source.path + ": expected a library (.db) or a table of vectors (" +
                     std::string(kFeatureExtensions) + ")");
  }
  TrainingSet set = library ? of_library(source) : of_table(source);
  if (set.vectors.rows() == 0) throw FileError(source.path, "has no vectors of " + set.spec);
  drop_empty_classes(set);
  return set;
}

std::vector<int> class_sizes(const TrainingSet& set) {
  std::vector<int> sizes(set.class_names.size(), 0);
  for (const int label : set.labels) {
    if (label >= 0) ++sizes[static_cast<std::size_t>(label)];
  }
  return sizes;
}

void require_classes(const TrainingSet& set, const Settings& settings) {
  if (set.class_names.size() < 2) {
    const std::string found = set.class_names.empty()
                                  ? "no model has a class"
                                  : "the only class is " + in_quotes(set.class_names.front());
    const bool table = feature_format(set.source).has_value();
    throw FileError(set.source, found + ", expected two classes or more; " +
                                    (table ? "--class-from-folder takes"
                                           : "'shape3d library add' with --classes or "
                                             "--class-from-folder takes") +
                                    " them from names");
  }
  std::string names;
  int count = 0;
  const std::vector<int> sizes = class_sizes(set);
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    if (sizes[c] != 1) continue;
    if (++count <= 5) names += (names.empty() ? "" : ", ") + set.class_names[c];
  }
  if (count == 0) return;
  if (count > 5) names += " …";
  warn(settings, set.source + ": " + std::to_string(count) +
                     (count == 1 ? " class has" : " classes have") +
                     " a single model, which cross-validation cannot predict: " + printable(names));
}

}  // namespace shape3d::apps
