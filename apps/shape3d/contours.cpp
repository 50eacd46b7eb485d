#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <shape3d/zmc/contour.hpp>

#include "common/error.hpp"
#include "common/output_file.hpp"
#include "common/polylines.hpp"
#include "report.hpp"
#include "volume_options.hpp"

namespace shape3d::apps {
namespace {

struct ContourArguments {
  VolumeArguments volume;
  double isovalue = 0.0;
  std::string axis = "z";
  std::int64_t slice = 0;
  std::string output;
  std::string space = "lps";
};

double length_of(const zmc::Contour& contour) {
  double length = 0.0;
  for (Eigen::Index e = 0; e < contour.E.rows(); ++e) {
    length += (contour.V.row(contour.E(e, 0)) - contour.V.row(contour.E(e, 1))).norm();
  }
  return length;
}

void draw_contours(const ContourArguments& arguments, const Settings& settings) {
  const std::string extension = std::filesystem::path(arguments.output).extension().string();
  if (extension != ".svg" && extension != ".vtp") {
    throw UsageError("-o " + arguments.output + ": expected a name that ends in .svg or .vtp");
  }
  if (!std::isfinite(arguments.isovalue))
    throw UsageError("--iso " + shortest(arguments.isovalue) + ": expected a finite number");
  OutputFile file(arguments.output);
  Progress progress(settings);
  Stopwatch watch;
  const Volume volume = read_volume_of(arguments.volume, settings, progress);
  const double read_seconds = watch.lap();
  const int axis = arguments.axis == "x" ? 0 : arguments.axis == "y" ? 1 : 2;
  const std::int64_t planes = volume.view.dims[static_cast<std::size_t>(axis)];
  if (arguments.slice < 0 || arguments.slice >= planes) {
    throw UsageError("--slice " + std::to_string(arguments.slice) +
                     ": expected an index from 0 to " + std::to_string(planes - 1) + " for axis " +
                     arguments.axis + " of " + arguments.volume.path);
  }
  progress.stage("extracting the contour");
  zmc::Contour contour;
  try {
    contour = zmc::contour(volume.view, arguments.isovalue, axis, arguments.slice,
                           to_options(arguments.volume, settings));
  } catch (const std::invalid_argument& error) {
    fail_for(arguments.volume.path, error);
  }
  const std::vector<Polyline> lines = join_edges(contour);
  const double contour_seconds = watch.lap();
  if (contour.E.rows() == 0) {
    warn(settings, emptiness("the contour of slice " + std::to_string(arguments.slice),
                             arguments.isovalue, volume.view, arguments.volume.path));
  }
  const double length = length_of(contour);
  if (extension == ".svg") {
    write_svg(file, contour, lines, SlicePlane(volume.view, axis),
              "Isovalue " + shortest(arguments.isovalue) + ", " + arguments.axis + " = " +
                  std::to_string(arguments.slice));
  } else {
    if (arguments.space == "ras") contour.V.leftCols<2>() *= -1.0;
    write_contour_vtp(file, contour, lines, arguments.space == "ras" ? "RAS" : "LPS");
  }
  const auto closed =
      std::count_if(lines.begin(), lines.end(), [](const Polyline& line) { return line.closed; });
  const auto open = static_cast<std::int64_t>(lines.size()) - closed;
  Json report = report_head("contours");
  report["input"] = {
      {"file", arguments.volume.path}, {"format", volume.format}, {"dims", volume.view.dims}};
  report["isovalue"] = arguments.isovalue;
  report["axis"] = arguments.axis;
  report["slice"] = arguments.slice;
  report["output"] = arguments.output;
  report["vertices"] = contour.V.rows();
  report["edges"] = contour.E.rows();
  report["closed_lines"] = closed;
  report["open_lines"] = open;
  report["length"] = length;
  report["seconds"] = {
      {"read", read_seconds}, {"contour", contour_seconds}, {"write", watch.lap()}};
  file.finish();
  write_json(settings, report);
  file.commit();
  progress.clear();
  if (settings.quiet) return;
  std::cout << line("volume", arguments.volume.path)
            << line("plane", arguments.axis + " = " + std::to_string(arguments.slice))
            << line("isovalue", shortest(arguments.isovalue)) << line("output", arguments.output)
            << line("vertices", grouped(contour.V.rows()))
            << line("edges", grouped(contour.E.rows())) << line("closed lines", grouped(closed))
            << line("open lines", grouped(open)) << line("length", rounded(length) + " mm");
}

}  // namespace

void add_contours(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<ContourArguments>();
  CLI::App* command = app.add_subcommand(
      "contours", "Write the contour in a plane of the volume, from the surface's own edges");
  add_volume_options(*command, arguments->volume);
  command->add_option("--iso", arguments->isovalue, "The isovalue")->required()->type_name("V");
  command->add_option("--axis", arguments->axis, "The axis across the plane (default z)")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->type_name("x|y|z");
  command->add_option("--slice", arguments->slice, "Index of the plane along the axis, from 0")
      ->required()
      ->type_name("K");
  command
      ->add_option("-o,--output", arguments->output,
                   "A picture (.svg) or lines in world coordinates (.vtp)")
      ->required()
      ->type_name("FILE");
  add_space_option(*command, arguments->space);
  command->footer(
      "Examples:\n"
      "  shape3d contours skull.mhd --iso 226 --axis z --slice 54 -o slice.svg\n"
      "  shape3d contours skull.mhd --iso -300 --axis x --slice 128 -o sagittal.vtp\n"
      "The contour is closed off the border of the plane.");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { draw_contours(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
