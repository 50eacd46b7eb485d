#include "face_configurations.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <utility>

namespace shape3d::apps {
namespace {

using Signs = std::array<int, 4>;
using Permutation = std::array<std::size_t, 4>;

constexpr std::size_t kBelow = 4, kFront = 2;  // faces −z and −y

/// All choices of `count` elements of `values`, the first value in every place first.
std::vector<std::vector<int>> choices(std::size_t count, const std::vector<int>& values) {
  std::vector<std::vector<int>> result{{}};
  for (std::size_t n = 0; n < count; ++n) {
    std::vector<std::vector<int>> longer;
    for (const std::vector<int>& start : result) {
      for (const int value : values) {
        longer.push_back(start);
        longer.back().push_back(value);
      }
    }
    result = std::move(longer);
  }
  return result;
}

/// One of each class of sign patterns under the permutations and negation: of its members the one
/// with most positive signs, and these first.
std::vector<Signs> representatives(const std::vector<Permutation>& group) {
  std::vector<Signs> result;
  for (const std::vector<int>& choice : choices(4, {1, 0, -1})) {
    const Signs signs{choice[0], choice[1], choice[2], choice[3]};
    const auto rank = [](const Signs& s) {
      return std::pair{std::count(s.begin(), s.end(), 1), s};
    };
    bool first = true;
    for (const Permutation& p : group) {
      for (const int factor : {1, -1}) {
        Signs image{};
        for (std::size_t i = 0; i < 4; ++i) image[i] = factor * signs[p[i]];
        first = first && rank(image) <= rank(signs);
      }
    }
    if (first) result.push_back(signs);
  }
  return result;
}

/// Rotations and reflections of four corners in cyclic order.
std::vector<Permutation> symmetries_of_square() {
  std::vector<Permutation> group;
  for (std::size_t turn = 0; turn < 4; ++turn) {
    Permutation forward{}, backward{};
    for (std::size_t i = 0; i < 4; ++i) {
      forward[i] = (i + turn) % 4;
      backward[i] = (turn + 4 - i) % 4;
    }
    group.push_back(forward);
    group.push_back(backward);
  }
  return group;
}

std::vector<std::array<double, 4>> magnified(const Signs& signs) {
  std::vector<std::array<double, 4>> result;
  for (const std::vector<int>& m : choices(4, {1, 2, 3})) {
    std::array<double, 4> values{};
    bool again = false;
    for (std::size_t i = 0; i < 4; ++i) {
      again = again || (signs[i] == 0 && m[i] != 1);
      values[i] = signs[i] * m[i];
    }
    if (!again) result.push_back(values);
  }
  return result;
}

bool lies_in(zmc::CellSurfaceVertex vertex, std::size_t face) {
  const std::array<int, 4>& corners = zmc::kCellFaces[face];
  const auto in = [&](int v) {
    return std::find(corners.begin(), corners.end(), v) != corners.end();
  };
  if (vertex >= 12) return in(vertex - 12);
  const std::array<int, 2>& ends = zmc::kCellEdges[static_cast<std::size_t>(vertex)];
  return in(ends[0]) && in(ends[1]);
}

/// The patch edges that lie in one of the faces.
std::set<Edge> edges_in(const zmc::CellPatches& cell, const std::vector<std::size_t>& faces) {
  std::set<Edge> result;
  for (const Edge& e : patch_edges_of(cell)) {
    const bool inside = std::any_of(faces.begin(), faces.end(), [&](std::size_t f) {
      return lies_in(e.first, f) && lies_in(e.second, f);
    });
    if (inside) result.insert(e);
  }
  return result;
}

/// decided and undecided over all values 0, ±1, ±2, ±3 of the samples `free`.
void decide(FaceConfiguration& configuration, const std::vector<std::size_t>& free,
            const std::vector<std::size_t>& faces) {
  std::set<Edge> all, common;
  bool first = true;
  for (const std::vector<int>& values : choices(free.size(), {1, 0, -1, 2, -2, 3, -3})) {
    Samples samples = configuration.samples;
    for (std::size_t i = 0; i < free.size(); ++i) samples[free[i]] = values[i];
    const std::set<Edge> edges = edges_in(zmc::cell_patches(samples), faces);
    all.insert(edges.begin(), edges.end());
    if (first) common = edges;
    first = false;
    std::set<Edge> both;
    std::set_intersection(common.begin(), common.end(), edges.begin(), edges.end(),
                          std::inserter(both, both.end()));
    common = std::move(both);
  }
  configuration.decided = common;
  std::set_difference(all.begin(), all.end(), common.begin(), common.end(),
                      std::inserter(configuration.undecided, configuration.undecided.end()));
}

std::string case_of(const FaceConfiguration& c, std::size_t face) {
  return std::to_string(zmc::cell_patches(c.samples).face_case[face]);
}

/// Appends ".1", ".2" … to the names of configurations that differ in magnitudes alone.
void append_numbered(std::vector<FaceConfiguration>& to, std::vector<FaceConfiguration> variants) {
  for (std::size_t n = 0; n < variants.size(); ++n) {
    if (variants.size() > 1) variants[n].name += ", way " + std::to_string(n + 1);
    to.push_back(std::move(variants[n]));
  }
}

bool is_new(const std::vector<FaceConfiguration>& variants, const std::set<Edge>& decided) {
  return std::none_of(variants.begin(), variants.end(),
                      [&](const FaceConfiguration& c) { return c.decided == decided; });
}

}  // namespace

std::vector<FaceConfiguration> single_faces() {
  std::map<int, std::vector<FaceConfiguration>> by_case;
  for (const Signs& signs : representatives(symmetries_of_square())) {
    for (const std::array<double, 4>& values : magnified(signs)) {
      FaceConfiguration c;
      c.samples = {values[0], values[1], values[2], values[3], 1, 1, 1, 1};
      const int number = zmc::cell_patches(c.samples).face_case[kBelow];
      if (number == 4 || number == 8 || number == 11 || number == 12) continue;
      c.name = "case " + std::to_string(number);
      // Signs suffice for the other samples: no rule of these cases looks at their magnitudes.
      c.decided = edges_in(zmc::cell_patches(c.samples), {kBelow});
      if (is_new(by_case[number], c.decided)) by_case[number].push_back(c);
    }
  }
  std::vector<FaceConfiguration> result;
  for (auto& [number, variants] : by_case) append_numbered(result, std::move(variants));
  return result;
}

std::vector<FaceConfiguration> faces_at_zero_edge() {
  // Samples of cell vertices 3, 2 in face −z and of 4, 5 in face −y, beside the edge 0–1.
  const std::vector<Permutation> group{{0, 1, 2, 3}, {2, 3, 0, 1}, {1, 0, 3, 2}, {3, 2, 1, 0}};
  std::vector<std::pair<std::pair<int, int>, std::vector<FaceConfiguration>>> found;
  for (const Signs& signs : representatives(group)) {
    if ((signs[0] == 0 && signs[1] == 0) || (signs[2] == 0 && signs[3] == 0)) continue;
    std::vector<FaceConfiguration> variants;
    std::pair<int, int> cases;
    for (const std::array<double, 4>& values : magnified(signs)) {
      FaceConfiguration c;
      c.samples = {0, 0, values[1], values[0], values[2], values[3], 1, 1};
      decide(c, {6, 7}, {kBelow, kFront});
      c.name = case_of(c, kBelow) + " and " + case_of(c, kFront);
      cases = std::minmax({std::stoi(case_of(c, kBelow)), std::stoi(case_of(c, kFront))});
      if (is_new(variants, c.decided)) variants.push_back(c);
    }
    found.emplace_back(cases, std::move(variants));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<FaceConfiguration> result;
  for (auto& [cases, variants] : found) append_numbered(result, std::move(variants));
  return result;
}

std::vector<FaceConfiguration> cells_at_zero_face() {
  std::map<int, std::vector<FaceConfiguration>> by_case;
  FaceConfiguration without;
  std::set<int> cases_without;
  for (const Signs& signs : representatives(symmetries_of_square())) {
    for (const std::array<double, 4>& values : magnified(signs)) {
      FaceConfiguration c;
      c.samples = {0, 0, 0, 0, values[0], values[1], values[2], values[3]};
      const zmc::CellPatches cell = zmc::cell_patches(c.samples);
      const int opposite = cell.face_case[5];
      c.decided = patch_edges_of(cell);
      c.name = "12 below " + std::to_string(opposite);
      if (c.decided.empty()) {
        if (cases_without.empty() || opposite < *cases_without.begin()) without = c;
        cases_without.insert(opposite);
      } else if (is_new(by_case[opposite], c.decided)) {
        by_case[opposite].push_back(c);
      }
    }
  }
  without.name = "12 below";
  for (const int number : cases_without) without.name += " " + std::to_string(number);
  std::vector<FaceConfiguration> result{without};
  for (auto& [number, variants] : by_case) append_numbered(result, std::move(variants));
  return result;
}

}  // namespace shape3d::apps
