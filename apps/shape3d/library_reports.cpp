#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <stdexcept>

#include "common/error.hpp"
#include "common/feature_table.hpp"
#include "common/output_file.hpp"
#include "common/shape_library.hpp"
#include "common/text.hpp"
#include "descriptor_arguments.hpp"
#include "library_arguments.hpp"
#include "progress.hpp"
#include "report.hpp"

namespace shape3d::apps {
namespace {

namespace fs = std::filesystem;

Json to_json(const LibraryModel& model) {
  Json json;
  json["id"] = model.id;
  json["file"] = model.file.path;
  json["class"] = model.class_name ? Json(*model.class_name) : Json(nullptr);
  json["vertices"] = model.vertices;
  json["triangles"] = model.triangles;
  json["size"] = model.file.size;
  json["digest"] = model.digest;
  return json;
}

std::string class_text(const LibraryModel& model) {
  return model.class_name ? printable(*model.class_name) : "-";
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

void info_of_model(const ShapeLibrary& library, std::int64_t id, const Settings& settings) {
  const std::optional<LibraryModel> model = library.model(id);
  if (!model) throw FileError(library.path(), "has no model " + std::to_string(id));
  Json report = report_head("library info");
  report["library"] = library.path();
  report["model"] = to_json(*model);
  report["descriptors"] = Json::array();
  std::string lines;
  for (const LibraryDescriptor& descriptor : library.descriptors()) {
    const std::optional<Eigen::VectorXd> vector = library.vector(id, descriptor.spec);
    if (!vector) continue;
    report["descriptors"].push_back(
        {{"spec", descriptor.spec},
         {"vector", std::vector<double>(vector->data(), vector->data() + vector->size())}});
    lines += line("descriptor", descriptor.spec);
  }
  report["thumbnail"] = !library.thumbnail(id).empty();
  write_json(settings, report);
  if (settings.quiet) return;
  std::cout << line("model", std::to_string(id)) << line("file", printable(model->file.path))
            << line("class", class_text(*model)) << line("vertices", grouped(model->vertices))
            << line("triangles", grouped(model->triangles)) << line("digest", model->digest)
            << lines;
}

// "7" → 7, a path → its model.
std::optional<LibraryModel> named_model(const ShapeLibrary& library, const std::string& name) {
  const std::optional<std::int64_t> id = parse_integer(name);
  if (id) return library.model(*id);
  return library.model_of_path(fs::absolute(name).lexically_normal().string());
}

FeatureTable table_of(const ShapeLibrary& library, const std::vector<std::string>& specs) {
  std::vector<LibraryVectors> sets;
  for (const std::string& spec : specs) sets.push_back(library.vectors(spec));
  // Models that have all of them.
  std::map<std::int64_t, std::vector<Eigen::Index>> rows;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (std::size_t row = 0; row < sets[s].ids.size(); ++row) {
      std::vector<Eigen::Index>& own = rows[sets[s].ids[row]];
      if (own.size() == s) own.push_back(static_cast<Eigen::Index>(row));
    }
  }
  FeatureTable table;
  for (const LibraryVectors& set : sets) table.sets.push_back({set.spec, {}});
  std::vector<std::vector<Eigen::Index>> chosen;
  for (const LibraryModel& model : library.models()) {
    const auto place = rows.find(model.id);
    if (place == rows.end() || place->second.size() < sets.size()) continue;
    table.files.push_back(model.file);
    table.classes.push_back(model.class_name.value_or(""));
    chosen.push_back(place->second);
  }
  const auto count = static_cast<Eigen::Index>(chosen.size());
  for (std::size_t s = 0; s < sets.size(); ++s) {
    table.sets[s].vectors.resize(count, sets[s].vectors.cols());
    for (Eigen::Index row = 0; row < count; ++row) {
      table.sets[s].vectors.row(row) =
          sets[s].vectors.row(chosen[static_cast<std::size_t>(row)][s]);
    }
  }
  return table;
}

}  // namespace

void library_list(const LibraryListArguments& arguments, const Settings& settings) {
  const ShapeLibrary library(arguments.library, ShapeLibrary::Access::read);
  std::vector<LibraryModel> models = library.models();
  if (arguments.class_name) {
    const auto other = [&](const LibraryModel& model) {
      return model.class_name != arguments.class_name;
    };
    models.erase(std::remove_if(models.begin(), models.end(), other), models.end());
    if (models.empty()) {
      throw FileError(arguments.library, "has no model of class '" + *arguments.class_name + "'");
    }
  }
  Json report = report_head("library list");
  report["library"] = arguments.library;
  report["models"] = Json::array();
  for (const LibraryModel& model : models) report["models"].push_back(to_json(model));
  write_json(settings, report);
  if (settings.quiet) return;
  std::size_t width = 5;
  for (const LibraryModel& model : models) width = std::max(width, class_text(model).size());
  std::cout << "    id  " << padded("class", width) << "  triangles  file\n";
  for (const LibraryModel& model : models) {
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, "%6lld  ", static_cast<long long>(model.id));
    std::cout << numbers << padded(class_text(model), width);
    std::snprintf(numbers, sizeof numbers, "  %9lld  ", static_cast<long long>(model.triangles));
    std::cout << numbers << printable(model.file.path) << '\n';
  }
}

