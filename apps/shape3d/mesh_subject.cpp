#include "mesh_subject.hpp"

#include <filesystem>
#include <utility>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>

namespace shape3d::apps {
namespace {

MeshFormat format_of(const std::string& option, const std::string& path) {
  const std::optional<MeshFormat> format = mesh_format(path);
  if (!format) throw UsageError(option + " " + path + ": " + unknown_mesh_extension(path));
  return *format;
}

SceneMesh scene_mesh(const Mesh& mesh) {
  SceneMesh item;
  item.mesh = view_of(mesh);
  item.mesh.vertex_arrays = nullptr;
  item.mesh.triangle_arrays = nullptr;
  return item;
}

constexpr double kDataShading = 0.35;  // enough to show the form, too little to hide the color
constexpr Eigen::Index kEdgesShown = 6000;

}  // namespace

Mesh read_subject(const std::string& path, const Settings& settings, Progress& progress,
                  Json& report) {
  progress.stage("reading " + path);
  Stopwatch watch;
  MeshFile file = read_mesh(path);
  for (const std::string& sentence : file.warnings) warn(settings, path + ": " + sentence);
  report["input"] = path;
  report["format"] = to_string(file.format);
  report["polygons"] = file.polygons;
  report["vertices"] = file.mesh.V.rows();
  report["triangles"] = file.mesh.F.rows();
  report["seconds"]["read"] = watch.lap();
  return std::move(file.mesh);
}

MeshOutput::MeshOutput(const std::string& option, const std::string& path)
    : format_(format_of(option, path)), file_(path) {}

void MeshOutput::write(const Mesh& mesh) {
  write_mesh(file_, format_, view_of(mesh));
  file_.finish();
}

void add_picture_options(CLI::App& command, PictureArguments& arguments, const std::string& what) {
  command.add_option("--picture", arguments.path, what + " (.png)")->type_name("FILE");
  command
      .add_option("--view", arguments.view,
                  "From where the picture is seen: " + std::string(kViewNames) +
                      " (default upright, for meshes whose y axis points up)")
      ->type_name("VIEW");
}

PictureOutput::PictureOutput(const PictureArguments& arguments) {
  const std::optional<View> view = view_named(arguments.view);
  if (!view)
    throw UsageError("--view " + arguments.view + ": expected one of " + std::string(kViewNames));
  options_.view = *view;
  if (arguments.path.empty()) return;
  if (std::filesystem::path(arguments.path).extension() != ".png")
    throw UsageError("--picture " + arguments.path + ": expected a name that ends in .png");
  file_.emplace(arguments.path);
}

void PictureOutput::draw(const std::vector<Panel>& panels, int columns, int width, int height) {
  options_.width = width;
  options_.height = height;
  file_->write(draw_panels(panels, options_, columns));
  file_->finish();
}

void PictureOutput::commit() {
  if (file_) file_->commit();
}

Panel plain_panel(const Mesh& mesh, const std::string& caption) {
  Panel panel;
  panel.meshes.push_back(scene_mesh(mesh));
  panel.meshes.back().edges = mesh.F.rows() <= kEdgesShown;
  panel.caption = caption;
  return panel;
}

Panel vertex_colors_panel(const Mesh& mesh, std::vector<std::uint8_t> colors,
                          const std::string& caption) {
  Panel panel;
  panel.meshes.push_back(scene_mesh(mesh));
  panel.meshes.back().vertex_colors = std::move(colors);
  panel.meshes.back().shading = kDataShading;
  panel.caption = caption;
  return panel;
}

Panel triangle_colors_panel(const Mesh& mesh, std::vector<std::uint8_t> colors,
                            const ColorScale& scale, const std::string& caption) {
  Panel panel;
  panel.meshes.push_back(scene_mesh(mesh));
  panel.meshes.back().triangle_colors = std::move(colors);
  panel.meshes.back().shading = kDataShading;
  panel.caption = caption;
  panel.scale = scale;
  return panel;
}

}  // namespace shape3d::apps
