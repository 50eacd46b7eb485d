#include "shape3d/zmc/cell.hpp"
#include <array>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "cell_comparison.hpp"

namespace {
using namespace shape3d::zmc;
using namespace shape3d::zmc::test;

/// Signs of case P with magnitudes 1 ... limit.
Samples samples_of(int p, int limit, std::mt19937_64& random) {
  Samples samples{};
  for (double& s : samples) {
    const int trit = p % 3;
    p /= 3;
    const auto magnitude = static_cast<double>(1 + random() % static_cast<std::uint64_t>(limit));
    s = trit == 0 ? 0.0 : (trit == 1 ? magnitude : -magnitude);
  }
  return samples;
}

Samples negated(Samples samples) {
  for (double& s : samples) s = -s;
  return samples;
}

TEST_CASE("numbering of a cell: vertices, edges and faces fit together", "[zmc][contract]") {
  for (const auto& edge : kCellEdges) {
    int distance = 0;
    for (int axis = 0; axis < 3; ++axis) {
      distance += std::abs(kCellVertices[edge[0]][axis] - kCellVertices[edge[1]][axis]);
    }
    CHECK(distance == 1);
  }
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, side = face % 2;
    std::array<int, 4> corners{};
    for (int k = 0; k < 4; ++k) {
      const auto& at = kCellVertices[kCellFaces[face][k]];
      CHECK(at[axis] == side);
      corners[k] = at[0] + 2 * at[1] + 4 * at[2];
    }
    // Counter-clockwise seen from outside, as the reference derives it.
    std::array<int, 4> expected = reference::corners_of(face);
    std::rotate(expected.begin(), std::find(expected.begin(), expected.end(), corners[0]),
                expected.end());
    CHECK(corners == expected);
  }
}

TEST_CASE("cell_patches equals the rules for every case and random magnitudes",
          "[zmc][reference]") {
  const TieRule ties = GENERATE(TieRule::neutral, TieRule::positive);
  const int limit = GENERATE(1, 2, 4, 1000);
  std::mt19937_64 random(static_cast<std::uint64_t>(limit));
  for (int p = 0; p < 6561; ++p) {
    for (int draw = 0; draw < (limit == 1 ? 1 : 4); ++draw) {
      const Samples samples = samples_of(p, limit, random);
      for (const auto triangulation : {Triangulation::compact, Triangulation::centroid}) {
        const CellPatches cell = cell_patches(samples, ties, triangulation);
        const std::string found = difference(cell, samples, ties);
        if (!found.empty()) FAIL_CHECK(found);
        const std::string fault = triangulation_fault(cell, triangulation);
        if (!fault.empty()) FAIL_CHECK(to_string(samples) << fault);
      }
    }
  }
  SUCCEED();
}

TEST_CASE("a negated cell has the same patches reversed", "[zmc][property]") {
  std::mt19937_64 random(5);
  std::int64_t changed = 0, changed_by_positive = 0;
  for (int p = 0; p < 6561; ++p) {
    for (const int limit : {1, 2, 2, 3}) {
      const Samples samples = samples_of(p, limit, random);
      for (const TieRule ties : {TieRule::neutral, TieRule::positive}) {
        auto reversed = cell_patches(samples, ties).patches;
        for (auto& patch : reversed) std::reverse(patch.begin(), patch.end());
        const bool same = canonical_patches(reversed) ==
                          canonical_patches(cell_patches(negated(samples), ties).patches);
        if (!same) ++(ties == TieRule::neutral ? changed : changed_by_positive);
      }
    }
  }
  CHECK(changed == 0);
  CHECK(changed_by_positive > 0);  // The dissertation's tie rule is not neutral.
}

TEST_CASE("the triangles of a negated cell are those of the cell turned over", "[zmc][property]") {
  const auto triangulation = GENERATE(Triangulation::compact, Triangulation::centroid);
  std::mt19937_64 random(6);
  for (int p = 0; p < 6561; ++p) {
    const Samples samples = samples_of(p, 3, random);
    const CellPatches cell = cell_patches(samples, TieRule::neutral, triangulation);
    const CellPatches other = cell_patches(negated(samples), TieRule::neutral, triangulation);
    bool same = cell.triangles.size() == other.triangles.size();
    for (std::size_t n = 0; same && n < cell.triangles.size(); ++n) {
      const auto& t = cell.triangles[n];
      same = other.triangles[n] == std::array<int, 3>{t[0], t[2], t[1]};
    }
    if (!same) FAIL_CHECK(to_string(samples));
  }
  SUCCEED();
}

