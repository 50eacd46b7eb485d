#pragma once

#include <cstdint>

#include "shape3d/mapping/mesh.hpp"
#include "surface.hpp"

namespace shape3d::mapping {

/// Triangles of S that are flipped, degenerate or too small to tell.
[[nodiscard]] std::int64_t flipped_count(const ConstTriangles& F, const Points& S);

struct Untangling {
  std::int64_t found = 0;  ///< Flipped or degenerate triangles before.
  std::int64_t left = 0;   ///< After.
};

/// Moves the vertices around flipped triangles of S until these are positive.
///
/// Each connected patch of flipped triangles, grown by rings of triangles until it succeeds, is
/// projected gnomonically, which keeps orientations, and its inner vertices minimise the conformal
/// energy with the determinant replaced by (det + √(det² + ε²)) / 2 for ε → 0 (Garanzha, Kaporin,
/// Kudryavtseva, Protais, Ray, Sokolov 2021); its border stays. Then the surroundings of triangles
/// of σ1 / σ2 > 4 are relaxed in the same way.
Untangling untangle(const ConstPoints& V, const ConstTriangles& F, const Twins& twins, Points& S);

}  // namespace shape3d::mapping
