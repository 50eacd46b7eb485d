#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <shape3d/mapping/wrap.hpp>

#include "common/error.hpp"
#include "mapping_report.hpp"
#include "mesh_commands.hpp"
#include "mesh_subject.hpp"

namespace shape3d::apps {
namespace {

struct WrapArguments {
  std::string mesh, output;
  mapping::WrapOptions options;
  PictureArguments picture;
};

void run_wrap(const WrapArguments& arguments, const Settings& settings) {
  MeshOutput output("-o", arguments.output);
  PictureOutput picture(arguments.picture);
  if (arguments.options.coarsest > arguments.options.finest) {
    throw UsageError("--coarsest " + rounded(arguments.options.coarsest) +
                     ": expected a number up to --finest, which is " +
                     rounded(arguments.options.finest));
  }
  Progress progress(settings);
  Json report = report_head("wrap");
  const Mesh mesh = read_subject(arguments.mesh, settings, progress, report);
  progress.stage("wrapping " + arguments.mesh);
  Stopwatch watch;
  mapping::WrapOptions options = arguments.options;
  options.progress = [&progress](double share) {
    progress.update(share);
    return true;
  };
  mapping::Wrapped wrapped;
  try {
    wrapped = mapping::wrap(mesh.V, mesh.F, options);
  } catch (const std::invalid_argument& error) {
    throw FileError(arguments.mesh, error.what());
  }
  report["seconds"]["wrap"] = watch.lap();
  report["output"] = arguments.output;
  report["wrap"] = to_json(wrapped);
  if (wrapped.status != mapping::WrapStatus::ok) {
    write_json(settings, report);
    throw FileError(arguments.mesh, std::string(to_string(wrapped.status)) +
                                        "; a larger --finest or a smaller --coarsest may help");
  }
  Mesh result;
  result.V = wrapped.V;
  result.F = wrapped.F;
  result.space = mesh.space;
  output.write(result);
  if (picture.wanted()) {
    progress.stage("drawing " + arguments.picture.path);
    picture.draw({plain_panel(mesh, "as given"), plain_panel(result, "wrapped")}, 2, 1600, 840);
  }
  write_json(settings, report);
  output.commit();
  picture.commit();
  progress.clear();
  if (!settings.quiet) {
    std::cout << line("mesh", arguments.mesh) << line("alpha", rounded(wrapped.alpha))
              << line("offset", rounded(wrapped.offset))
              << line("attempts", grouped(static_cast<std::int64_t>(wrapped.attempts.size())))
              << line("vertices", grouped(result.V.rows()))
              << line("triangles", grouped(result.F.rows())) << line("genus", "0")
              << line("output", arguments.output);
  }
}

}  // namespace

void add_wrap(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<WrapArguments>();
  CLI::App* command =
      app.add_subcommand("wrap", "Make a closed surface of genus 0 round any triangles");
  command->add_option("MESH", arguments->mesh, "A mesh (.ply, .obj, .off, .stl, .vtp)")->required();
  command->add_option("-o,--output", arguments->output, "The wrap")->required()->type_name("FILE");
  command
      ->add_option("--finest", arguments->options.finest,
                   "Smallest alpha: the diagonal of the bounding box over this (default 50)")
      ->check(CLI::Range(1.0, 1000.0))
      ->type_name("N");
  command
      ->add_option("--coarsest", arguments->options.coarsest, "Largest alpha, likewise (default 4)")
      ->check(CLI::Range(1.0, 1000.0))
      ->type_name("N");
  command
      ->add_option("--offset", arguments->options.offset,
                   "The wrap lies alpha over this outside the mesh (default 30)")
      ->check(CLI::Range(2.0, 1000.0))
      ->type_name("N");
  add_picture_options(*command, arguments->picture, "The mesh and its wrap");
  command->footer(
      "Examples:\n"
      "  shape3d wrap teapot.off -o closed.ply\n"
      "  shape3d wrap teapot.off -o closed.ply --finest 100 --picture wrap.png");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { run_wrap(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
