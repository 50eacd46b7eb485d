#include "search.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include <shape3d/descriptors/descriptor.hpp>

#include "common/error.hpp"
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
  bool weighted = false;
  std::string coarse;  ///< Descriptor of the first stage; empty: there is one stage.
  int shortlist = 0;   ///< Models that go to the second stage; 0: ten times `count`.
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
  for (const auto& [option, spec] : {std::pair{"--descriptor ", arguments.descriptor},
                                     std::pair{"--coarse ", arguments.coarse}}) {
    if (spec.empty()) continue;
    try {
      static_cast<void>(descriptors::Descriptor::parse(spec));
    } catch (const std::invalid_argument& error) {
      throw UsageError(option + spec + ": " + error.what());
    }
  }
  if (!arguments.coarse.empty() && arguments.weighted) {
    throw UsageError("--weighted: not used with --coarse");
  }
  if (arguments.coarse.empty() && arguments.shortlist > 0) {
    throw UsageError("--shortlist: expected with --coarse SPEC");
  }
  if (arguments.shortlist > 0 && arguments.shortlist < arguments.count) {
    throw UsageError("--shortlist " + std::to_string(arguments.shortlist) +
                     ": expected at least -n " + std::to_string(arguments.count));
  }
}

learning::Norm norm_of(const SearchArguments& arguments) {
  return arguments.norm == "L1" ? learning::Norm::L1 : learning::Norm::L2;
}

struct Searched {
  std::vector<Match> matches;
  std::size_t models = 0;     // that could be found
  std::size_t shortlist = 0;  // of them, compared by the descriptor itself
  std::vector<std::pair<std::string, double>>
      classes;  // probable ones of the query, for --weighted
  double describe_seconds = 0.0, read_seconds = 0.0, search_seconds = 0.0;
};

// By the coarse vectors first; then the best of them by the fine ones, which alone are read.
Searched search_coarse_to_fine(const SearchArguments& arguments, const ShapeLibrary& library,
                               const Query& query, const std::string& spec,
                               const Settings& settings) {
  Searched result;
  Stopwatch watch;
  const std::string coarse = library.descriptor(arguments.coarse).spec;
  const Eigen::VectorXd coarse_vector = vector_of(library, query, coarse, settings.threads),
                        vector = vector_of(library, query, spec, settings.threads);
  result.describe_seconds = watch.lap();
  const SearchSet set(library.vectors(coarse), norm_of(arguments));
  result.read_seconds = watch.lap();
  const int count = arguments.shortlist > 0 ? arguments.shortlist : 10 * arguments.count;
  const std::vector<Match> shortlist = set.nearest(coarse_vector, static_cast<std::size_t>(count),
                                                   left_out(query), settings.threads);
  result.models = set.ids().size();
  LibraryVectors chosen;
  std::vector<Eigen::VectorXd> vectors;
  std::vector<std::int64_t> ids;
  for (const Match& match : shortlist) ids.push_back(match.id);
  std::sort(ids.begin(), ids.end());
  for (const std::int64_t id : ids) {
    std::optional<Eigen::VectorXd> other = library.vector(id, spec);
    if (!other) continue;
    chosen.ids.push_back(id);
    vectors.push_back(std::move(*other));
  }
  chosen.vectors.resize(static_cast<Eigen::Index>(vectors.size()), vector.size());
  for (std::size_t row = 0; row < vectors.size(); ++row) {
    chosen.vectors.row(static_cast<Eigen::Index>(row)) = vectors[row];
  }
  result.shortlist = vectors.size();
  result.matches =
      SearchSet(std::move(chosen), norm_of(arguments))
          .nearest(vector, static_cast<std::size_t>(arguments.count), {}, settings.threads);
  result.search_seconds = watch.lap();
  return result;
}

