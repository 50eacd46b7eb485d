#pragma once

// The rules that make patch edges out of the signs of one cell: sections 2.3.1 to 2.3.3 and
// appendix A.

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "shape3d/zmc/cell.hpp"

namespace shape3d::zmc::detail {

/// Question put to the samples of an ambiguous face: is the product of the positive samples the
/// larger? Cell vertices in Lorensen's order; a second entry of −1 means that a single sample is
/// compared.
struct Comparison {
  std::array<std::int8_t, 2> positive{-1, -1}, negative{-1, -1};
  bool first_is_positive =
      false;  ///< The cell vertex first in (z, y, x) order is a positive one (neutral ties).

  friend bool operator==(const Comparison& a, const Comparison& b) {
    return a.positive == b.positive && a.negative == b.negative;
  }
};

/// Answers a comparison from |sample − isovalue| at the eight cell vertices.
inline bool positive_prevails(const Comparison& c, const std::array<double, 8>& magnitude,
                              TieRule ties) {
  // A product as its nearest double and what rounding left over, so that only equal products tie.
  struct Product {
    double value, rest;
  };
  const auto product = [&](const std::array<std::int8_t, 2>& v) {
    if (v[1] < 0) return Product{magnitude[v[0]], 0.0};
    const double value = magnitude[v[0]] * magnitude[v[1]];
    return Product{value,
                   std::isfinite(value) ? std::fma(magnitude[v[0]], magnitude[v[1]], -value) : 0.0};
  };
  const Product p = product(c.positive);
  const Product n = product(c.negative);
  if (p.value != n.value) return p.value > n.value;
  if (p.rest != n.rest) return p.rest > n.rest;
  return ties == TieRule::positive || c.first_is_positive;
}

/// What the rules say about one cell. Surface vertices are numbered as in CellPatches.
struct CellGraph {
  std::array<int, 6> face_case{};
  std::array<int, 6> zero_face_sign{};
  std::vector<PatchEdge> edges;
  unsigned resolution = 0;  ///< Σ 2^f r_f over the ambiguous faces.
  unsigned zero_edges = 0;  ///< Bit e: cell edge e carries a patch edge.
};

/// Signs −1, 0, +1 at the cell vertices, Lorensen's order.
using CellSigns = std::array<int, 8>;

/// Applies the rules. `answers[c]` replies to the comparison with index c in `comparisons`, which
/// is extended when a comparison is met for the first time (its answer is then taken as false).
CellGraph apply_rules(const CellSigns& signs, std::vector<Comparison>& comparisons,
                      const std::vector<bool>& answers);

/// The comparisons that the rules need for these signs; they do not depend on the answers.
std::vector<Comparison> required_comparisons(const CellSigns& signs);

/// The patches: directed cycles of the patch edges. Each starts at its smallest vertex.
std::vector<std::vector<CellSurfaceVertex>> find_cycles(const CellGraph& graph);

/// P = Σ 3^v p_v with p = 0, 1, 2 for zero, positive, negative.
int case_index(const CellSigns& signs);

}  // namespace shape3d::zmc::detail