/// The 48 symmetries of the cube as permutations of its vertices; `mirrored` when orientation
/// turns.
struct Symmetry {
  std::array<int, 8> vertex;
  bool mirrored;
};
std::vector<Symmetry> symmetries() {
  std::vector<Symmetry> result;
  std::array<int, 3> axes{0, 1, 2};
  do {
    int inversions = 0;
    for (int a = 0; a < 3; ++a) {
      for (int b = a + 1; b < 3; ++b) inversions += axes[a] > axes[b];
    }
    for (int flips = 0; flips < 8; ++flips) {
      Symmetry s{};
      for (int v = 0; v < 8; ++v) {
        std::array<int, 3> image{};
        for (int axis = 0; axis < 3; ++axis) {
          image[axis] = kCellVertices[v][axes[axis]] ^ (flips >> axis & 1);
        }
        s.vertex[v] = static_cast<int>(
            std::find(kCellVertices.begin(), kCellVertices.end(), image) - kCellVertices.begin());
      }
      const int bits = (flips & 1) + (flips >> 1 & 1) + (flips >> 2 & 1);
      s.mirrored = (inversions + bits) % 2 == 1;
      result.push_back(s);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return result;
}

CellSurfaceVertex image(CellSurfaceVertex v, const Symmetry& s) {
  if (v >= 12) return 12 + s.vertex[v - 12];
  const int a = s.vertex[kCellEdges[v][0]], b = s.vertex[kCellEdges[v][1]];
  for (int e = 0; e < 12; ++e) {
    if ((kCellEdges[e][0] == a && kCellEdges[e][1] == b) ||
        (kCellEdges[e][0] == b && kCellEdges[e][1] == a)) {
      return e;
    }
  }
  throw std::logic_error("the image of an edge is no edge");
}

TEST_CASE("without ties the patches turn with the cell", "[zmc][property]") {
  const std::vector<Symmetry> all = symmetries();
  REQUIRE(all.size() == 48);
  std::mt19937_64 random(8);
  for (int p = 0; p < 6561; ++p) {
    // Magnitudes without equal products: a face compares products of at most two.
    Samples samples = samples_of(p, 1, random);
    for (double& s : samples) {
      s *= 1.0 + std::ldexp(static_cast<double>(random() >> 12), -52);
    }
    const auto patches = cell_patches(samples).patches;
    for (const Symmetry& s : all) {
      Samples turned{};
      for (int v = 0; v < 8; ++v) turned[s.vertex[v]] = samples[v];
      auto expected = patches;
      for (auto& patch : expected) {
        for (int& v : patch) v = image(v, s);
        if (s.mirrored) std::reverse(patch.begin(), patch.end());
      }
      if (canonical_patches(expected) != canonical_patches(cell_patches(turned).patches)) {
        FAIL_CHECK("P = " << p << ", " << to_string(samples));
      }
    }
  }
  SUCCEED();
}

TEST_CASE("patches do not depend on the scale of the samples", "[zmc][property]") {
  // Powers of two keep every product exact, and up to 2^±500 within the range of double.
  std::mt19937_64 random(9);
  for (int p = 0; p < 6561; ++p) {
    const Samples samples = samples_of(p, 3, random);
    const auto expected = cell_patches(samples).patches;
    for (const int exponent : {-500, -80, 80, 500}) {
      Samples scaled = samples;
      for (double& s : scaled) s = std::ldexp(s, exponent);
      if (cell_patches(scaled).patches != expected) {
        FAIL_CHECK("scale 2^" << exponent << ", " << to_string(samples));
      }
    }
  }
  SUCCEED();
}

TEST_CASE("cell_patches refuses a sample that is not finite", "[zmc][contract]") {
  Samples samples{1, 1, 1, -1, 1, 1, 1, 1};
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    samples[5] = bad;
    CHECK_THROWS_AS(cell_patches(samples), std::invalid_argument);
  }
}
TEST_CASE("products that round to the same double are told apart", "[zmc][cell]") {
  // (1 + e)² = 1 + 2e + e² against 1 · (1 + 2e): equal as doubles, the positive product is larger.
  const double e = std::numeric_limits<double>::epsilon();
  const auto cut_corners = [&](double sign) {
    std::array<double, 8> samples{-1.0, 1.0 + e, -(1.0 + 2.0 * e), 1.0 + e, -5.0, 5.0, -5.0, 5.0};
    for (double& sample : samples) sample *= sign;
    std::set<std::set<int>> edges;
    for (const PatchEdge& edge : cell_patches(samples).patch_edges) {
      if (edge.face == 4) edges.insert({edge.from, edge.to});
    }
    return edges;
  };
  // Face −z: the corners 0 and 2, of the smaller product, are cut off.
  const std::set<std::set<int>> expected{{0, 3}, {1, 2}};
  CHECK(cut_corners(1.0) == expected);
  CHECK(cut_corners(-1.0) == expected);
}

}  // namespace
