#include "picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "offscreen.hpp"

namespace shape3d::apps {
namespace {

/// Meshes, and the size to draw them in.
struct Drawing {
  const std::vector<SceneMesh>* meshes = nullptr;
  View view = View::front;
  int width = 0, height = 0;
};

void check(const SceneMesh& item) {
  const auto fits = [](const std::vector<std::uint8_t>& colors, std::int64_t items) {
    return colors.empty() || colors.size() == 3 * static_cast<std::size_t>(items);
  };
  const auto refuse = [](const char* what, std::size_t bytes, std::int64_t items) {
    throw PictureError("the colors of the " + std::string(what) + " are " + std::to_string(bytes) +
                       " bytes, expected 3 for each of " + std::to_string(items));
  };
  if (!fits(item.vertex_colors, item.mesh.vertex_count))
    refuse("vertices", item.vertex_colors.size(), item.mesh.vertex_count);
  if (!fits(item.triangle_colors, item.mesh.triangle_count))
    refuse("triangles", item.triangle_colors.size(), item.mesh.triangle_count);
}

void check(const std::vector<SceneMesh>& meshes) {
  const bool anything = std::any_of(meshes.begin(), meshes.end(), [](const SceneMesh& item) {
    return item.mesh.triangle_count > 0;
  });
  if (!anything) throw PictureError("there is no triangle to draw");
  for (const SceneMesh& item : meshes) check(item);
}

// One raster for each drawing.
std::vector<Raster> render(const std::vector<Drawing>& drawings, const PictureOptions& options) {
  std::vector<Raster> rasters;
  if (drawings.empty()) return rasters;
  const std::string output = draw_offscreen(
      [&] {
        std::string pixels;
        for (const Drawing& drawing : drawings) {
          const Raster raster = render_scene(*drawing.meshes, drawing.view, drawing.width,
                                             drawing.height, options.background);
          pixels.append(reinterpret_cast<const char*>(raster.rgb.data()), raster.rgb.size());
        }
        return pixels;
      },
      options.private_display);
  const char* pixels = output.data();
  for (const Drawing& drawing : drawings) {
    rasters.push_back(make_raster(drawing.width, drawing.height, options.background));
    std::memcpy(rasters.back().rgb.data(), pixels, rasters.back().rgb.size());
    pixels += rasters.back().rgb.size();
  }
  return rasters;
}

/// A row of panels: heights of what is above and below their bodies, 0 where no panel has it.
struct Row {
  int caption = 0, foot = 0;
  int top = 0;  ///< Of the row in the picture.
};

/// Where the parts of panels are, in pixels; all bodies have one size.
struct Layout {
  int columns = 0;
  int cell_width = 0, body_height = 0;
  int font = 0;  ///< Height of a line.
  int gap = 0;   ///< Between cells.
  std::vector<Row> rows;
};

Layout layout_of(const std::vector<Panel>& panels, const PictureOptions& options, int columns) {
  Layout layout;
  const int count = static_cast<int>(panels.size());
  layout.columns = columns <= 0 ? count : std::min(columns, count);
  const int rows = (count + layout.columns - 1) / layout.columns;
  layout.gap = std::max(2, std::min(options.width / layout.columns, options.height) / 50);
  layout.cell_width = (options.width - (layout.columns - 1) * layout.gap) / layout.columns;
  int height = options.height - (rows - 1) * layout.gap;
  layout.font = std::clamp(std::min(layout.cell_width, height / rows) / 20, 10, 48);
  layout.rows.resize(static_cast<std::size_t>(rows));
  for (int i = 0; i < count; ++i) {
    Row& row = layout.rows[static_cast<std::size_t>(i / layout.columns)];
    const Panel& panel = panels[static_cast<std::size_t>(i)];
    if (!panel.caption.empty()) row.caption = 3 * layout.font / 2;
    if (panel.scale) row.foot = 4 * layout.font;
  }
  for (const Row& row : layout.rows) height -= row.caption + row.foot;
  layout.body_height = height / rows;
  int top = 0;
  for (Row& row : layout.rows) {
    row.top = top;
    top += row.caption + layout.body_height + row.foot + layout.gap;
  }
  if (layout.cell_width < 32 || layout.body_height < 32) {
    throw PictureError("a picture of " + std::to_string(options.width) + " × " +
                       std::to_string(options.height) + " pixels is too small for " +
                       std::to_string(count) + " panels");
  }
  return layout;
}

// The size of a line that fits into a width.
int fitting_size(const std::string& text, int size, int width, bool bold) {
  const int needed = text_width(text, size, bold);
  return needed <= width ? size : std::max(6, size * width / needed);
}

// From left to right: the title above the bar, the numbers below.
void draw_bar(Raster& page, const ColorScale& scale, int x, int y, const Layout& layout,
              const Color& ink) {
  const int font = layout.font;
  const int width = std::max(24, 7 * layout.cell_width / 10), height = std::max(4, 3 * font / 5);
  const int left = x + (layout.cell_width - width) / 2;
  const int size = fitting_size(scale.title, font, layout.cell_width, false);
  draw_text(page, scale.title, x + layout.cell_width / 2, y + font, size, TextAlign::centre, ink);
  const int top = y + 3 * font / 2;
  fill(page, left - 1, top - 1, width + 2, height + 2, ink);
  for (int column = 0; column < width; ++column) {
    fill(page, left + column, top, 1, height, color_at(scale.map, (column + 0.5) / width));
  }
  const int number = 9 * font / 10;
  const int most = std::max(2, width / (3 * number));
  for (const Tick& tick : ticks_of(scale, most)) {
    const int at = left + static_cast<int>(std::lround(scale.share_of(tick.value) * (width - 1)));
    fill(page, at, top + height + 1, 1, std::max(2, font / 4), ink);
    draw_text(page, tick.label, at, top + height + font / 4 + font, number, TextAlign::centre, ink);
  }
}

// The largest size of the image's shape that fits, a whole multiple when it is enlarged in squares.
Raster fitted(const Panel& panel, int width, int height) {
  const Raster& image = panel.image;
  double factor = std::min(static_cast<double>(width) / image.width,
                           static_cast<double>(height) / image.height);
  if (factor >= 1.0 && !panel.smooth_image) factor = std::floor(factor);
  const auto scaled = [factor](int size) {
    return std::max(1, static_cast<int>(std::floor(factor * size + 1e-9)));
  };
  return panel.smooth_image || factor < 1.0
             ? resampled(image, scaled(image.width), scaled(image.height))
             : resized(image, scaled(image.width), scaled(image.height));
}

}  // namespace

std::string draw_png(const std::vector<SceneMesh>& meshes, const PictureOptions& options) {
  check(meshes);
  return to_png(render({{&meshes, options.view, options.width, options.height}}, options).front());
}

std::string draw_panels(const std::vector<Panel>& panels, const PictureOptions& options,
                        int columns) {
  if (panels.empty()) throw PictureError("there is no panel to draw");
  for (const Panel& panel : panels) {
    if (!panel.meshes.empty()) {
      check(panel.meshes);
    } else if (panel.image.rgb.empty()) {
      throw PictureError("a panel has neither meshes nor an image");
    }
  }
  const Layout layout = layout_of(panels, options, columns);
  std::vector<Drawing> drawings;
  for (const Panel& panel : panels) {
    if (panel.meshes.empty()) continue;
    drawings.push_back(
        {&panel.meshes, panel.view.value_or(options.view), layout.cell_width, layout.body_height});
  }
  const std::vector<Raster> rendered = render(drawings, options);
  Raster page = make_raster(options.width, options.height, options.background);
  const Color& paper = options.background;
  const double lightness = 0.3 * paper[0] + 0.6 * paper[1] + 0.1 * paper[2];
  const double shade = lightness > 0.5 ? 0.0 : 1.0;
  const Color ink{shade, shade, shade};
  std::size_t next = 0;
  for (int i = 0; i < static_cast<int>(panels.size()); ++i) {
    const Panel& panel = panels[static_cast<std::size_t>(i)];
    const int x = i % layout.columns * (layout.cell_width + layout.gap);
    const Row& row = layout.rows[static_cast<std::size_t>(i / layout.columns)];
    const int y = row.top, body = y + row.caption;
    const Raster part = panel.meshes.empty() ? fitted(panel, layout.cell_width, layout.body_height)
                                             : rendered[next++];
    paste(page, part, x + (layout.cell_width - part.width) / 2,
          body + (layout.body_height - part.height) / 2);
    draw_text(page, panel.caption, x + layout.cell_width / 2, y + 6 * layout.font / 5,
              fitting_size(panel.caption, layout.font, layout.cell_width, true), TextAlign::centre,
              ink, true);
    if (panel.scale) {
      draw_bar(page, *panel.scale, x, body + layout.body_height, layout, ink);
    }
  }
  return to_png(page);
}

}  // namespace shape3d::apps
