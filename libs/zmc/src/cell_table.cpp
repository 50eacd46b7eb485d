#include "cell_table.hpp"

#include <algorithm>
#include <cmath>

namespace shape3d::zmc::detail {
namespace {

using Point = std::array<double, 3>;

/// Place of a slot in the unit cell, crossings at the middle of their edges.
Point slot_place(int slot) {
  const int v = kSlotVertex[slot];
  Point p{};
  for (int d = 0; d < 3; ++d) {
    p[d] = v >= 12
               ? kCellVertices[v - 12][d]
               : 0.5 * (kCellVertices[kCellEdges[v][0]][d] + kCellVertices[kCellEdges[v][1]][d]);
  }
  return p;
}

/// Bit f: the slot lies in the closed face f (−x, +x, −y, +y, −z, +z).
unsigned slot_faces(int slot) {
  const Point p = slot_place(slot);
  unsigned faces = 0;
  for (int d = 0; d < 3; ++d) {
    if (p[d] == 0.0) faces |= 1u << (2 * d);
    if (p[d] == 1.0) faces |= 2u << (2 * d);
  }
  return faces;
}

/// Shape quality of a triangle: 4√3·area / Σ squared sides; 1 when equilateral, 0 when degenerate.
double triangle_quality(int a, int b, int c) {
  const Point p = slot_place(a), q = slot_place(b), r = slot_place(c);
  Point u{}, v{}, w{};
  for (int d = 0; d < 3; ++d) {
    u[d] = q[d] - p[d];
    v[d] = r[d] - p[d];
    w[d] = r[d] - q[d];
  }
  const Point n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const auto square = [](const Point& x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2]; };
  const double sides = square(u) + square(v) + square(w);
  return sides > 0.0 ? 2.0 * std::sqrt(3.0 * square(n)) / sides : 0.0;
}

/// The geometry that triangulation asks for, tabulated.
struct SlotGeometry {
  std::array<unsigned, kSlots> faces{};
  std::array<std::array<std::array<double, kSlots>, kSlots>, kSlots> quality{};

