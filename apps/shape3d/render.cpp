#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/mesh_io.hpp"
#include "common/output_file.hpp"
#include "common/picture.hpp"
#include "common/text_scanner.hpp"
#include "progress.hpp"
#include "render_arguments.hpp"
#include "report.hpp"

namespace shape3d::apps {

Color color_of(const std::string& option, const std::string& name) {
  const std::optional<Color> color = color_named(name);
  if (!color)
    throw UsageError(option + " " + name + ": expected #rrggbb or one of " +
                     std::string(kColorNames));
  return *color;
}

PictureOptions picture_options(const RenderArguments& arguments) {
  PictureOptions options;
  const std::string size = arguments.size.empty() ? "1000x1000" : arguments.size;
  const std::size_t cross = size.find('x');
  std::int64_t width = 0, height = 0;
  const bool numbers = cross != std::string::npos &&
                       TextScanner::parse(std::string_view(size).substr(0, cross), width) &&
                       TextScanner::parse(std::string_view(size).substr(cross + 1), height);
  if (!numbers || width < 16 || height < 16 || width > 8192 || height > 8192) {
    throw UsageError("--size " + size + ": expected WIDTHxHEIGHT in pixels, each from 16 to 8192");
  }
  options.width = static_cast<int>(width);
  options.height = static_cast<int>(height);
  const std::optional<View> view = view_named(arguments.view.empty() ? "front" : arguments.view);
  if (!view)
    throw UsageError("--view " + arguments.view + ": expected one of " + std::string(kViewNames));
  options.view = *view;
  options.background = color_of("--background", arguments.background);
  options.private_display = arguments.offscreen;
  return options;
}

namespace {

void check_counts(const std::string& option, std::size_t given, std::size_t meshes) {
  if (given > meshes) {
    throw UsageError(option + " is given " + std::to_string(given) + " times for " +
                     std::to_string(meshes) + " meshes");
  }
}

void render(const RenderArguments& arguments, const Settings& settings) {
  if (std::filesystem::path(arguments.output).extension() != ".png") {
    throw UsageError("-o " + arguments.output + ": expected a name that ends in .png");
  }
  if (!arguments.sheet.empty()) {
    render_sheet(arguments, settings);
    return;
  }
  if (arguments.meshes.empty())
    throw UsageError("no mesh is named, expected meshes or --sheet DIR");
  check_counts("--color", arguments.colors.size(), arguments.meshes.size());
  check_counts("--opacity", arguments.opacities.size(), arguments.meshes.size());
  const PictureOptions options = picture_options(arguments);
  static constexpr std::string_view kPalette[] = {"bone",   "blue", "orange", "green",
                                                  "purple", "red",  "yellow", "grey"};
  std::vector<Color> colors;
  for (std::size_t i = 0; i < arguments.meshes.size(); ++i) {
    colors.push_back(i < arguments.colors.size() ? color_of("--color", arguments.colors[i])
                                                 : *color_named(kPalette[i % std::size(kPalette)]));
  }
  OutputFile file(arguments.output);
  Progress progress(settings);
  Stopwatch watch;
  std::vector<MeshFile> meshes;
  for (const std::string& path : arguments.meshes) {
    progress.stage("reading " + path);
    meshes.push_back(read_mesh(path));
    for (const std::string& sentence : meshes.back().warnings)
      warn(settings, path + ": " + sentence);
  }
  const double read_seconds = watch.lap();
  std::vector<SceneMesh> scene;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    scene.push_back({view_of(meshes[i].mesh), colors[i],
                     i < arguments.opacities.size() ? arguments.opacities[i] : 1.0,
                     arguments.largest});
  }
  progress.stage("drawing " + arguments.output);
  file.write(draw_png(scene, options));
  file.finish();
  Json report = report_head("render");
  report["meshes"] = arguments.meshes;
  report["output"] = arguments.output;
  report["width"] = options.width;
  report["height"] = options.height;
  report["view"] = arguments.view.empty() ? "front" : arguments.view;
  report["seconds"] = {{"read", read_seconds}, {"draw", watch.lap()}};
  write_json(settings, report);
  file.commit();
  progress.clear();
  if (!settings.quiet) std::cout << line("output", arguments.output);
}

}  // namespace

void add_render(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "Draw meshes as a picture");
  command->add_option("MESH", arguments->meshes, "Meshes (.ply, .obj, .off, .stl, .vtp)");
  command
      ->add_option("--sheet", arguments->sheet,
                   "Draw all meshes below a folder on one page, each with its name")
      ->type_name("DIR");
  command->add_option("-o,--output", arguments->output, "The picture (.png)")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--size", arguments->size,
                   "Pixels (default 1000x1000; of a sheet, what its meshes need)")
      ->type_name("WxH");
  command
      ->add_option("--color", arguments->colors,
                   "Color of each mesh in turn: #rrggbb, " + std::string(kColorNames))
      ->allow_extra_args(false)
      ->type_name("COLOR");
  command->add_option("--opacity", arguments->opacities, "Opacity of each mesh in turn, 0 to 1")
      ->allow_extra_args(false)
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("X");
  command
      ->add_option("--view", arguments->view,
                   "From where: " + std::string(kViewNames) +
                       " (of a patient in LPS; default front; on a "
                       "sheet, upright for meshes that do not say their space)")
      ->type_name("VIEW");
  command
      ->add_option("--background", arguments->background, "Color of the background (default white)")
      ->type_name("COLOR");
  command->add_flag("--largest", arguments->largest,
                    "Only the component of the most triangles of each mesh");
  command->add_flag("--offscreen", arguments->offscreen, "Draw under Xvfb even if DISPLAY is set");
  command->footer(
      "Examples:\n"
      "  shape3d render bone.ply -o bone.png --view oblique\n"
      "  shape3d render bone.ply skin.ply --color bone --color skin --opacity 1 --opacity 0.3 -o "
      "head.png --size 1600x1200\n"
      "  shape3d render --sheet shapes/ -o sheet.png");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { render(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
