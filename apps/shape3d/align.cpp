#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <Eigen/LU>
#include <shape3d/mapping/align.hpp>

#include "common/error.hpp"
#include "mapping_report.hpp"
#include "mesh_commands.hpp"
#include "mesh_subject.hpp"

namespace shape3d::apps {
namespace {

struct AlignArguments {
  std::string mesh, output;
  bool reflect = false;
  double tolerance = mapping::PoseOptions{}.ambiguity_tolerance;
  PictureArguments picture;
};

void run_align(const AlignArguments& arguments, const Settings& settings) {
  std::optional<MeshOutput> output;
  if (!arguments.output.empty()) output.emplace("-o", arguments.output);
  PictureOutput picture(arguments.picture);
  Progress progress(settings);
  Json report = report_head("align");
  Mesh mesh = read_subject(arguments.mesh, settings, progress, report);
  progress.stage("aligning " + arguments.mesh);
  Stopwatch watch;
  mapping::PoseOptions options;
  options.allow_reflection = arguments.reflect;
  options.ambiguity_tolerance = arguments.tolerance;
  mapping::Pose pose;
  try {
    pose = mapping::align(mesh.V, mesh.F, options);
  } catch (const std::invalid_argument& error) {
    throw FileError(arguments.mesh, error.what());
  }
  Mesh aligned = mesh;
  aligned.V = mapping::posed(mesh.V, pose);
  aligned.space.clear();  // the axes are those of the body now
  const bool mirrored = pose.rotation.determinant() < 0.0;
  if (mirrored) aligned.F.col(1).swap(aligned.F.col(2));
  report["seconds"]["align"] = watch.lap();
  report["output"] = arguments.output.empty() ? Json(nullptr) : Json(arguments.output);
  report["pose"] = to_json(pose);
  report["mirrored"] = mirrored;
  if (output) output->write(aligned);
  if (picture.wanted()) {
    progress.stage("drawing " + arguments.picture.path);
    picture.draw({plain_panel(mesh, "as given"), plain_panel(aligned, "aligned")}, 2, 1600, 840);
  }
  write_json(settings, report);
  if (output) output->commit();
  picture.commit();
  progress.clear();
  if (!settings.quiet) std::cout << line("mesh", arguments.mesh) << to_lines(pose);
}

}  // namespace

void add_align(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<AlignArguments>();
  CLI::App* command = app.add_subcommand("align", "Bring a mesh into its canonical pose");
  command->add_option("MESH", arguments->mesh, "A mesh (.ply, .obj, .off, .stl, .vtp)")->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "The aligned mesh: centroid at the origin, mean squared distance 1, principal "
                   "axes along x, y, z")
      ->type_name("FILE");
  command->add_flag("--reflect", arguments->reflect,
                    "Allow a mirror image, so that left and right hands have one pose");
  command
      ->add_option("--tolerance", arguments->tolerance,
                   "Eigenvalue gap or margin of the signs below which the pose is ambiguous "
                   "(default 0.01)")
      ->check(CLI::Range(1e-12, 0.999))
      ->type_name("X");
  add_picture_options(*command, arguments->picture, "The mesh as given and aligned");
  command->footer(
      "Examples:\n"
      "  shape3d align hand.off\n"
      "  shape3d align hand.off -o posed.ply --json pose.json --picture posed.png");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { run_align(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