  SlotGeometry() {
    for (int a = 0; a < kSlots; ++a) {
      faces[a] = slot_faces(a);
      for (int b = 0; b < kSlots; ++b) {
        for (int c = 0; c < kSlots; ++c) quality[a][b][c] = triangle_quality(a, b, c);
      }
    }
  }
};

const SlotGeometry& slot_geometry() {
  static const SlotGeometry geometry;
  return geometry;
}

/// Rotated so that the lowest slot leads.
std::array<int, 3> lowest_first(int a, int b, int c) {
  if (a < b && a < c) return {a, b, c};
  if (b < c) return {b, c, a};
  return {c, a, b};
}

/// Best triangulation of a polygon by diagonals that lie in no cell face: the worst triangle is as
/// good as possible. False when there is none. Polygons have 12 vertices at most.
bool triangulate_by_diagonals(const std::vector<int>& polygon,
                              std::vector<std::array<int, 3>>& out) {
  const int n = static_cast<int>(polygon.size());
  const SlotGeometry& geometry = slot_geometry();
  std::array<std::array<double, 12>, 12> worst;
  std::array<std::array<int, 12>, 12> apex{};
  for (auto& row : worst) row.fill(2.0);
  for (int span = 2; span < n; ++span) {
    for (int i = 0; i + span < n; ++i) {
      const int k = i + span;
      worst[i][k] = -1.0;
      const bool side = i == 0 && k == n - 1;
      if (!side && (geometry.faces[polygon[i]] & geometry.faces[polygon[k]]) != 0) continue;
      for (int j = i + 1; j < k; ++j) {
        const double w = std::min(
            {worst[i][j], worst[j][k], geometry.quality[polygon[i]][polygon[j]][polygon[k]]});
        if (w > worst[i][k] + 1e-9) {
          worst[i][k] = w;
          apex[i][k] = j;
        }
      }
    }
  }
  if (worst[0][n - 1] <= 0.0) return false;
  std::vector<std::array<int, 2>> open;
  open.push_back({0, n - 1});
  while (!open.empty()) {
    const auto [i, k] = open.back();
    open.pop_back();
    if (k - i < 2) continue;
    const int j = apex[i][k];
    out.push_back({polygon[i], polygon[j], polygon[k]});
    open.push_back({j, k});
    open.push_back({i, j});
  }
  return true;
}

CellSigns signs_of_case(int p) {
  CellSigns signs{};
  for (int v = 0; v < 8; ++v) {
    const int digit = p % 3;
    signs[v] = digit == 0 ? 0 : digit == 1 ? 1 : -1;
    p /= 3;
  }
  return signs;
}

CellConfig make_config(const CellGraph& graph, CellTable& table) {
  CellConfig config;
  config.zero_edges = static_cast<std::uint16_t>(graph.zero_edges);
  for (int f = 0; f < 6; ++f) {
    if (graph.zero_face_sign[f] > 0) config.face_positive |= static_cast<std::uint8_t>(1u << f);
    if (graph.zero_face_sign[f] < 0) config.face_negative |= static_cast<std::uint8_t>(1u << f);
  }
  const auto cycles = cycles_in_slots(graph);
  config.patches = static_cast<std::uint8_t>(cycles.size());
  for (const auto& cycle : cycles) {
    for (const int slot : cycle) {
      const int v = kSlotVertex[slot];
      if (v >= 12) config.zero_vertices |= static_cast<std::uint8_t>(1u << corner_bit(v - 12));
    }
  }
  for (const Triangulation how : {Triangulation::compact, Triangulation::centroid}) {
    std::vector<std::array<int, 3>> triangles;
    std::vector<std::uint32_t> centroids;
    for (const auto& cycle : cycles) triangulate(cycle, how, kSlots, triangles, centroids);
    Triangulated& t = config.by_triangulation[static_cast<int>(how)];
    t.first = static_cast<std::uint32_t>(table.slots.size());
    t.triangles = static_cast<std::uint8_t>(triangles.size());
    t.first_centroid = static_cast<std::uint16_t>(table.centroids.size());
    t.centroids = static_cast<std::uint8_t>(centroids.size());
    for (const auto& triangle : triangles) {
      for (const int slot : triangle) table.slots.push_back(static_cast<std::uint8_t>(slot));
    }
    table.centroids.insert(table.centroids.end(), centroids.begin(), centroids.end());
  }
  return config;
}

CellTable generate() {
  CellTable table;
  table.case_of_mask.assign(65536, CellTable::kNoCase);
  for (int p = 0; p < 6561; ++p) {
    const CellSigns signs = signs_of_case(p);
    unsigned mask = 0;
    for (int v = 0; v < 8; ++v) {
      if (signs[v] < 0) mask |= 1u << corner_bit(v);
      if (signs[v] == 0) mask |= 256u << corner_bit(v);
    }
    table.case_of_mask[mask] = static_cast<std::uint16_t>(p);

    CellCase entry;
    std::vector<Comparison> comparisons;
    std::vector<bool> answers;
    CellGraph graph = apply_rules(signs, comparisons, answers);
    for (int f = 0; f < 6; ++f) entry.face_case[f] = static_cast<std::uint8_t>(graph.face_case[f]);
    entry.first_config = static_cast<std::uint16_t>(table.configs.size());
    entry.first_comparison = static_cast<std::uint16_t>(table.comparisons.size());
    entry.comparisons = static_cast<std::uint8_t>(comparisons.size());
    answers.resize(comparisons.size());
    for (unsigned r = 0; r < 1u << comparisons.size(); ++r) {
      for (std::size_t c = 0; c < answers.size(); ++c) answers[c] = ((r >> c) & 1u) != 0;
      table.configs.push_back(
          make_config(r == 0 ? graph : apply_rules(signs, comparisons, answers), table));
    }
    table.comparisons.insert(table.comparisons.end(), comparisons.begin(), comparisons.end());
    const CellConfig& only = table.configs[entry.first_config];
    table.face_signs.push_back(
        entry.comparisons != 0
            ? CellTable::kAmbiguousFaces
            : static_cast<std::uint16_t>(only.face_positive | only.face_negative << 6));
    table.cases.push_back(entry);
  }
  return table;
}

}  // namespace

std::vector<std::vector<int>> cycles_in_slots(const CellGraph& graph) {
  std::vector<std::vector<int>> cycles;
  for (const auto& cycle : find_cycles(graph)) {
    auto& slots = cycles.emplace_back();
    for (const CellSurfaceVertex v : cycle) slots.push_back(kVertexSlot[v]);
    std::rotate(slots.begin(), std::min_element(slots.begin(), slots.end()), slots.end());
  }
  std::sort(cycles.begin(), cycles.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
  return cycles;
}

void triangulate(const std::vector<int>& polygon_slots, Triangulation triangulation,
                 int centroid_base, std::vector<std::array<int, 3>>& triangles,
                 std::vector<std::uint32_t>& centroids) {
  // Canonical traversal: from the lowest slot towards its lower neighbour.
  std::vector<int> polygon = polygon_slots;
  const int n = static_cast<int>(polygon.size());
  std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
  const bool reversed = polygon[1] > polygon[n - 1];
  if (reversed) std::reverse(polygon.begin() + 1, polygon.end());

  std::vector<std::array<int, 3>> found;
  const bool by_diagonals = n == 3 || triangulation == Triangulation::compact
                                ? triangulate_by_diagonals(polygon, found)
                                : false;
  if (!by_diagonals) {
    std::uint32_t members = 0;
    for (const int slot : polygon) members |= std::uint32_t{1} << slot;
    const int centroid = centroid_base + static_cast<int>(centroids.size());
    centroids.push_back(members);
    for (int k = 0; k < n; ++k) found.push_back({polygon[k], polygon[(k + 1) % n], centroid});
  }
  for (const auto& t : found) {
    triangles.push_back(reversed ? lowest_first(t[0], t[2], t[1]) : lowest_first(t[0], t[1], t[2]));
  }
}

const CellTable& cell_table() {
  static const CellTable table = generate();
  return table;
}

}  // namespace shape3d::zmc::detail
