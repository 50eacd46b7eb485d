#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "common/error.hpp"
#include "common/raster.hpp"
#include "common/thumbnail.hpp"
#include "search.hpp"

namespace shape3d::apps {
namespace {

constexpr Color kGrey{0.62, 0.62, 0.62}, kWhite{1.0, 1.0, 1.0}, kBlack{0.0, 0.0, 0.0};

constexpr int kFrame = 6, kGap = 14, kLine = 18;
constexpr int kBox = kThumbnailSize + 2 * kFrame;
constexpr int kCellHeight = kBox + 3 * kLine + 4;

struct Cell {
  std::string png;
  Color frame;
  std::string first, second, third;  // lines below the picture
};

std::string stem(const std::string& path) {
  return printable(std::filesystem::path(path).stem().string());
}

// Cut so that it fits; the end of a path of classes says most.
std::string fitted(std::string text, int width) {
  if (text_width(text, kLine - 3) <= width) return text;
  while (text.size() > 4 && text_width("..." + text, kLine - 3) > width) text.erase(0, 1);
  return "..." + text;
}

void draw_cell(Raster& page, const Cell& cell, int x, int y) {
  fill(page, x, y, kBox, kBox, cell.frame);
  fill(page, x + kFrame, y + kFrame, kThumbnailSize, kThumbnailSize, kWhite);
  if (cell.png.empty()) {
    draw_text(page, "no picture", x + kBox / 2, y + kBox / 2, kLine, TextAlign::centre, kGrey);
  } else {
    paste(page, decode_png_raster(cell.png), x + kFrame, y + kFrame);
  }
  int base = y + kBox + kLine - 2;
  for (const std::string* text : {&cell.first, &cell.second, &cell.third}) {
    draw_text(page, fitted(*text, kBox), x + kBox / 2, base, kLine - 3, TextAlign::centre, kBlack,
              text == &cell.first);
    base += kLine;
  }
}

std::string distance_text(double distance) {
  char text[48];
  std::snprintf(text, sizeof text, "distance %.4g", distance);
  return text;
}

// Pictures that the library does not have are drawn now, of meshes that are still there.
void draw_missing(std::vector<Cell>& cells, const std::vector<std::string>& paths) {
  std::vector<std::string> open;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i].png.empty() || paths[i].empty()) continue;
    open.push_back(paths[i]);
    places.push_back(i);
  }
  if (open.empty()) return;
  const std::vector<std::string> drawn = ThumbnailPainter().draw(open);
  for (std::size_t i = 0; i < places.size(); ++i) cells[places[i]].png = drawn[i];
}

int columns_of(std::size_t cells) { return cells <= 12 ? 4 : cells <= 30 ? 6 : 10; }

}  // namespace

std::string draw_sheet(const ShapeLibrary& library, const Query& query,
                       const std::vector<Found>& found) {
  std::vector<Cell> cells;
  std::vector<std::string> paths;
  Cell first;
  first.frame = kQueryFrame;
  first.first = query.mesh ? stem(query.name) : stem(query.model->file.path);
  first.second = query.class_name ? printable(*query.class_name) : "class not known";
  first.third = "query";
  if (query.model) first.png = library.thumbnail(query.model->id);
  if (first.png.empty() && query.mesh) first.png = draw_thumbnail(*query.mesh);
  cells.push_back(first);
  paths.push_back(query.model ? query.model->file.path : "");
  for (const Found& entry : found) {
    Cell cell;
    const std::optional<std::string>& name = entry.model.class_name;
    cell.frame = frame_color(match_kind(query, entry.model));
    cell.first = stem(entry.model.file.path);
    cell.second = name ? printable(*name) : "class not known";
    cell.third = distance_text(entry.match.distance);
    cell.png = library.thumbnail(entry.model.id);
    cells.push_back(std::move(cell));
    paths.push_back(entry.model.file.path);
  }
  draw_missing(cells, paths);
  const int columns = std::min(columns_of(cells.size()), static_cast<int>(cells.size()));
  const int rows = (static_cast<int>(cells.size()) + columns - 1) / columns;
  Raster page =
      make_raster(columns * (kBox + kGap) + kGap, rows * (kCellHeight + kGap) + kGap, kWhite);
  for (int i = 0; i < static_cast<int>(cells.size()); ++i) {
    draw_cell(page, cells[static_cast<std::size_t>(i)], kGap + i % columns * (kBox + kGap),
              kGap + i / columns * (kCellHeight + kGap));
  }
  return to_png(page);
}

}  // namespace shape3d::apps
