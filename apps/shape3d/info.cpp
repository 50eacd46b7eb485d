#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/error.hpp"
#include "common/mesh_io.hpp"
#include "common/volume_io.hpp"
#include "mesh_report.hpp"
#include "progress.hpp"
#include "report.hpp"

namespace shape3d::apps {
namespace {

struct InfoArguments {
  std::string path;
  std::string series;
};

void info(const InfoArguments& arguments, const Settings& settings) {
  Progress progress(settings);
  if (!detect_volume_format(arguments.path)) {
    if (!mesh_format(arguments.path)) {
      throw FileError(arguments.path,
                      "is neither a volume (DICOM, NIfTI, NRRD, MetaImage, VTI) nor a mesh (PLY, "
                      "OBJ, OFF, STL, VTP)");
    }
    report_mesh("info", arguments.path, settings);
    return;
  }
  progress.stage("reading " + arguments.path);
  VolumeReadOptions options;
  options.series = arguments.series;
  const Volume volume = read_volume(arguments.path, options);
  for (const std::string& sentence : volume.warnings) warn(settings, sentence);
  const VolumeDescription description = describe_volume(volume);
  progress.clear();
  if (!settings.quiet) std::cout << line("file", arguments.path) << to_lines(description);
  Json report = report_head("info");
  report["file"] = arguments.path;
  report.update(to_json(description));
  report["warnings"] = volume.warnings;
  write_json(settings, report);
}

}  // namespace

void add_info(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* command = app.add_subcommand("info", "Say what a volume or a mesh file holds");
  command
      ->add_option(
          "FILE", arguments->path,
          "A volume (a folder of DICOM slices, .nii, .nii.gz, .nrrd, .mha, .mhd, .vti) or a mesh")
      ->required();
  command
      ->add_option("--series", arguments->series,
                   "The DICOM series: its UID, or its number in the list")
      ->type_name("UID|N");
  command->footer(
      "Examples:\n"
      "  shape3d info skull.mhd\n"
      "  shape3d info scan/ --series 2 --json scan.json\n"
      "  shape3d info bone.ply");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { info(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
