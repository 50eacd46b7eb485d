#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <shape3d/zmc/extract.hpp>

#include "cell_drawing.hpp"
#include "face_configurations.hpp"
#include "sheets.hpp"

namespace shape3d::apps {
namespace {

constexpr int kWidth = 1600;

/// Draws the faces of a configuration in a plane; `place` maps the cell to the page.
template <class Place>
void draw_flat(Page& page, const FaceConfiguration& c, const std::vector<int>& vertices,
               const Place& place) {
  const auto lattice_point = [](int v) {
    const std::array<int, 3>& p = zmc::kCellVertices[static_cast<std::size_t>(v)];
    return Eigen::Vector3d(p[0], p[1], p[2]);
  };
  const auto drawn = [&](int v) {
    return std::find(vertices.begin(), vertices.end(), v) != vertices.end();
  };
  for (const std::array<int, 2>& e : zmc::kCellEdges) {
    if (drawn(e[0]) && drawn(e[1]))
      page.rod(place(lattice_point(e[0])), place(lattice_point(e[1])), 1.2, kFrame);
  }
  const auto at = [&](zmc::CellSurfaceVertex v) { return place(position_of(v, c.samples)); };
  for (const Edge& e : c.undecided) page.broken_rod(at(e.first), at(e.second), 1.6, kUndecided);
  for (const Edge& e : c.decided) page.rod(at(e.first), at(e.second), 2.6, kPatchEdge);
  for (const int v : vertices)
    page.ball(place(lattice_point(v)), 6.5, color_of(c.samples[static_cast<std::size_t>(v)]));
}

void label(Page& page, double x, double y, const std::string& name, const std::string& below) {
  page.text(x, y, 15, name, Page::Align::centre, true);
  page.text(x, y - 18, 13, below);
}

void heading(Page& page, double y, const std::string& line) {
  page.text(24, y, 17, line, Page::Align::left, true);
  page.rod({24, y - 8, -400}, {kWidth - 24, y - 8, -400}, 0.7, kFrame);
}

/// Two cells side by side along x: samples at i = 0, 1, 2, at (j, k) = (0,0), (1,0), (0,1), (1,1).
struct TwoCells {
  std::array<double, 12> samples{};
  [[nodiscard]] double at(int i, int j, int k) const {
    return samples[static_cast<std::size_t>(i + 3 * (j + 2 * k))];
  }
  /// Of the cell i = 0 or 1.
  [[nodiscard]] Samples cell(int i) const {
    Samples result{};
    for (std::size_t v = 0; v < 8; ++v) {
      const std::array<int, 3>& p = zmc::kCellVertices[v];
      result[v] = at(i + p[0], p[1], p[2]);
    }
    return result;
  }
  [[nodiscard]] zmc::Surface<double, std::int32_t> surface() const {
    zmc::Options options;
    options.threads = 1;  // a fork follows
    return zmc::extract(zmc::make_view(samples.data(), {3, 2, 2}), 0.0, options);
  }
};

/// All signs of the outer samples; of those for which `wanted` holds, the first with fewest
/// triangles and, among these, fewest zeros.
template <class Wanted>
TwoCells simplest(const std::array<double, 4>& middle, const Wanted& wanted) {
  std::optional<TwoCells> best;
  std::pair<std::int64_t, std::int64_t> least;
  for (int n = 0; n < 6561; ++n) {
    TwoCells cells;
    int rest = n;
    for (std::size_t s = 0; s < 12; ++s) {
      if (s % 3 == 1) {
        cells.samples[s] = middle[s / 3];
        continue;
      }
      cells.samples[s] = rest % 3 - 1;
      rest /= 3;
    }
    const zmc::Surface<double, std::int32_t> surface = cells.surface();
    if (!wanted(surface.counts)) continue;
    const std::pair<std::int64_t, std::int64_t> size{
        surface.triangle_count(), std::count(cells.samples.begin(), cells.samples.end(), 0.0)};
    if (best && size >= least) continue;
    best = cells;
    least = size;
  }
  if (!best) throw std::logic_error("no pair of cells with the wanted face");
  return *best;
}

void draw_two_cells(Page& page, const TwoCells& cells, double x, double y, double scale) {
  const ObliqueView view({1.0, 0.5, 0.5}, x, y, scale);
  for (const int i : {0, 1}) draw_cell(page, view, cells.cell(i), {double(i), 0, 0});
  const zmc::Surface<double, std::int32_t> surface = cells.surface();
  for (std::int64_t t = surface.first_zero_face; t < surface.triangle_count(); ++t) {
    std::array<Eigen::Vector3d, 3> corners;
    for (int c = 0; c < 3; ++c)
      corners[static_cast<std::size_t>(c)] = view(surface.V().row(surface.F()(t, c)).transpose());
    page.triangle(corners[0], corners[1], corners[2], kInserted, kInserted);
  }
}

std::string names_of(const TwoCells& cells) {
  return name_of(zmc::cell_patches(cells.cell(0))) + "  |  " +
         name_of(zmc::cell_patches(cells.cell(1)));
}

}  // namespace

std::string draw_face_sheet() {
  const std::vector<FaceConfiguration> single = single_faces(), pairs = faces_at_zero_edge(),
                                       cells = cells_at_zero_face();
  const TwoCells zero_face = simplest(
      {0, 0, 0, 0}, [](const zmc::Counts& c) { return c.zero_faces == 1 && c.patches == 0; });
  const TwoCells closing =
      simplest({0, 0, 1, -1}, [](const zmc::Counts& c) { return c.closing_triangles == 1; });
  const std::size_t total = single.size() + pairs.size() + cells.size() + 2;
  constexpr double kHead = 96, kSingle = 210, kPair = 290, kCell = 250, kHeading = 44;
  constexpr int kPairsInRow = 8, kCellsInRow = 7;
  const auto rows = [](std::size_t n, int in_row) {
    return (static_cast<int>(n) + in_row - 1) / in_row;
  };
  Page page(kWidth, static_cast<int>(kHead + 3 * kHeading + kSingle +
                                     rows(pairs.size(), kPairsInRow) * kPair +
                                     rows(cells.size() + 2, kCellsInRow) * kCell));
  double y = page.height() - 42;
  page.text(24, y, 24, "The " + std::to_string(total) + " configurations of cell faces",
            Page::Align::left, true);
  draw_legend(page, 34, y - 34);
  y = page.height() - kHead - 26;

  heading(page, y, std::to_string(single.size()) + " faces that bilinear interpolation decides");
  const double single_width = (kWidth - 20.0) / static_cast<double>(single.size());
  for (std::size_t n = 0; n < single.size(); ++n) {
    const double x = 10 + (static_cast<double>(n) + 0.5) * single_width;
    constexpr double kSide = 100;
    draw_flat(page, single[n], {0, 1, 2, 3}, [&](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(x + kSide * (p[0] - 0.5), y - 134 + kSide * p[1], 0);
    });
    label(page, x, y - 168, single[n].name, name_of(zmc::cell_patches(single[n].samples)));
  }
  y -= kSingle + kHeading;

  heading(page, y,
          std::to_string(pairs.size()) +
              " pairs of faces at a zero edge, unfolded; dotted where the rest of the "
              "cell decides");
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    constexpr double kSide = 92;
    const auto column = static_cast<int>(n) % kPairsInRow, row = static_cast<int>(n) / kPairsInRow;
    const double x = (column + 0.5) * kWidth / kPairsInRow;
    const double middle = y - row * kPair - 124;
    // Face −z below the zero edge, face −y above it.
    draw_flat(page, pairs[n], {0, 1, 2, 3, 4, 5}, [&](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(x + kSide * (p[0] - 0.5), middle + kSide * (p[2] - p[1]), 0);
    });
    label(page, x, middle - kSide - 32, pairs[n].name,
          name_of(zmc::cell_patches(pairs[n].samples)));
  }
  y -= rows(pairs.size(), kPairsInRow) * kPair + kHeading;

  heading(page, y,
          std::to_string(cells.size()) +
              " cells at a zero face (case 12, below), and 2 faces inserted between "
              "cells (green)");
  for (std::size_t n = 0; n < cells.size() + 2; ++n) {
    const auto column = static_cast<int>(n) % kCellsInRow, row = static_cast<int>(n) / kCellsInRow;
    const double x = (column + 0.5) * kWidth / kCellsInRow;
    const double top = y - row * kCell - 10;
    if (n < cells.size()) {
      draw_cell(page, ObliqueView({0.5, 0.5, 0.5}, x, top - 102, 108), cells[n].samples);
      label(page, x, top - 204, cells[n].name, name_of(zmc::cell_patches(cells[n].samples)));
      continue;
    }
    const TwoCells& two = n == cells.size() ? zero_face : closing;
    draw_two_cells(page, two, x, top - 102, 78);
    label(page, x, top - 204, n == cells.size() ? "zero face (case 12)" : "triangle (case 11)",
          names_of(two));
  }
  return page.png();
}

}  // namespace shape3d::apps
