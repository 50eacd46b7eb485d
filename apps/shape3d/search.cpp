#include "search.hpp"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include <shape3d/descriptors/descriptor.hpp>

#include "common/byte_source.hpp"
#include "common/describe_mesh.hpp"
#include "common/error.hpp"
#include "common/mesh_io.hpp"
#include "common/output_file.hpp"
#include "common/private_display.hpp"
#include "program.hpp"
#include "progress.hpp"
#include "report.hpp"

namespace shape3d::apps {
namespace {

struct SearchArguments {
  std::string library, mesh;
  std::int64_t id = 0;  ///< 0: the query is `mesh`.
  int count = 11;
  std::string descriptor, norm = "L2", sheet;
  std::optional<std::string> class_name;
};

void check(const SearchArguments& arguments) {
  if (arguments.mesh.empty() == (arguments.id == 0)) {
    throw UsageError(arguments.mesh.empty() ? "no query is named, expected a mesh or --id N"
                                            : "expected a mesh or --id N, not both");
  }
  if (!arguments.sheet.empty() && std::filesystem::path(arguments.sheet).extension() != ".png") {
    throw UsageError("--sheet " + arguments.sheet + ": expected a name that ends in .png");
  }
  if (arguments.descriptor.empty()) return;
  try {
    static_cast<void>(descriptors::Descriptor::parse(arguments.descriptor));
  } catch (const std::invalid_argument& error) {
    throw UsageError("--descriptor " + arguments.descriptor + ": " + error.what());
  }
}

Query query_of_id(const ShapeLibrary& library, std::int64_t id, const std::string& spec) {
  Query query;
  query.name = std::to_string(id);
  query.model = library.model(id);
  if (!query.model) throw FileError(library.path(), "has no model " + std::to_string(id));
  query.class_name = query.model->class_name;
  const std::optional<Eigen::VectorXd> vector = library.vector(id, spec);
  if (!vector) {
    throw FileError(library.path(),
                    "has no vector of model " + std::to_string(id) + " by '" + spec +
                        "'; 'shape3d library add' of its mesh with this descriptor makes one");
  }
  query.vector = *vector;
  return query;
}

Query query_of_mesh(const ShapeLibrary& library, const std::string& path, const std::string& spec,
                    const Settings& settings) {
  Query query;
  query.name = path;
  const std::optional<MeshFormat> format = mesh_format(path);
  if (!format) throw FileError(path, unknown_mesh_extension(path));
  const MappedFile file(path);
  query.model = library.model_of_digest(digest_of(file.bytes()));
  MeshFile parsed = parse_mesh(file.bytes(), *format, path);
  for (const std::string& sentence : parsed.warnings) warn(settings, path + ": " + sentence);
  query.mesh = std::move(parsed.mesh);
  std::optional<Eigen::VectorXd> stored;
  if (query.model) {
    query.class_name = query.model->class_name;
    stored = library.vector(query.model->id, spec);
  }
  if (stored) {
    query.vector = *stored;
    return query;
  }
  try {
    query.vector =
        describe_mesh(*query.mesh, {descriptors::Descriptor::parse(spec)}, settings.threads)
            .front();
  } catch (const FileError&) {
    throw;
  } catch (const std::exception& error) {
    throw FileError(path, error.what());
  }
  return query;
}

Json to_json(const Query& query) {
  Json json;
  json["query"] = query.name;
  json["id"] = query.model ? Json(query.model->id) : Json(nullptr);
  json["class"] = query.class_name ? Json(*query.class_name) : Json(nullptr);
  return json;
}

void print(const Query& query, const std::vector<Found>& found, const std::string& spec) {
  std::cout << line("query", query.name);
  if (query.model) {
    std::cout << line("in the library", "model " + std::to_string(query.model->id) +
                                            ", which is left out of what is found");
  }
  if (query.class_name) std::cout << line("class", printable(*query.class_name));
  std::cout << line("descriptor", spec) << "\n  rank      id   distance  class and file\n";
  for (std::size_t i = 0; i < found.size(); ++i) {
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, "%6d %7lld %10.5g  ", static_cast<int>(i + 1),
                  static_cast<long long>(found[i].model.id), found[i].match.distance);
    std::cout << numbers << printable(found[i].model.class_name.value_or("-")) << "  "
              << printable(found[i].model.file.path) << '\n';
  }
}

void search(const SearchArguments& arguments, const Settings& settings) {
  check(arguments);
  std::optional<OutputFile> sheet;
  const ShapeLibrary library(arguments.library, ShapeLibrary::Access::read);
  const std::string spec = library.descriptor(arguments.descriptor).spec;
  if (!arguments.sheet.empty()) sheet.emplace(arguments.sheet);
  Progress progress(settings);
  Stopwatch watch;
  progress.stage("describing the query");
  Query query = arguments.id > 0 ? query_of_id(library, arguments.id, spec)
                                 : query_of_mesh(library, arguments.mesh, spec, settings);
  if (arguments.class_name) query.class_name = arguments.class_name;
  const double describe_seconds = watch.lap();
  progress.stage("reading " + arguments.library);
  const SearchSet set(library.vectors(spec),
                      arguments.norm == "L1" ? learning::Norm::L1 : learning::Norm::L2);
  const double read_seconds = watch.lap();
  std::vector<std::int64_t> without;
  if (query.model) without.push_back(query.model->id);
  const std::vector<Match> matches = set.nearest(
      query.vector, static_cast<std::size_t>(arguments.count), without, settings.threads);
  const double search_seconds = watch.lap();
  std::vector<Found> found;
  for (const Match& match : matches) {
    const std::optional<LibraryModel> model = library.model(match.id);
    if (model) found.push_back({match, *model});  // unless it was removed meanwhile
  }
  const std::size_t others = set.ids().size() - (query.model && !set.ids().empty() ? 1 : 0);
  if (matches.size() < static_cast<std::size_t>(arguments.count)) {
    warn(settings, "there are " + std::to_string(others) + " models to find, fewer than -n " +
                       std::to_string(arguments.count));
  }
  if (sheet) {
    progress.stage("drawing " + arguments.sheet);
    sheet->write(draw_sheet(library, query, found));
    sheet->finish();
  }
  progress.clear();
  Json report = report_head("search");
  report["library"] = arguments.library;
  report.update(to_json(query));
  report["descriptor"] = spec;
  report["distance"] = arguments.norm;
  report["models"] = set.ids().size();
  report["found"] = Json::array();
  for (const Found& entry : found) {
    report["found"].push_back(
        {{"id", entry.model.id},
         {"distance", entry.match.distance},
         {"class", entry.model.class_name ? Json(*entry.model.class_name) : Json(nullptr)},
         {"file", entry.model.file.path}});
  }
  report["seconds"] = {
      {"describe", describe_seconds}, {"read", read_seconds}, {"search", search_seconds}};
  write_json(settings, report);
  if (sheet) sheet->commit();
  if (!settings.quiet) print(query, found, spec);
}

}  // namespace

