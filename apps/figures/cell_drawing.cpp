#include "cell_drawing.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace shape3d::apps {
namespace {

Eigen::Vector3d corner_of(int vertex) {
  const std::array<int, 3>& c = zmc::kCellVertices[static_cast<std::size_t>(vertex)];
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

}  // namespace

Color color_of(double sample) {
  if (sample == 0.0) return kZero;
  return sample > 0.0 ? kPositive : kNegative;
}

Eigen::Vector3d position_of(zmc::CellSurfaceVertex vertex, const Samples& samples) {
  if (vertex >= 12) return corner_of(vertex - 12);
  const std::array<int, 2>& ends = zmc::kCellEdges[static_cast<std::size_t>(vertex)];
  const double a = std::abs(samples[static_cast<std::size_t>(ends[0])]);
  const double b = std::abs(samples[static_cast<std::size_t>(ends[1])]);
  return corner_of(ends[0]) + a / (a + b) * (corner_of(ends[1]) - corner_of(ends[0]));
}

std::set<Edge> patch_edges_of(const zmc::CellPatches& cell) {
  std::set<Edge> edges;
  for (const zmc::PatchEdge& e : cell.patch_edges) {
    edges.insert({std::min(e.from, e.to), std::max(e.from, e.to)});
  }
  return edges;
}

std::string name_of(const zmc::CellPatches& cell) {
  return "P = " + std::to_string(cell.case_index) + ", R = " + std::to_string(cell.resolution);
}

ObliqueView::ObliqueView(const Eigen::Vector3d& middle, double x, double y, double scale)
    : middle_(middle), place_(x, y, 0.0), scale_(scale) {}

Eigen::Vector3d ObliqueView::operator()(const Eigen::Vector3d& p) const {
  static const Eigen::Vector3d kFrom = Eigen::Vector3d(0.42, -1.0, 0.46).normalized();
  static const Eigen::Vector3d kRight = Eigen::Vector3d::UnitZ().cross(kFrom).normalized();
  static const Eigen::Vector3d kAbove = kFrom.cross(kRight);
  const Eigen::Vector3d q = p - middle_;
  return place_ + scale_ * Eigen::Vector3d(q.dot(kRight), q.dot(kAbove), q.dot(kFrom));
}

void draw_cell(Page& page, const ObliqueView& view, const Samples& samples,
               const Eigen::Vector3d& corner) {
  const auto at = [&](const Eigen::Vector3d& p) { return view(corner + p); };
  const double unit = view.scale();
  for (const std::array<int, 2>& e : zmc::kCellEdges) {
    page.rod(at(corner_of(e[0])), at(corner_of(e[1])), 0.010 * unit, kFrame);
  }
  for (int v = 0; v < 8; ++v) {
    page.ball(at(corner_of(v)), 0.062 * unit, color_of(samples[static_cast<std::size_t>(v)]));
  }
  const zmc::CellPatches cell = zmc::cell_patches(samples);
  const auto place = [&](int id) {
    if (id < 20) return at(position_of(id, samples));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const std::vector<zmc::CellSurfaceVertex>& of =
        cell.centroids[static_cast<std::size_t>(id - 20)];
    for (const zmc::CellSurfaceVertex v : of) sum += position_of(v, samples);
    return at(sum / static_cast<double>(of.size()));
  };
  for (const std::array<int, 3>& t : cell.triangles) {
    page.triangle(place(t[0]), place(t[1]), place(t[2]), kPositiveSide, kNegativeSide, 0.86);
  }
  for (const Edge& e : patch_edges_of(cell)) {
    page.rod(place(e.first), place(e.second), 0.022 * unit, kPatchEdge);
  }
}

void draw_legend(Page& page, double x, double y) {
  const auto sample = [&](const Color& color, const std::string& name, double width) {
    page.ball({x, y + 5, 0}, 6, color);
    page.text(x + 14, y, 15, name, Page::Align::left);
    x += width;
  };
  const auto patch = [&](const Color& color, const std::string& name, double width) {
    const Eigen::Vector3d a(x - 8, y - 3, 0), b(x + 8, y - 3, 0), c(x + 8, y + 13, 0),
        d(x - 8, y + 13, 0);
    page.triangle(a, b, c, color, color);
    page.triangle(a, c, d, color, color);
    page.text(x + 14, y, 15, name, Page::Align::left);
    x += width;
  };
  sample(kPositive, "positive sample", 150);
  sample(kZero, "zero", 72);
  sample(kNegative, "negative", 104);
  patch(kPositiveSide, "patch seen from its positive side", 262);
  patch(kNegativeSide, "from its negative side", 0);
}

}  // namespace shape3d::apps
