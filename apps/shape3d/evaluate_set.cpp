#include "evaluate_set.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "common/error.hpp"
#include "common/text.hpp"
#include "describe_arguments.hpp"

namespace shape3d::apps {
namespace {

using descriptors::Descriptor;
namespace fs = std::filesystem;

// The parts that a command line names.
struct Parts {
  std::optional<Collection> train;
  Collection test;
};

Parts parts_of_folders(const EvaluateArguments& arguments) {
  for (const auto& [option, value] :
       {std::pair{"--train-cla", arguments.train_classes},
        std::pair{"--test-cla", arguments.test_classes}, std::pair{"--classes", arguments.level},
        std::pair{"--path", arguments.path_pattern}}) {
    if (!value.empty()) throw UsageError(std::string(option) + ": not used with --layout folders");
  }
  FolderCollections folders = folder_collections(arguments.folder);
  Parts parts;
  if (folders.test.models.empty()) {  // nothing but folders "train": they are what there is
    parts.test = std::move(folders.train);
    return parts;
  }
  parts.test = std::move(folders.test);
  if (!folders.train.models.empty()) parts.train = std::move(folders.train);
  return parts;
}

Parts parts_of_class_files(const EvaluateArguments& arguments) {
  if (arguments.test_classes.empty()) {
    throw UsageError("--test-cla is required, or --layout folders");
  }
  const std::string pattern =
      arguments.path_pattern.empty() ? kPrincetonPattern : arguments.path_pattern;
  const auto read = [&](const std::string& file) {
    return princeton_collection(
        arguments.level.empty() ? file : class_file_of_level(file, arguments.level),
        arguments.folder, pattern);
  };
  Parts parts;
  if (!arguments.train_classes.empty()) parts.train = read(arguments.train_classes);
  parts.test = read(arguments.test_classes);
  return parts;
}

// Train and test never mix.
void require_apart(const Parts& parts) {
  if (!parts.train) return;
  std::set<std::string> paths;
  for (const Collection::Model& model : parts.train->models) paths.insert(model.path);
  std::vector<std::string> both;
  for (const Collection::Model& model : parts.test.models) {
    if (paths.count(model.path) != 0) both.push_back(model.id);
  }
  if (both.empty()) return;
  throw std::runtime_error(std::to_string(both.size()) + " models, such as " + both.front() +
                           ", are in " + parts.train->source + " and in " + parts.test.source +
                           ": expected none in both; --folds 5 cross-validates one set");
}

DescribedPart described_part(const Collection& collection, const FeatureTable& table,
                             std::size_t descriptors) {
  std::map<std::string, Eigen::Index> rows;
  for (std::size_t i = 0; i < table.files.size(); ++i) {
    rows[table.files[i].path] = static_cast<Eigen::Index>(i);
  }
  std::map<std::string, std::string> reasons(table.failed.begin(), table.failed.end());
  DescribedPart part;
  part.source = collection.source;
  part.classes = collection.classes;
  part.left_out = collection.missing;
  std::vector<Eigen::Index> taken;
  for (const Collection::Model& model : collection.models) {
    const auto row = rows.find(model.path);
    if (row == rows.end()) {
      part.left_out.push_back("model " + model.id + ": " + model.path + ": " + reasons[model.path]);
      continue;
    }
    part.ids.push_back(model.id);
    part.labels.push_back(model.of_class);
    taken.push_back(row->second);
  }
  for (std::size_t d = 0; d < descriptors; ++d) {
    const auto& all = table.sets[d].vectors;
    learning::Features vectors(static_cast<Eigen::Index>(taken.size()), all.cols());
    for (std::size_t i = 0; i < taken.size(); ++i) {
      vectors.row(static_cast<Eigen::Index>(i)) = all.row(taken[i]);
    }
    part.vectors.push_back(std::move(vectors));
  }
  std::vector<int> sizes(part.classes.size());
  for (const int label : part.labels) ++sizes[static_cast<std::size_t>(label)];
  for (const std::string& name : collection.empty) {
    part.notes.push_back("class " + in_quotes(name) + " has no model that is there");
  }
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    if (sizes[c] == 1) {
      part.notes.push_back("class " + in_quotes(part.classes[c]) +
                           " has one model, which can find no other and is no query");
    }
  }
  return part;
}

// Vectors that an earlier run with other descriptors or of another program left are no use.
bool is_stale(const std::string& path, const std::vector<std::string>& specs) {
  try {
    if (fs::exists(path)) {
      std::vector<std::string> found;
      for (const FeatureSet& set : read_features(path).sets) found.push_back(set.spec);
      return !descriptor_difference(found, specs).empty();
    }
    if (fs::exists(path + ".part")) {
      DescribeJournal(path + ".part", specs, std::vector<Eigen::Index>(specs.size(), 1));
    }
    return false;
  } catch (const FileError&) {
    return true;
  }
}

}  // namespace