void add_search(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<SearchArguments>();
  CLI::App* command =
      app.add_subcommand("search", "Find the models of a library that are like one");
  command->add_option("LIBRARY", arguments->library, "The library (.db)")->required();
  command->add_option("QUERY", arguments->mesh, "A mesh (.ply, .obj, .off, .stl, .vtp)");
  command->add_option("--id", arguments->id, "The query is this model of the library")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  command->add_option("-n", arguments->count, "How many to find (default 11)")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  command
      ->add_option("--descriptor", arguments->descriptor,
                   "By which descriptor of the library; default: the first")
      ->type_name("SPEC");
  command->add_option("--distance", arguments->norm, "L1 or L2 (default L2)")
      ->check(CLI::IsMember({"L1", "L2"}))
      ->type_name("NORM");
  command
      ->add_option("--class", arguments->class_name,
                   "The class of the query, for the colors of the sheet")
      ->type_name("NAME");
  command
      ->add_option("--sheet", arguments->sheet,
                   "Draw the query and what was found: frames are green for the query, blue for "
                   "its class, red for others, grey where a class is not known (.png)")
      ->type_name("FILE");
  command->footer(
      "A query that is in the library, by its content, is not found itself.\n"
      "Examples:\n"
      "  shape3d search shapes.db query.off --sheet found.png\n"
      "  shape3d search shapes.db --id 17 -n 31 --json found.json");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { search(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
