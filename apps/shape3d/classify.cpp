#include <algorithm>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include <shape3d/descriptors/descriptor.hpp>
#include <shape3d/learning/som_maps.hpp>
#include <shape3d/learning/svm.hpp>

#include "common/describe_mesh.hpp"
#include "common/error.hpp"
#include "common/feature_table.hpp"
#include "common/mesh_io.hpp"
#include "common/model_io.hpp"
#include "learning_commands.hpp"
#include "progress.hpp"
#include "report.hpp"

namespace shape3d::apps {
namespace {

struct ClassifyArguments {
  std::string model;
  std::vector<std::string> inputs;
};

// What is to be classified.
struct Subjects {
  std::vector<std::string> files;
  learning::Features vectors;  // a row for each
  std::vector<std::pair<std::string, std::string>> failed;
};

descriptors::Descriptor descriptor_of(const learning::ModelFile& model, const std::string& path) {
  try {
    return descriptors::Descriptor::parse(model.descriptor);
  } catch (const std::invalid_argument& error) {
    throw FileError(path, "its descriptor cannot be understood: " + std::string(error.what()));
  }
}

Subjects of_table(const std::string& path, const learning::ModelFile& model) {
  const FeatureTable table = read_features(path);
  std::string found;
  for (const FeatureSet& set : table.sets) {
    found += (found.empty() ? "" : "; ") + set.spec;
    if (set.spec != model.descriptor) continue;
    Subjects subjects;
    subjects.vectors = set.vectors;
    for (const FeatureFile& file : table.files) subjects.files.push_back(file.path);
    return subjects;
  }
  throw FileError(path, "has vectors of " + found + "; expected " + model.descriptor +
                            ", which the model was trained on");
}

Subjects of_meshes(const ClassifyArguments& arguments, const learning::ModelFile& model,
                   Eigen::Index length, const Settings& settings) {
  const descriptors::Descriptor descriptor = descriptor_of(model, arguments.model);
  if (descriptor.length() != length) {
    throw FileError(arguments.model, "vectors of its descriptor have " +
                                         std::to_string(descriptor.length()) +
                                         " numbers, expected " + std::to_string(length));
  }
  Subjects subjects;
  std::vector<Eigen::VectorXd> vectors;
  Progress progress(settings);
  progress.stage("describing " + std::to_string(arguments.inputs.size()) + " meshes");
  for (std::size_t i = 0; i < arguments.inputs.size(); ++i) {
    const std::string& path = arguments.inputs[i];
    std::string reason;
    try {
      const MeshFile file = read_mesh(path);
      if (!settings.quiet && !file.warnings.empty()) progress.clear();
      for (const std::string& sentence : file.warnings) warn(settings, path + ": " + sentence);
      vectors.push_back(describe_mesh(file.mesh, {descriptor}, settings.threads).front());
      subjects.files.push_back(path);
    } catch (const FileError& error) {
      reason = error.what();
    } catch (const std::invalid_argument& error) {
      reason = path + ": " + error.what();
    } catch (const std::runtime_error& error) {
      reason = path + ": " + error.what();
    }
    if (!reason.empty()) {
      progress.clear();
      std::cerr << "shape3d: " << reason << '\n';
      subjects.failed.emplace_back(path, reason);
    }
    progress.update(static_cast<double>(i + 1) / static_cast<double>(arguments.inputs.size()));
  }
  progress.clear();
  subjects.vectors.resize(static_cast<Eigen::Index>(vectors.size()), length);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    subjects.vectors.row(static_cast<Eigen::Index>(i)) = vectors[i];
  }
  return subjects;
}

Subjects subjects_of(const ClassifyArguments& arguments, const learning::ModelFile& model,
                     Eigen::Index length, const Settings& settings) {
  std::size_t tables = 0;
  for (const std::string& input : arguments.inputs) tables += feature_format(input) ? 1 : 0;
  if (tables == 0) return of_meshes(arguments, model, length, settings);
  if (arguments.inputs.size() > 1) {
    throw UsageError("expected meshes, or one table of vectors and nothing else");
  }
  return of_table(arguments.inputs.front(), model);
}

// The name of a class in a model; null for none.
Json class_json(const learning::ModelFile& model, int label) {
  if (label < 0 || static_cast<std::size_t>(label) >= model.class_names.size()) return nullptr;
  return model.class_names[static_cast<std::size_t>(label)];
}

std::string class_text(const Json& name) {
  return name.is_null() ? "-" : printable(name.get<std::string>());
}

Subjects classify_by_svm(const ClassifyArguments& arguments, const learning::ModelFile& model,
                         const Settings& settings, Json& results) {
  const auto svm = model_body<learning::Svm>(model, arguments.model);
  Subjects subjects = subjects_of(arguments, model, svm.dimension(), settings);
  const learning::Labels labels = svm.predict(subjects.vectors, settings.threads);
  learning::Features P;
  if (svm.options().probabilities) P = svm.probabilities(subjects.vectors, settings.threads);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    Json result = {{"file", subjects.files[i]}, {"class", class_json(model, labels[i])}};
    std::string text = class_text(result["class"]);
    if (P.size() > 0) {
      Json all = Json::object();
      double own = 0.0;
      for (std::size_t c = 0; c < svm.classes().size(); ++c) {
        const double p = P(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c));
        all[class_text(class_json(model, svm.classes()[c]))] = p;
        if (svm.classes()[c] == labels[i]) own = p;
      }
      result["probabilities"] = all;
      text += " (" + rounded(100.0 * own) + " %)";
    }
    if (!settings.quiet) std::cout << printable(subjects.files[i]) << ": " << text << '\n';
    results.push_back(result);
  }
  return subjects;
}

