#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <shape3d/mapping/progressive.hpp>

#include "common/byte_source.hpp"
#include "common/error.hpp"
#include "mapping_report.hpp"
#include "mesh_commands.hpp"
#include "mesh_subject.hpp"
#include "simplify.hpp"

namespace shape3d::apps {
namespace {

constexpr const char* kLevelsExtension = ".s3dp";

struct SimplifyArguments {
  std::string mesh, output, levels;
  std::int64_t triangles = 0;
  std::string cost = "quadrics";
  PictureArguments picture;
};

mapping::ProgressiveMesh read_levels(const std::string& path) {
  const MappedFile file(path);
  const std::string_view bytes = file.bytes();
  try {
    return mapping::ProgressiveMesh::from_bytes(reinterpret_cast<const std::byte*>(bytes.data()),
                                                bytes.size());
  } catch (const std::invalid_argument& error) {
    throw FileError(path, error.what());
  }
}

Mesh level_of(const mapping::ProgressiveMesh& levels, const std::string& space) {
  Mesh mesh;
  mesh.V = levels.V();
  mesh.F = levels.F();
  mesh.space = space;
  return mesh;
}

void run_simplify(const SimplifyArguments& arguments, const Settings& settings) {
  const std::optional<mapping::CollapseCost> cost = collapse_cost_named(arguments.cost);
  if (!cost) {
    throw UsageError("--cost " + arguments.cost + ": expected quadrics, lindstrom_turk or hoppe");
  }
  if (arguments.output.empty() && arguments.levels.empty())
    throw UsageError("nothing is to be written: give -o FILE, --levels FILE or both");
  if (!arguments.output.empty() && arguments.triangles == 0)
    throw UsageError("-o " + arguments.output + " needs --triangles N");
  if (!arguments.levels.empty() &&
      std::filesystem::path(arguments.levels).extension() != kLevelsExtension) {
    throw UsageError("--levels " + arguments.levels + ": expected a name that ends in " +
                     kLevelsExtension);
  }
  std::optional<MeshOutput> output;
  if (!arguments.output.empty()) output.emplace("-o", arguments.output);
  std::optional<OutputFile> levels_file;
  if (!arguments.levels.empty()) levels_file.emplace(arguments.levels);
  PictureOutput picture(arguments.picture);
  Progress progress(settings);
  Json report = report_head("simplify");
  Stopwatch watch;
  std::optional<mapping::ProgressiveMesh> levels;
  std::string space;
  if (std::filesystem::path(arguments.mesh).extension() == kLevelsExtension) {
    progress.stage("reading " + arguments.mesh);
    levels = read_levels(arguments.mesh);
    report["input"] = arguments.mesh;
    report["seconds"]["read"] = watch.lap();
  } else {
    const Mesh mesh = read_subject(arguments.mesh, settings, progress, report);
    space = mesh.space;
    progress.stage("simplifying " + arguments.mesh);
    watch.lap();
    // All levels are made when they are to be kept, else only those down to the one that is wanted.
    const std::int64_t coarsest = arguments.levels.empty() ? arguments.triangles : 4;
    levels =
        make_levels(mesh, arguments.mesh, *cost, std::max<std::int64_t>(coarsest, 1), progress);
    report["seconds"]["collapse"] = watch.lap();
    report["cost"] = arguments.cost;
  }
  report["finest"] = levels->finest();
  report["coarsest"] = levels->coarsest();
  report["collapses"] = levels->collapses();
  const Mesh finest = picture.wanted() ? level_of(*levels, space) : Mesh{};
  if (levels_file) {
    const std::vector<std::byte> bytes = levels->to_bytes();
    levels_file->write(bytes.data(), bytes.size());
    levels_file->finish();
    report["levels"] = {{"file", arguments.levels}, {"bytes", bytes.size()}};
    report["seconds"]["encode"] = watch.lap();
  }
  Mesh result;
  if (arguments.triangles > 0) {
    watch.lap();
    levels->set_triangle_count(arguments.triangles);
    result = level_of(*levels, space);
    report["seconds"]["level"] = watch.lap();
    report["result"] = {{"vertices", result.V.rows()}, {"triangles", result.F.rows()}};
    if (result.F.rows() > arguments.triangles) {
      warn(settings, arguments.mesh + ": " + std::to_string(result.F.rows()) +
                         " triangles are the fewest that keep its topology and its form, " +
                         std::to_string(arguments.triangles) + " were asked for");
    }
  }
  if (output) {
    output->write(result);
    report["output"] = arguments.output;
  }
  if (picture.wanted()) {
    progress.stage("drawing " + arguments.picture.path);
    std::vector<Panel> panels{plain_panel(finest, grouped(finest.F.rows()) + " triangles")};
    if (arguments.triangles > 0)
      panels.push_back(plain_panel(result, grouped(result.F.rows()) + " triangles"));
    picture.draw(panels, 2, 1600, 840);
  }
  write_json(settings, report);
  if (output) output->commit();
  if (levels_file) levels_file->commit();
  picture.commit();
  progress.clear();
  if (!settings.quiet) {
    std::cout << line("mesh", arguments.mesh) << line("finest", grouped(levels->finest()))
              << line("coarsest", grouped(levels->coarsest()))
              << line("collapses", grouped(levels->collapses()));
    if (arguments.triangles > 0) {
      std::cout << line("vertices", grouped(result.V.rows()))
                << line("triangles", grouped(result.F.rows()));
    }
    if (output) std::cout << line("output", arguments.output);
    if (levels_file) std::cout << line("levels", arguments.levels);
  }
}

}  // namespace

std::optional<mapping::CollapseCost> collapse_cost_named(const std::string& name) {
  for (const mapping::CollapseCost cost :
       {mapping::CollapseCost::quadrics, mapping::CollapseCost::lindstrom_turk,
        mapping::CollapseCost::hoppe}) {
    if (to_string(cost) == name) return cost;
  }
  return std::nullopt;
}

mapping::ProgressiveMesh make_levels(const Mesh& mesh, const std::string& path,
                                     mapping::CollapseCost cost, std::int64_t coarsest,
                                     Progress& progress) {
  const mapping::Inspection found = mapping::inspect(mesh.V, mesh.F);
  mapping::ProgressiveOptions options;
  options.cost = cost;
  options.coarsest = coarsest;
  options.progress = [&progress](double share) {
    progress.update(share);
    return true;
  };
  try {
    return mapping::ProgressiveMesh(mesh.V, mesh.F, options);
  } catch (const std::invalid_argument& error) {
    // The same sentence, with the remedy by its name here.
    for (const mapping::Finding& finding : found.findings) {
      const std::string sentence = to_sentence(finding, "repair()", "wrap()");
      if (std::string(error.what()) == "V, F: " + sentence)
        throw FileError(path, to_sentence(finding, "shape3d repair", "shape3d wrap"));
    }
    throw FileError(path, error.what());
  }
}

void add_simplify(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<SimplifyArguments>();
  CLI::App* command =
      app.add_subcommand("simplify", "Make a mesh of fewer triangles, or all levels of detail");
  command
      ->add_option("MESH", arguments->mesh,
                   "A mesh (.ply, .obj, .off, .stl, .vtp), or levels of detail (.s3dp)")
      ->required();
  command
      ->add_option("--triangles", arguments->triangles, "The finest level of at most N triangles")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{2147483647}))
      ->type_name("N");
  command->add_option("-o,--output", arguments->output, "The mesh of that level")
      ->type_name("FILE");
  command
      ->add_option("--levels", arguments->levels,
                   "All levels of detail, from which any can be taken exactly (.s3dp)")
      ->type_name("FILE");
  command
      ->add_option("--cost", arguments->cost,
                   "What is collapsed first: quadrics (default, fastest), lindstrom_turk, hoppe "
                   "(energy of distances, springs and sharp edges)")
      ->type_name("NAME");
  add_picture_options(*command, arguments->picture, "The mesh and the level");
  command->footer(
      "Examples:\n"
      "  shape3d simplify bunny.off --triangles 4000 -o coarse.ply --picture coarse.png\n"
      "  shape3d simplify bunny.off --levels bunny.s3dp\n"
      "  shape3d simplify bunny.s3dp --triangles 500 -o coarse.ply");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { run_simplify(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
