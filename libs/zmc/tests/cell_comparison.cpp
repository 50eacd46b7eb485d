#include "cell_comparison.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <tuple>
#include <utility>

namespace shape3d::zmc::test {
namespace {

int corner_of(int cell_vertex) {
  const auto& at = kCellVertices[cell_vertex];
  return at[0] + 2 * at[1] + 4 * at[2];
}

template <class Row>
std::string text(const Row& row) {
  std::ostringstream out;
  for (const auto& value : row) out << value << ' ';
  return out.str();
}

using Edge = std::tuple<int, int, int>;

std::vector<std::vector<int>> canonical(std::vector<std::vector<int>> polygons) {
  for (auto& p : polygons) std::rotate(p.begin(), std::min_element(p.begin(), p.end()), p.end());
  std::sort(polygons.begin(), polygons.end());
  return polygons;
}

/// Do both surface vertices lie in one face of the cell?
bool in_one_face(CellSurfaceVertex a, CellSurfaceVertex b) {
  const reference::LocalVertex p = local_vertex(a), q = local_vertex(b);
  const std::array<int, 4> corners{reference::first_corner(p), reference::second_corner(p),
                                   reference::first_corner(q), reference::second_corner(q)};
  int all = 7, any = 0;
  for (const int c : corners) {
    all &= c;
    any |= c;
  }
  return all != 0 || any != 7;
}

/// Can the polygon be cut by diagonals none of which lies in a cell face?
bool has_inner_triangulation(const std::vector<CellSurfaceVertex>& polygon) {
  const int n = static_cast<int>(polygon.size());
  // possible[a][b]: the part between a and b, cut off by the diagonal or side a b.
  std::vector<std::vector<char>> possible(n, std::vector<char>(n, 0));
  for (int a = 0; a + 1 < n; ++a) possible[a][a + 1] = 1;
  for (int length = 2; length < n; ++length) {
    for (int a = 0; a + length < n; ++a) {
      const int b = a + length;
      const bool side = a == 0 && b == n - 1;
      if (!side && in_one_face(polygon[a], polygon[b])) continue;
      for (int c = a + 1; c < b; ++c) {
        if (possible[a][c] != 0 && possible[c][b] != 0) possible[a][b] = 1;
      }
    }
  }
  return possible[0][n - 1] != 0;
}

}  // namespace

std::string to_string(const Samples& samples) { return "samples " + text(samples); }

reference::LocalVertex local_vertex(CellSurfaceVertex v) {
  if (v >= 12) return reference::zero_vertex(corner_of(v - 12));
  return reference::crossing(corner_of(kCellEdges[v][0]), corner_of(kCellEdges[v][1]));
}

std::vector<std::vector<int>> canonical_patches(
    const std::vector<std::vector<CellSurfaceVertex>>& patches) {
  std::vector<std::vector<int>> result;
  for (const auto& patch : patches) {
    std::vector<int>& cycle = result.emplace_back();
    for (const CellSurfaceVertex v : patch) cycle.push_back(local_vertex(v));
  }
  return canonical(std::move(result));
}

std::vector<std::vector<int>> canonical_cycles(std::vector<std::vector<int>> cycles) {
  return canonical(std::move(cycles));
}

reference::CellSolution reference_solution(const Samples& samples, TieRule ties) {
  std::array<double, 8> by_corner{};
  for (int v = 0; v < 8; ++v) by_corner[corner_of(v)] = samples[v];
  return reference::solve_cell(
      by_corner, ties == TieRule::neutral ? reference::Ties::neutral : reference::Ties::positive);
}

std::string difference(const CellPatches& cell, const Samples& samples, TieRule ties) {
  const reference::CellSolution expected = reference_solution(samples, ties);
  const auto report = [&](const char* what, const auto& want, const auto& got) {
    return to_string(samples) + (ties == TieRule::neutral ? "neutral: " : "positive: ") + what +
           " expected " + text(want) + "got " + text(got);
  };
  int p = 0, power = 1;
  for (int v = 0; v < 8; ++v, power *= 3) {
    p += power * (samples[v] > 0 ? 1 : (samples[v] < 0 ? 2 : 0));
  }
  if (cell.case_index != p) {
    return report("case index", std::array{p}, std::array{cell.case_index});
  }
  if (cell.face_case != expected.face_case) {
    return report("face cases", expected.face_case, cell.face_case);
  }
  if (cell.zero_face_sign != expected.region_sign) {
    return report("zero-face signs", expected.region_sign, cell.zero_face_sign);
  }
  std::vector<Edge> want, got;
  for (const auto& e : expected.edges) want.emplace_back(e.from, e.to, e.face);
  for (const auto& e : cell.patch_edges) {
    got.emplace_back(local_vertex(e.from), local_vertex(e.to), e.face);
  }
  std::sort(want.begin(), want.end());
  std::sort(got.begin(), got.end());
  if (want != got) {
    const auto flat = [](const std::vector<Edge>& edges) {
      std::vector<int> result;
      for (const auto& [from, to, face] : edges) {
        result.insert(result.end(), {from, to, face});
      }
      return result;
    };
    return report("patch edges", flat(want), flat(got));
  }
  const auto want_patches = canonical_cycles(reference::cycles(expected.edges));
  const auto got_patches = canonical_patches(cell.patches);
  if (want_patches != got_patches) {
    const auto flat = [](const std::vector<std::vector<int>>& polygons) {
      std::vector<std::string> result;
      for (const auto& polygon : polygons) result.push_back("(" + text(polygon) + ")");
      return result;
    };
    return report("patches", flat(want_patches), flat(got_patches));
  }
  return {};
}

std::string triangulation_fault(const CellPatches& cell, Triangulation triangulation) {
  constexpr int kFirstCentroid = 20;
  // The polygons are disjoint: each vertex tells its polygon.
  std::map<int, int> polygon_of;
  for (std::size_t n = 0; n < cell.patches.size(); ++n) {
    for (const int v : cell.patches[n]) {
      if (!polygon_of.emplace(v, static_cast<int>(n)).second) return "two polygons share a vertex";
    }
  }
  std::map<int, int> centroid_of;  // polygon to centroid
  for (std::size_t n = 0; n < cell.centroids.size(); ++n) {
    std::vector<int> averaged = cell.centroids[n];
    if (averaged.empty()) return "a centroid of nothing";
    const auto owner = polygon_of.find(averaged[0]);
    if (owner == polygon_of.end()) return "a centroid of a vertex in no polygon";
    std::vector<int> polygon = cell.patches[owner->second];
    std::sort(averaged.begin(), averaged.end());
    std::sort(polygon.begin(), polygon.end());
    if (averaged != polygon) return "a centroid is not that of its polygon";
    if (!centroid_of.emplace(owner->second, kFirstCentroid + static_cast<int>(n)).second) {
      return "two centroids in one polygon";
    }
    polygon_of.emplace(kFirstCentroid + static_cast<int>(n), owner->second);
  }
  std::vector<int> triangles(cell.patches.size(), 0);
  std::vector<std::map<std::pair<int, int>, int>> chain(cell.patches.size());
  for (const auto& t : cell.triangles) {
    for (const int v : t) {
      if (polygon_of.count(v) == 0) return "a triangle with a vertex in no polygon";
    }
    const int n = polygon_of[t[0]];
    if (polygon_of[t[1]] != n || polygon_of[t[2]] != n) return "a triangle between two polygons";
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return "a triangle repeats a vertex";
    if (centroid_of.count(n) != 0 && std::count(t.begin(), t.end(), centroid_of[n]) != 1) {
      return "a triangle of a fan without its centroid";
    }
    ++triangles[n];
    for (int k = 0; k < 3; ++k) ++chain[n][{t[k], t[(k + 1) % 3]}];
  }
  for (std::size_t n = 0; n < cell.patches.size(); ++n) {
    const auto& polygon = cell.patches[n];
    const int size = static_cast<int>(polygon.size());
    const bool fan = centroid_of.count(static_cast<int>(n)) != 0;
    if (triangles[n] != (fan ? size : size - 2)) return "a polygon has a wrong number of triangles";
    // Each side once in its direction; every other edge once each way, and not in a cell face.
    for (int k = 0; k < size; ++k) {
      if (--chain[n][{polygon[k], polygon[(k + 1) % size]}] != 0)
        return "a side is not covered once";
    }
    for (const auto& [edge, count] : chain[n]) {
      if (count == 0) continue;
      const auto back = chain[n].find({edge.second, edge.first});
      if (count != 1 || back == chain[n].end() || back->second != 1) return "an open inner edge";
      const bool spoke = edge.first >= kFirstCentroid || edge.second >= kFirstCentroid;
      if (!spoke && in_one_face(edge.first, edge.second)) return "a diagonal in a cell face";
    }
    if (triangulation == Triangulation::centroid) {
      if (fan != (size > 3)) return "centroid: a wrong kind of fan";
    } else if (fan && has_inner_triangulation(polygon)) {
      return "compact: a centroid where diagonals are possible";
    }
  }
  return {};
}

}  // namespace shape3d::zmc::test