Searched search_all(const SearchArguments& arguments, const ShapeLibrary& library,
                    const Query& query, const std::string& spec, const Settings& settings) {
  Searched result;
  Stopwatch watch;
  const Eigen::VectorXd vector = vector_of(library, query, spec, settings.threads);
  result.describe_seconds = watch.lap();
  const SearchSet set(library.vectors(spec), norm_of(arguments));
  result.read_seconds = watch.lap();
  result.models = set.ids().size();
  const auto count = static_cast<std::size_t>(arguments.count);
  if (!arguments.weighted) {
    result.matches = set.nearest(vector, count, left_out(query), settings.threads);
  } else {
    WeightedMatches weighted =
        weighted_matches(set, query, vector, count, library.path(), settings.threads);
    result.matches = std::move(weighted.matches);
    result.classes = std::move(weighted.classes);
  }
  result.search_seconds = watch.lap();
  return result;
}

Json to_json(const Query& query) {
  Json json;
  json["query"] = query.name;
  json["id"] = query.model ? Json(query.model->id) : Json(nullptr);
  json["class"] = query.class_name ? Json(*query.class_name) : Json(nullptr);
  return json;
}

void print(const Query& query, const Searched& searched, const std::vector<Found>& found,
           const std::string& spec) {
  std::cout << line("query", query.name);
  if (query.model) {
    std::cout << line("in the library", "model " + std::to_string(query.model->id) +
                                            ", which is left out of what is found");
  }
  if (query.class_name) std::cout << line("class", printable(*query.class_name));
  if (!searched.classes.empty()) {
    std::string names;
    for (const auto& [name, share] : searched.classes) {
      names += (names.empty() ? "" : ", ") + printable(name) + " " + rounded(share);
    }
    std::cout << line("probable classes", names);
  }
  if (searched.shortlist > 0) {
    std::cout << line("shortlist", grouped(static_cast<std::int64_t>(searched.shortlist)) + " of " +
                                       grouped(static_cast<std::int64_t>(searched.models)));
  }
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
  progress.stage("searching " + arguments.library);
  std::vector<std::string> warnings;
  Query query = arguments.id > 0 ? query_of_id(library, arguments.id)
                                 : query_of_mesh(library, arguments.mesh, warnings);
  for (const std::string& sentence : warnings) warn(settings, arguments.mesh + ": " + sentence);
  const Searched searched = arguments.coarse.empty()
                                ? search_all(arguments, library, query, spec, settings)
                                : search_coarse_to_fine(arguments, library, query, spec, settings);
  if (arguments.class_name) query.class_name = arguments.class_name;  // for the colors alone
  std::vector<Found> found;
  for (const Match& match : searched.matches) {
    const std::optional<LibraryModel> model = library.model(match.id);
    if (model) found.push_back({match, *model});  // unless it was removed meanwhile
  }
  if (found.size() < static_cast<std::size_t>(arguments.count)) {
    warn(settings, "there are " + std::to_string(found.size()) + " models to find, fewer than -n " +
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
  report["weighted"] = arguments.weighted;
  if (arguments.weighted) {
    report["probable_classes"] = Json::array();
    for (const auto& [name, share] : searched.classes) {
      report["probable_classes"].push_back({{"class", name}, {"probability", share}});
    }
  }
  if (!arguments.coarse.empty()) {
    report["coarse"] = library.descriptor(arguments.coarse).spec;
    report["shortlist"] = searched.shortlist;
  }
  report["models"] = searched.models;
  report["found"] = Json::array();
  for (const Found& entry : found) {
    report["found"].push_back(
        {{"id", entry.model.id},
         {"distance", entry.match.distance},
         {"class", entry.model.class_name ? Json(*entry.model.class_name) : Json(nullptr)},
         {"file", entry.model.file.path}});
  }
  report["seconds"] = {{"describe", searched.describe_seconds},
                       {"read", searched.read_seconds},
                       {"search", searched.search_seconds}};
  write_json(settings, report);
  if (sheet) sheet->commit();
  if (!settings.quiet) print(query, searched, found, spec);
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
  command->add_flag("--weighted", arguments->weighted,
                    "By the class-weighted distance (5.19): models of classes that the query's "
                    "neighbours are of count as nearer; the query's own class is not looked at");
  command
      ->add_option("--coarse", arguments->coarse,
                   "Compare by this descriptor of the library first, then the best of it by the "
                   "other")
      ->type_name("SPEC");
  command
      ->add_option("--shortlist", arguments->shortlist,
                   "How many are compared twice (default ten times -n)")
      ->check(CLI::Range(1, 100000000))
      ->type_name("N");
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