void library_info(const LibraryInfoArguments& arguments, const Settings& settings) {
  const ShapeLibrary library(arguments.library, ShapeLibrary::Access::read);
  if (arguments.id != 0) {
    info_of_model(library, arguments.id, settings);
    return;
  }
  const std::int64_t models = library.size();
  const std::vector<std::pair<std::string, std::int64_t>> classes = library.classes();
  std::int64_t of_class = 0;
  for (const auto& [name, count] : classes) of_class += count;
  const auto without = static_cast<std::int64_t>(library.models_without_thumbnail().size());
  const std::uintmax_t bytes = fs::file_size(arguments.library);
  Json report = report_head("library info");
  report["library"] = arguments.library;
  report["version"] = library.version();
  report["bytes"] = bytes;
  report["models"] = models;
  report["thumbnails"] = models - without;
  report["descriptors"] = Json::array();
  for (const LibraryDescriptor& descriptor : library.descriptors()) {
    report["descriptors"].push_back(
        {{"spec", descriptor.spec}, {"length", descriptor.length}, {"models", descriptor.models}});
  }
  report["classes"] = Json::array();
  for (const auto& [name, count] : classes) {
    report["classes"].push_back({{"name", name}, {"models", count}});
  }
  report["without_class"] = models - of_class;
  report["items"] = Json::array();
  for (const LibraryItem& item : library.items()) {
    report["items"].push_back({{"name", item.name}, {"kind", item.kind}, {"bytes", item.size}});
  }
  write_json(settings, report);
  if (settings.quiet) return;
  std::cout << line("library", arguments.library)
            << line("version", std::to_string(library.version()))
            << line("size", bytes_to_text(bytes)) << line("models", grouped(models))
            << line("thumbnails", grouped(models - without));
  for (const LibraryDescriptor& descriptor : library.descriptors()) {
    std::cout << line("descriptor", descriptor.spec)
              << line("", std::to_string(descriptor.length) + " numbers, " +
                              grouped(descriptor.models) + " models");
  }
  std::cout << line("classes", std::to_string(classes.size()));
  for (const auto& [name, count] : classes) {
    std::cout << line("  " + printable(name), grouped(count));
  }
  if (models > of_class) std::cout << line("without class", grouped(models - of_class));
  for (const LibraryItem& item : library.items()) {
    std::cout << line(item.kind, item.name + ", " + bytes_to_text(item.size));
  }
}

void library_remove(const LibraryRemoveArguments& arguments, const Settings& settings) {
  if (arguments.models.empty() && !arguments.missing) {
    throw UsageError("no model is named, expected ids, paths or --missing");
  }
  ShapeLibrary library(arguments.library, ShapeLibrary::Access::write);
  std::map<std::int64_t, LibraryModel> chosen;
  for (const std::string& name : arguments.models) {
    std::optional<LibraryModel> model = named_model(library, name);
    if (!model) throw FileError(arguments.library, "has no model " + name);
    chosen.emplace(model->id, std::move(*model));
  }
  if (arguments.missing) {
    std::error_code error;
    for (const LibraryModel& model : library.models()) {
      if (!fs::exists(model.file.path, error)) chosen.emplace(model.id, model);
    }
  }
  Json report = report_head("library remove");
  report["library"] = arguments.library;
  report["removed"] = Json::array();
  for (const auto& [id, model] : chosen) {
    library.remove(id);
    report["removed"].push_back(to_json(model));
  }
  report["models"] = library.size();
  write_json(settings, report);
  if (!settings.quiet) {
    std::cout << line("removed", std::to_string(chosen.size()))
              << line("models", grouped(library.size()));
  }
}

