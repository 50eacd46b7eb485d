#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <shape3d/mapping/repair.hpp>

#include "common/error.hpp"
#include "mapping_report.hpp"
#include "mesh_commands.hpp"
#include "mesh_subject.hpp"

namespace shape3d::apps {
namespace {

struct RepairArguments {
  std::string mesh, output;
  bool keep_all = false, keep_holes = false, self_intersections = false;
  PictureArguments picture;
};

std::string state_of(const mapping::Inspection& inspection) {
  return inspection.spherical() ? "a closed surface of genus 0"
                                : inspection.why_not_spherical(kRepairOption, "shape3d wrap");
}

void run_repair(const RepairArguments& arguments, const Settings& settings) {
  MeshOutput output("-o", arguments.output);
  PictureOutput picture(arguments.picture);
  Progress progress(settings);
  Json report = report_head("repair");
  const Mesh mesh = read_subject(arguments.mesh, settings, progress, report);
  progress.stage("repairing " + arguments.mesh);
  Stopwatch watch;
  mapping::InspectOptions inspect;
  inspect.self_intersections = arguments.self_intersections;
  const mapping::Inspection before = mapping::inspect(mesh.V, mesh.F, inspect);
  mapping::RepairOptions options;
  options.keep_largest = !arguments.keep_all;
  options.fill_holes = !arguments.keep_holes;
  options.progress = [&progress](double share) {
    progress.update(share);
    return true;
  };
  mapping::Repaired repaired;
  try {
    repaired = mapping::repair(mesh.V, mesh.F, options);
  } catch (const std::invalid_argument& error) {
    throw FileError(arguments.mesh, error.what());
  }
  mapping::Inspection after = repaired.after;
  if (arguments.self_intersections) after = mapping::inspect(repaired.V, repaired.F, inspect);
  Mesh result;
  result.V = std::move(repaired.V);
  result.F = std::move(repaired.F);
  result.space = mesh.space;
  report["seconds"]["repair"] = watch.lap();
  report["output"] = arguments.output;
  report["before"] = to_json(before);
  report["repair"] = to_json(repaired.summary);
  report["after"] = to_json(after);
  output.write(result);
  if (picture.wanted()) {
    progress.stage("drawing " + arguments.picture.path);
    picture.draw({plain_panel(mesh, "as given"), plain_panel(result, "repaired")}, 2, 1600, 840);
  }
  write_json(settings, report);
  output.commit();
  picture.commit();
  progress.clear();
  warn_of(arguments.output, after, settings);
  if (!settings.quiet) {
    std::cout << line("mesh", arguments.mesh) << line("before", state_of(before))
              << line("repair", to_sentence(repaired.summary)) << line("after", state_of(after))
              << line("vertices", grouped(result.V.rows()))
              << line("triangles", grouped(result.F.rows())) << line("output", arguments.output);
  }
}

}  // namespace

void add_repair(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<RepairArguments>();
  CLI::App* command =
      app.add_subcommand("repair", "Make a closed, oriented manifold of a damaged mesh");
  command->add_option("MESH", arguments->mesh, "A mesh (.ply, .obj, .off, .stl, .vtp)")->required();
  command->add_option("-o,--output", arguments->output, "The repaired mesh")
      ->required()
      ->type_name("FILE");
  command->add_flag("--keep-all", arguments->keep_all, "Keep all components, not only the largest");
  command->add_flag("--keep-holes", arguments->keep_holes, "Do not fill holes");
  command->add_flag("--self-intersections", arguments->self_intersections,
                    "Count triangles that cut through each other, before and after");
  add_picture_options(*command, arguments->picture, "The mesh as given and repaired");
  command->footer(
      "Examples:\n"
      "  shape3d repair scan.ply -o closed.ply\n"
      "  shape3d repair scan.ply -o closed.ply --json repair.json --picture repair.png");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { run_repair(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
