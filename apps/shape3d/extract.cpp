#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include <CLI/CLI.hpp>

#include "extract_arguments.hpp"

namespace shape3d::apps {
namespace {

void validate(const ExtractArguments& arguments) {
  if (!mesh_format(arguments.output)) {
    throw UsageError("-o " + arguments.output + ": " + unknown_mesh_extension(arguments.output));
  }
  if (!arguments.picture.empty() &&
      std::filesystem::path(arguments.picture).extension() != ".png") {
    throw UsageError("--picture " + arguments.picture + ": expected a name that ends in .png");
  }
  std::vector<double> sorted = arguments.isovalues;
  for (const double isovalue : sorted) {
    if (!std::isfinite(isovalue))
      throw UsageError("--iso " + shortest(isovalue) + ": expected a finite number");
  }
  std::sort(sorted.begin(), sorted.end());
  if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end()) {
    throw UsageError("--iso " + shortest(*twice) + " is given twice");
  }
}

}  // namespace

zmc::VolumeView region_of(const zmc::VolumeView& view, const std::vector<std::int64_t>& roi) {
  if (roi.empty()) return view;
  std::array<std::int64_t, 3> lower{}, upper{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lower[axis] = roi[2 * axis];
    upper[axis] = roi[2 * axis + 1];
    const std::string name(1, "xyz"[axis]), range = name + " from " + std::to_string(lower[axis]) +
                                                    " to " + std::to_string(upper[axis]);
    if (lower[axis] < 0 || upper[axis] > view.dims[axis]) {
      throw UsageError("--roi: " + range + " (the end is not included) reaches outside the " +
                       std::to_string(view.dims[axis]) + " samples in " + name +
                       ", expected 0 ≤ start < end ≤ " + std::to_string(view.dims[axis]));
    }
    if (upper[axis] - lower[axis] < 2) {
      throw UsageError("--roi: " + range + " (the end is not included) holds " +
                       std::to_string(std::max<std::int64_t>(upper[axis] - lower[axis], 0)) +
                       " samples in " + name + ", expected 2 or more");
    }
  }
  return zmc::subvolume(view, lower, upper);
}

std::vector<std::string> output_names(const std::string& output,
                                      const std::vector<double>& isovalues, MeshFormat format) {
  if (isovalues.size() == 1 || format == MeshFormat::vtp) return {output};
  const std::filesystem::path path(output);
  std::vector<std::string> names;
  for (const double isovalue : isovalues) {
    names.push_back((path.parent_path() /
                     (path.stem().string() + "_" + shortest(isovalue) + path.extension().string()))
                        .string());
  }
  return names;
}

void add_extract(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<ExtractArguments>();
  CLI::App* command = app.add_subcommand("extract", "Write the isosurface of a volume as a mesh");
  add_volume_options(*command, arguments->volume);
  command->add_option("--iso", arguments->isovalues, "The isovalue; may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->type_name("V");
  command
      ->add_option("-o,--output", arguments->output,
                   "The mesh: .ply, .obj, .off, .stl or .vtp. Several isovalues give NAME_V.ext "
                   "each; one .vtp holds all, with an "
                   "array 'isovalue'")
      ->required()
      ->type_name("FILE");
  static const std::map<std::string, zmc::Triangulation> kTriangulations{
      {"compact", zmc::Triangulation::compact}, {"centroid", zmc::Triangulation::centroid}};
  command
      ->add_option("--triangulation", arguments->triangulation,
                   "Without new vertices (compact, default), or round the centroid of each patch")
      ->transform(CLI::CheckedTransformer(kTriangulations))
      ->type_name("compact|centroid");
  static const std::map<std::string, zmc::ZeroFaces> kZeroFaces{
      {"boundary", zmc::ZeroFaces::boundary}, {"mating", zmc::ZeroFaces::mating}};
  command
      ->add_option("--zero-faces", arguments->zero_faces,
                   "Cell faces of four samples equal to the isovalue: where they divide the sides "
                   "(boundary, default), or all of "
                   "them, so that a face shared by two touching parts stays (mating)")
      ->transform(CLI::CheckedTransformer(kZeroFaces))
      ->type_name("boundary|mating");
  command
      ->add_option("--roi", arguments->roi,
                   "Only samples x0 ≤ x < x1, y0 ≤ y < y1, z0 ≤ z < z1, by index")
      ->delimiter(',')
      ->expected(6)
      ->type_name("x0,x1,y0,y1,z0,z1");
  command->add_flag("--cap", arguments->cap,
                    "Close the surface where it reaches the border of the volume");
  add_space_option(*command, arguments->space);
  command->add_option("--picture", arguments->picture, "Also draw the surface")
      ->type_name("FILE.png");
  command
      ->add_option("--id-bits", arguments->id_bits,
                   "Width of vertex ids; auto takes 64 when 32 do not suffice")
      ->check(CLI::IsMember({"auto", "32", "64"}))
      ->group("");
  command->footer(
      "Examples:\n"
      "  shape3d extract skull.mhd --iso 226 -o bone.ply --picture bone.png\n"
      "  shape3d extract scan/ --iso 226 --iso -300 -o head.stl        head_226.stl, "
      "head_-300.stl\n"
      "  shape3d extract liver_label.nii.gz --iso 0.5 --cap -o liver.vtp --json liver.json\n"
      "  shape3d extract distance.nrrd --iso 0 --inside below -o shape.obj\n"
      "The surface is closed: every edge off the border of the volume has an even number of "
      "triangles. An isovalue outside the\n"
      "range of the volume gives an empty file and a warning.");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] {
      validate(*arguments);
      extract_surfaces(*arguments, settings);
    };
  });
}

}  // namespace shape3d::apps