Subjects classify_on_map(const ClassifyArguments& arguments, const learning::ModelFile& model,
                         const Settings& settings, Json& results) {
  const auto map = model_body<learning::SomModel>(model, arguments.model);
  Subjects subjects = subjects_of(arguments, model, map.som.prototypes.cols(), settings);
  const auto best = learning::best_units(map.som, subjects.vectors, settings.threads);
  learning::Labels labels(subjects.files.size(), learning::kUnlabelled);
  const bool labelled = std::any_of(map.labels.begin(), map.labels.end(),
                                    [](int label) { return label != learning::kUnlabelled; });
  if (labelled) {
    labels = learning::classify_by_som(map.som, map.labels, subjects.vectors, settings.threads);
  }
  const int columns = map.som.grid.columns;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const int unit = best.first[i];
    Json result = {{"file", subjects.files[i]},
                   {"class", class_json(model, labels[i])},
                   {"row", unit / columns},
                   {"column", unit % columns},
                   {"cluster", map.clusters[static_cast<std::size_t>(unit)]},
                   {"distance", best.distance(static_cast<Eigen::Index>(i))}};
    if (!settings.quiet) {
      std::cout << printable(subjects.files[i]) << ": " << class_text(result["class"]) << ", unit "
                << unit / columns << ' ' << unit % columns << '\n';
    }
    results.push_back(result);
  }
  return subjects;
}

void classify(const ClassifyArguments& arguments, const Settings& settings) {
  const learning::ModelFile model = read_model(arguments.model);
  Json report = report_head("classify");
  report["model"] = arguments.model;
  report["kind"] = std::string(learning::to_string(model.kind));
  report["descriptor"] = model.descriptor;
  Json results = Json::array();
  Subjects subjects;
  if (model.kind == learning::ModelKind::svm) {
    subjects = classify_by_svm(arguments, model, settings, results);
  } else if (model.kind == learning::ModelKind::som) {
    subjects = classify_on_map(arguments, model, settings, results);
  } else {
    throw FileError(arguments.model,
                    "is a metric, expected a model by 'shape3d train svm' or "
                    "'train som'");
  }
  report["results"] = results;
  report["failed"] = Json::array();
  for (const auto& [file, reason] : subjects.failed) {
    report["failed"].push_back({{"file", file}, {"reason", reason}});
  }
  write_json(settings, report);
  if (subjects.failed.empty()) return;
  std::cout.flush();
  throw std::runtime_error(std::to_string(subjects.failed.size()) + " of " +
                           std::to_string(arguments.inputs.size()) +
                           " meshes could not be classified");
}

}  // namespace

void add_classify(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<ClassifyArguments>();
  CLI::App* command = app.add_subcommand("classify", "Tell the classes of meshes by a model");
  command->add_option("MODEL", arguments->model, "Made by 'train svm' or 'train som'")->required();
  command
      ->add_option("MESH", arguments->inputs,
                   "Meshes (.ply, .obj, .off, .stl, .vtp), or one table of vectors (.csv, .npy, "
                   ".h5)")
      ->required();
  command->footer(
      "A map also tells the unit, by row and column from 0.\n"
      "Examples:\n"
      "  shape3d classify shapes.model a.off b.off\n"
      "  shape3d classify map.model vectors.h5 --json units.json");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { classify(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