EvaluatedDescriptor parse_evaluated(const std::string& text, const std::string& distance) {
  const std::size_t at = text.rfind('@');
  const std::string spec = text.substr(0, at);
  const std::string word = at == std::string::npos ? distance : text.substr(at + 1);
  const auto kind = learning::distance_named(word);
  if (!kind) {
    throw UsageError((at == std::string::npos ? "--distance " : "--descriptor " + text + ": @") +
                     word + ": expected " + std::string(learning::kDistanceNames));
  }
  try {
    return {text, Descriptor::parse(spec), *kind, 1.0, false};
  } catch (const std::invalid_argument& error) {
    throw UsageError("--descriptor " + text + ": " + error.what());
  }
}

std::vector<EvaluatedDescriptor> default_descriptors() {
  const auto part = [](const char* name, const char* spec, learning::Distance distance) {
    return EvaluatedDescriptor{name, Descriptor::parse(spec), distance, 1.0, false};
  };
  using learning::Distance;
  return {part("panorama, surface axes", "panorama:axes=surface", Distance::L1),
          part("panorama, normal axes", "panorama:axes=normals", Distance::L1),
          part("HSH 496", "hsh:K=30,unit=yes", Distance::L1)};
}

std::vector<EvaluatedDescriptor> baseline_descriptors() {
  const auto part = [](const char* name, const char* spec, learning::Distance distance) {
    return EvaluatedDescriptor{name, Descriptor::parse(spec), distance, 1.0, true};
  };
  using learning::Distance;
  return {part("random 45", "random:length=45", Distance::L2),
          part("D2 64", "d2", Distance::L1),
          part("EGI 17", "egi:K=16", Distance::L1),
          part("CSM 45, 5 x 9", "csm:R=5,K=8,fill=binary", Distance::L2),
          part("CSM 45, 9 x 5", "csm:R=9,K=4,fill=binary", Distance::L2),
          part("CSM 45, 5 x 9, weighted", "csm:R=5,K=8,weighted=yes,unit=yes", Distance::L2),
          part("HSH 45, two-sided, binary", "hsh:map=two_sided,K=8,fill=binary", Distance::L2),
          part("HSH 45", "hsh:K=8,unit=yes", Distance::L2)};
}

EvaluatedSet described_set(const EvaluateArguments& arguments, const Settings& settings) {
  EvaluatedSet set;
  for (const std::string& text : arguments.descriptors) {
    set.descriptors.push_back(parse_evaluated(text, arguments.distance));
  }
  if (set.descriptors.empty()) set.descriptors = default_descriptors();
  if (arguments.baseline) {
    for (EvaluatedDescriptor& one : baseline_descriptors()) {
      set.descriptors.push_back(std::move(one));
    }
  }
  std::set<std::string> names;
  for (const EvaluatedDescriptor& one : set.descriptors) {
    if (!names.insert(one.name).second) {
      throw UsageError("--descriptor " + one.name + " is given twice");
    }
  }
  const Parts parts =
      arguments.layout == "folders" ? parts_of_folders(arguments) : parts_of_class_files(arguments);
  require_apart(parts);

  // One column of the table for each different descriptor.
  DescribeArguments describe;
  std::vector<std::size_t> columns;
  for (const EvaluatedDescriptor& one : set.descriptors) {
    const std::string spec = one.descriptor.to_string();
    const auto place = std::find(describe.descriptors.begin(), describe.descriptors.end(), spec);
    columns.push_back(static_cast<std::size_t>(place - describe.descriptors.begin()));
    if (place == describe.descriptors.end()) describe.descriptors.push_back(spec);
  }
  for (const Collection* part : {parts.train ? &*parts.train : nullptr, &parts.test}) {
    if (part == nullptr) continue;
    for (const Collection::Model& model : part->models) describe.meshes.push_back(model.path);
  }
  describe.output = (fs::path(arguments.output) / "vectors.h5").string();
  describe.restart = arguments.restart || is_stale(describe.output, describe.descriptors);
  DescribeOutcome outcome = describe_to_table(describe, settings);
  set.describing = outcome.seconds;
  set.kept = outcome.kept;
  set.described = outcome.table.files.size() - outcome.kept;
  FeatureTable chosen;
  chosen.files = std::move(outcome.table.files);
  chosen.failed = std::move(outcome.table.failed);
  for (const std::size_t column : columns) chosen.sets.push_back(outcome.table.sets[column]);
  outcome.commit();
  if (parts.train) set.train = described_part(*parts.train, chosen, columns.size());
  set.test = described_part(parts.test, chosen, columns.size());
  if (set.test.size() < 2) {
    throw std::runtime_error(parts.test.source + ": has " + std::to_string(set.test.size()) +
                             " models that could be described, expected 2 or more");
  }
  return set;
}

}  // namespace shape3d::apps
