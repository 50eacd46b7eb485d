#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>

#include "common/error.hpp"
#include "common/mesh_folder.hpp"
#include "common/mesh_io.hpp"
#include "common/offscreen.hpp"
#include "common/output_file.hpp"
#include "progress.hpp"
#include "render_arguments.hpp"
#include "report.hpp"

namespace shape3d::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kCell = 200;          // pixels of a picture when no size is given
constexpr int kMost = 8192;         // pixels of a page
constexpr std::size_t kBatch = 24;  // meshes that one process draws

struct Drawn {
  Raster raster;
  std::string error;  // why there is no picture; empty: there is one
};

struct SheetOptions {
  int cell = kCell;
  Color color{}, background{};
  std::optional<View> view;  // empty: by the mesh
  bool largest = false, private_display = false;
};

// The picture of one mesh, or a sentence after a mark.
std::string draw_mesh(const fs::path& path, const SheetOptions& options, SceneRenderer& renderer) {
  try {
    const Mesh mesh = read_mesh(path.string()).mesh;
    if (mesh.F.rows() == 0) throw FileError(path, "has no triangle to draw");
    std::vector<SceneMesh> scene(1);
    scene[0].mesh = view_of(mesh);
    scene[0].color = options.color;
    scene[0].largest_only = options.largest;
    scene[0].shading = 0.97;  // not 1: ambient occlusion takes longer than all else
    const View view = options.view.value_or(mesh.space.empty() ? View::upright : View::front);
    const Raster raster = renderer.render(scene, view);
    return std::string(1, '\1') +
           std::string(reinterpret_cast<const char*>(raster.rgb.data()), raster.rgb.size());
  } catch (const std::exception& error) {
    return std::string(1, '\0') + error.what();
  }
}

void draw_batch(const std::vector<fs::path>& paths, std::size_t first, std::size_t last,
                const SheetOptions& options, std::vector<Drawn>& drawn) {
  const std::string bytes = draw_offscreen(
      [&] {
        SceneRenderer renderer(options.cell, options.cell, options.background);
        std::string all;
        for (std::size_t n = first; n < last; ++n) {
          const std::string one = draw_mesh(paths[n], options, renderer);
          const std::uint64_t size = one.size();
          all.append(reinterpret_cast<const char*>(&size), sizeof size);
          all += one;
        }
        return all;
      },
      options.private_display);
  const char* at = bytes.data();
  for (std::size_t n = first; n < last; ++n) {
    std::uint64_t size = 0;
    std::memcpy(&size, at, sizeof size);
    at += sizeof size;
    if (*at == '\1') {
      drawn[n].raster = make_raster(options.cell, options.cell, options.background);
      std::memcpy(drawn[n].raster.rgb.data(), at + 1, drawn[n].raster.rgb.size());
    } else {
      drawn[n].error.assign(at + 1, size - 1);
    }
    at += size;
  }
}

// Columns of cells of equal sides that come nearest to a page of 4 : 3.
int columns_of(std::size_t cells) {
  return std::max(1,
                  static_cast<int>(std::ceil(std::sqrt(4.0 * static_cast<double>(cells) / 3.0))));
}

// The page of `count` cells, when none is asked for: captions are in its height.
void size_page(PictureOptions& options, std::size_t count, int columns) {
  const int rows = (static_cast<int>(count) + columns - 1) / columns;
  const int across = std::min(columns, static_cast<int>(count));
  options.width = std::min(kMost, across * (kCell + 4));
  options.height = std::min(kMost, rows * (kCell + 24));
}

std::string caption_of(const fs::path& path, const std::string& folder) {
  return printable(path.lexically_relative(folder).replace_extension().generic_string());
}

void check(const RenderArguments& arguments) {
  if (!arguments.meshes.empty()) throw UsageError("expected meshes or --sheet DIR, not both");
  if (!arguments.opacities.empty()) throw UsageError("--opacity: not used with --sheet");
  if (arguments.colors.size() > 1)
    throw UsageError("--color is given " + std::to_string(arguments.colors.size()) +
                     " times; a sheet has one color");
}

}  // namespace

void render_sheet(const RenderArguments& arguments, const Settings& settings) {
  check(arguments);
  PictureOptions page = picture_options(arguments);
  SheetOptions options;
  options.color = color_of("--color", arguments.colors.empty() ? "bone" : arguments.colors[0]);
  options.background = page.background;
  options.largest = arguments.largest;
  options.private_display = page.private_display;
  if (!arguments.view.empty()) options.view = page.view;
  const std::vector<fs::path> paths = meshes_below(arguments.sheet);
  OutputFile file(arguments.output);
  Progress progress(settings);
  Stopwatch watch;
  progress.stage("drawing the meshes of " + arguments.sheet);
  std::vector<Drawn> drawn(paths.size());
  for (std::size_t first = 0; first < paths.size(); first += kBatch) {
    const std::size_t last = std::min(first + kBatch, paths.size());
    draw_batch(paths, first, last, options, drawn);
    progress.update(static_cast<double>(last) / static_cast<double>(paths.size()));
  }
  progress.clear();
  std::vector<Panel> panels;
  Json left_out = Json::array();
  for (std::size_t n = 0; n < paths.size(); ++n) {
    if (drawn[n].error.empty()) {
      Panel panel;
      panel.image = std::move(drawn[n].raster);
      panel.smooth_image = true;
      panel.caption = caption_of(paths[n], arguments.sheet);
      panels.push_back(std::move(panel));
    } else {
      warn(settings, drawn[n].error);
      left_out.push_back({{"file", paths[n].string()}, {"reason", drawn[n].error}});
    }
  }
  if (panels.empty()) {
    throw FileError(arguments.sheet,
                    "holds " + std::to_string(paths.size()) +
                        " meshes, none of which can be drawn; the first: " + drawn[0].error);
  }
  const int columns = columns_of(panels.size());
  if (arguments.size.empty()) size_page(page, panels.size(), columns);
  file.write(draw_panels(panels, page, columns));
  file.finish();
  Json report = report_head("render");
  report["folder"] = arguments.sheet;
  report["meshes"] = panels.size();
  report["left_out"] = left_out;
  report["output"] = arguments.output;
  report["width"] = page.width;
  report["height"] = page.height;
  report["columns"] = columns;
  report["seconds"] = watch.lap();
  write_json(settings, report);
  file.commit();
  if (settings.quiet) return;
  std::cout << line("meshes", std::to_string(panels.size())) << line("output", arguments.output);
}

}  // namespace shape3d::apps
