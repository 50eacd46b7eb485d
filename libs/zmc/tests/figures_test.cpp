// Cells that the dissertation shows or counts: figures 1.1, 2.14 and 2.15, the cases of Marching
// Cubes.

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include <catch2/catch.hpp>

#include "cell_comparison.hpp"
#include "shape3d/zmc/cell.hpp"

namespace {
using namespace shape3d::zmc;
using namespace shape3d::zmc::test;

/// +value at the listed cell vertices, `rest` elsewhere.
Samples at_vertices(const std::vector<int>& vertices, double value, double rest) {
  Samples samples{};
  samples.fill(rest);
  for (const int v : vertices) samples[v] = value;
  return samples;
}

Samples negated(Samples samples) {
  for (double& s : samples) s = -s;
  return samples;
}

std::map<int, int> count_cases(const CellPatches& cell) {
  std::map<int, int> result;
  for (const int c : cell.face_case) ++result[c];
  return result;
}

TEST_CASE("Fig. 1.1: zeros among one sign make no patch", "[zmc][figures]") {
  struct Figure {
    const char* name;
    std::vector<int> zeros;
    std::map<int, int> cases;  // face case: number of faces
  };
  // Section 2.3.2 names the face cases of each: (a) 7 and 4; (b) 7, 8 beside 4, 8 beside 8;
  // (c) 8 beside 8; (d) 12 with a face of case 1 opposite.
  for (const Figure& figure : {Figure{"a", {0, 1, 6}, {{2, 3}, {4, 2}, {7, 1}}},
                               Figure{"b", {0, 1, 2, 4, 6}, {{4, 2}, {7, 1}, {8, 3}}},
                               Figure{"c", {0, 1, 2, 5}, {{2, 3}, {8, 3}}},
                               Figure{"d", {0, 1, 2, 3}, {{1, 1}, {4, 4}, {12, 1}}}}) {
    INFO("Fig. 1.1(" << figure.name << ")");
    for (const double rest : {1.0, -1.0}) {
      for (const TieRule ties : {TieRule::neutral, TieRule::positive}) {
        const CellPatches cell = cell_patches(at_vertices(figure.zeros, 0.0, rest), ties);
        CHECK(count_cases(cell) == figure.cases);
        CHECK(cell.patch_edges.empty());
        CHECK(cell.patches.empty());
        CHECK(cell.triangles.empty());
      }
    }
  }
}

TEST_CASE("a cell without both signs has no patch", "[zmc][figures]") {
  for (int zeros = 0; zeros < 256; ++zeros) {
    for (const double rest : {2.0, -2.0}) {
      Samples samples{};
      for (int v = 0; v < 8; ++v) samples[v] = (zeros >> v & 1) != 0 ? 0.0 : rest;
      const CellPatches cell = cell_patches(samples);
      if (!cell.patch_edges.empty()) FAIL_CHECK(to_string(samples));
      // Its zero faces are on the side of the only sign.
      for (int f = 0; f < 6; ++f) {
        const int expected = cell.face_case[f] == 12 && zeros != 255 ? (rest > 0 ? 1 : -1) : 0;
        if (cell.zero_face_sign[f] != expected) FAIL_CHECK(to_string(samples) << "face " << f);
      }
    }
  }
  SUCCEED();
}

/// Does surface vertex v lie on face f?
bool lies_on(CellSurfaceVertex v, int f) {
  const auto on = [&](int vertex) { return kCellVertices[vertex][f / 2] == f % 2; };
  return v >= 12 ? on(v - 12) : on(kCellEdges[v][0]) && on(kCellEdges[v][1]);
}

TEST_CASE("Fig. 2.14: a face of case 10 has the one patch edge of way 2", "[zmc][figures]") {
  std::int64_t faces = 0;
  for (int p = 0; p < 6561; ++p) {
    Samples samples{};
    int rest = p;
    for (double& s : samples) {
      constexpr std::array<double, 3> kSigns{0, 1, -1};
      s = kSigns[rest % 3];
      rest /= 3;
    }
    const CellPatches cell = cell_patches(samples);
    for (int f = 0; f < 6; ++f) {
      if (cell.face_case[f] != 10) continue;
      ++faces;
      // The corner opposite to the zero is cut off; nothing reaches the zero vertex in this face.
      int zero = 0;
      while (samples[kCellFaces[f][zero]] != 0.0) ++zero;
      const int odd = kCellFaces[f][(zero + 2) % 4];
      int edges = 0;
      for (const PatchEdge& e : cell.patch_edges) {
        if (!lies_on(e.from, f) || !lies_on(e.to, f)) continue;
        ++edges;
        for (const int v : {e.from, e.to}) {
          const bool at_odd = v < 12 && (kCellEdges[v][0] == odd || kCellEdges[v][1] == odd);
          if (!at_odd) FAIL_CHECK(to_string(samples) << "face " << f);
        }
      }
      if (edges != 1) FAIL_CHECK(to_string(samples) << "face " << f << ": " << edges << " edges");
    }
  }
  // 4 places of the zero and 2 signs; the other four vertices are free: 6 * 8 * 3^4.
  CHECK(faces == 6 * 8 * 81);
}

TEST_CASE("Fig. 2.15: how 6561 cases become 256 when zeros change", "[zmc][figures]") {
  std::map<int, std::vector<int>> to_positive, to_negative;  // Q to the cases with zeros
  std::set<int> indices;
  for (int n = 0; n < 6561; ++n) {
    Samples samples{};
    int rest = n, q_positive = 0, q_negative = 0;
    bool zeros = false;
    for (int v = 0; v < 8; ++v) {
      constexpr std::array<double, 3> kSigns{0, 1, -1};
      samples[v] = kSigns[rest % 3];
      rest /= 3;
      zeros = zeros || samples[v] == 0.0;
      q_positive += samples[v] >= 0.0 ? 1 << v : 0;
      q_negative += samples[v] > 0.0 ? 1 << v : 0;
    }
    const int p = cell_patches(samples).case_index;
    indices.insert(p);
    CHECK(p == n);
    if (!zeros) continue;
    to_positive[q_positive].push_back(p);
    to_negative[q_negative].push_back(p);
  }
  CHECK(indices.size() == 6561);
  CHECK(to_positive[227].size() == 31);
  CHECK(to_negative[227].size() == 7);
  CHECK(std::count(to_positive[227].begin(), to_positive[227].end(), 2422) == 1);  // Fig. 2.15(d)
  for (int q = 0; q < 256; ++q) {
    int positives = 0;
    for (int v = 0; v < 8; ++v) positives += q >> v & 1;
    CHECK(to_positive[q].size() == (1U << positives) - 1);
    CHECK(to_negative[q].size() == (1U << (8 - positives)) - 1);
  }
}

TEST_CASE("Fig. 2.15: the faces and resolutions of P = 2422", "[zmc][figures]") {
  // Positive 0 and 7, negative 2, 3, 4, zero 1, 5, 6.
  std::set<std::vector<std::vector<int>>> resolved;
  for (int n = 0; n < 243; ++n) {
    int rest = n;
    const auto draw = [&] {
      const int magnitude = 1 + rest % 3;
      rest /= 3;
      return static_cast<double>(magnitude);
    };
    const Samples samples{draw(), 0, -draw(), -draw(), -draw(), 0, 0, draw()};
    const CellPatches cell = cell_patches(samples);
    REQUIRE(cell.case_index == 2422);
    const std::map<int, int> cases = count_cases(cell);
    CHECK(cases.at(13) == 1);
    CHECK(cases.at(11) == 2);
    resolved.insert(canonical_patches(cell.patches));
  }
  CHECK(resolved.size() == 2);
}

TEST_CASE("Fig. 2.8: the 15 cases of Marching Cubes have its patches", "[zmc][figures]") {
  // The marked vertices and, from topology, the sides of the polygons that separate each connected
  // group of them: as many as lattice edges leave the group.
  struct Classical {
    int number;
    std::vector<int> marked;
    std::vector<std::size_t> sides;  // sorted
  };
  const std::vector<Classical> classical{
      {0, {}, {}},
      {1, {0}, {3}},
      {2, {0, 1}, {4}},
      {3, {0, 5}, {3, 3}},               // on a face diagonal
      {4, {0, 6}, {3, 3}},               // on a diagonal of the cell
      {5, {1, 2, 3}, {5}},               // three of a face
      {6, {0, 1, 6}, {3, 4}},            // an edge, and a vertex diagonal to it
      {7, {1, 4, 6}, {3, 3, 3}},         // three, each on a face diagonal to the others
      {8, {0, 1, 2, 3}, {4}},            // a face
      {9, {0, 1, 3, 4}, {6}},            // a vertex and its neighbours
      {10, {0, 1, 6, 7}, {4, 4}},        // opposite edges
      {11, {0, 1, 2, 6}, {6}},           // a path, right-handed
      {12, {1, 2, 3, 4}, {3, 5}},        // three of a face, and the vertex beside none of them
      {13, {0, 2, 5, 7}, {3, 3, 3, 3}},  // every second vertex
      {14, {1, 0, 3, 7}, {6}}};          // a path, left-handed
  constexpr std::array<int, 15> kTriangles{0, 1, 2, 2, 2, 3, 3, 3, 2, 4, 4, 4, 4, 4, 4};
  for (const Classical& c : classical) {
    INFO("case " << c.number);
    // Marked vertices are the weaker, so that ambiguous faces separate them as in Marching Cubes.
    for (const bool negative : {false, true}) {
      Samples samples = at_vertices(c.marked, 1.0, -2.0);
      if (negative) samples = negated(samples);
      const CellPatches cell = cell_patches(samples);
      std::vector<std::size_t> sides;
      for (const auto& patch : cell.patches) sides.push_back(patch.size());
      std::sort(sides.begin(), sides.end());
      CHECK(sides == c.sides);
      CHECK(cell.triangles.size() == static_cast<std::size_t>(kTriangles[c.number]));
      // Which marked vertices a patch cuts off: the marked ends of its cell edges. They must be
      // one connected group, and each group must have its patch.
      std::set<std::set<int>> groups;
      for (const auto& patch : cell.patches) {
        std::set<int> group;
        for (const int v : patch) {
          REQUIRE(v < 12);
          for (const int end : kCellEdges[v]) {
            if (std::count(c.marked.begin(), c.marked.end(), end) != 0) group.insert(end);
          }
        }
        groups.insert(group);
      }
      std::set<std::set<int>> expected;
      for (const int start : c.marked) {
        std::set<int> group{start};
        for (int pass = 0; pass < 8; ++pass) {
          for (const auto& edge : kCellEdges) {
            for (const auto& [from, to] : {std::pair{edge[0], edge[1]}, {edge[1], edge[0]}}) {
              if (group.count(from) != 0 && std::count(c.marked.begin(), c.marked.end(), to) != 0) {
                group.insert(to);
              }
            }
          }
        }
        // A vertex all of whose neighbours are marked is cut off with them, on no cut edge.
        std::set<int> cut;
        for (const int v : group) {
          for (const auto& edge : kCellEdges) {
            for (const auto& [from, to] : {std::pair{edge[0], edge[1]}, {edge[1], edge[0]}}) {
              if (from == v && group.count(to) == 0) cut.insert(v);
            }
          }
        }
        expected.insert(cut);
      }
      CHECK(groups == expected);
    }
  }
}
}  // namespace