void library_check(const LibraryCheckArguments& arguments, const Settings& settings) {
  const ShapeLibrary library(arguments.library, ShapeLibrary::Access::read);
  Progress progress(settings);
  progress.stage("checking " + arguments.library);
  const std::vector<LibraryFault> faults = library.check(!arguments.no_files);
  progress.clear();
  std::map<LibraryFault::Kind, std::int64_t> counts;
  Json report = report_head("library check");
  report["library"] = arguments.library;
  report["faults"] = Json::array();
  for (const LibraryFault& fault : faults) {
    ++counts[fault.kind];
    report["faults"].push_back({{"kind", fault.kind == LibraryFault::Kind::damage    ? "damage"
                                         : fault.kind == LibraryFault::Kind::missing ? "missing"
                                                                                     : "changed"},
                                {"id", fault.id},
                                {"sentence", fault.sentence}});
  }
  report["clean"] = faults.empty();
  write_json(settings, report);
  for (const LibraryFault& fault : faults) std::cerr << "shape3d: " << fault.sentence << '\n';
  if (faults.empty()) {
    if (!settings.quiet) {
      std::cout << line("library", arguments.library) << line("models", grouped(library.size()))
                << line("damage", "none");
    }
    return;
  }
  std::string sentence;
  const auto count = [&](LibraryFault::Kind kind, const std::string& what) {
    if (counts[kind] == 0) return;
    sentence += (sentence.empty() ? "" : ", ") + std::to_string(counts[kind]) + " " + what;
  };
  count(LibraryFault::Kind::damage, "places of damage");
  count(LibraryFault::Kind::missing, "missing files");
  count(LibraryFault::Kind::changed, "changed files");
  throw FileError(arguments.library, sentence);
}

void library_export(const LibraryExportArguments& arguments, const Settings& settings) {
  std::string path;
  for (const auto& [option, name, ending] : {std::tuple{"--npy", arguments.npy, FeatureFormat::npy},
                                             std::tuple{"--csv", arguments.csv, FeatureFormat::csv},
                                             std::tuple{"--h5", arguments.h5, FeatureFormat::h5}}) {
    if (name.empty()) continue;
    if (!path.empty()) throw UsageError("expected one of --npy, --csv and --h5");
    if (feature_format(name) != ending) {
      throw UsageError(std::string(option) + " " + name + ": expected a name that ends in ." +
                       std::string(option).substr(2));
    }
    path = name;
  }
  if (path.empty()) throw UsageError("no file is named, expected --npy, --csv or --h5");
  static_cast<void>(parse_descriptors(arguments.descriptors));
  const ShapeLibrary library(arguments.library, ShapeLibrary::Access::read);
  std::vector<std::string> specs;
  for (const std::string& spec : arguments.descriptors) {
    specs.push_back(library.descriptor(spec).spec);
  }
  if (specs.empty()) specs.push_back(library.descriptor("").spec);
  OutputFile file(path);
  const FeatureTable table = table_of(library, specs);
  write_features(file, *feature_format(path), table);
  file.finish();
  const auto count = static_cast<std::int64_t>(table.files.size());
  Json report = report_head("library export");
  report["library"] = arguments.library;
  report["output"] = path;
  report["descriptors"] = specs;
  report["models"] = count;
  report["left_out"] = library.size() - count;
  write_json(settings, report);
  file.commit();
  if (count < library.size()) {
    warn(settings, std::to_string(library.size() - count) +
                       " models are left out: they do not have vectors of all descriptors");
  }
  if (!settings.quiet) {
    for (const std::string& spec : specs) std::cout << line("descriptor", spec);
    std::cout << line("models", grouped(count)) << line("output", path);
  }
}

}  // namespace shape3d::apps
