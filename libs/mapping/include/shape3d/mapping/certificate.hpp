#pragma once

#include <cstdint>

#include "shape3d/mapping/export.hpp"
#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

/// Proof that a map of a closed mesh to the unit sphere is one to one.
///
/// The map takes triangle (a, b, c) to the smaller spherical triangle of the directions of S_a,
/// S_b, S_c. It is a homeomorphism if and only if every det(S_a, S_b, S_c) > 0 and the degree is 1:
/// each triangle is then embedded with its orientation, and as many of them as the degree lie over
/// every point that is on no edge.
struct Certificate {
  std::int64_t flipped = 0;      ///< Triangles of det < 0.
  std::int64_t degenerate = 0;   ///< Triangles of det = 0.
  std::int64_t degree = 0;       ///< Signed triangles over a point of the sphere.
  double total_solid_angle = 0;  ///< Sum of the signed solid angles, 4π · degree but for rounding.
  /// flipped = degenerate = 0 and degree = 1.
  [[nodiscard]] bool bijective() const { return flipped == 0 && degenerate == 0 && degree == 1; }
};

/// Counts by exact predicates on the stored doubles (CGAL's filtered orientation), so that it holds
/// however small a triangle is; the lengths of the rows of S do not matter.
///
/// The degree is counted over one point off all edges; it is the same over all others because the
/// mesh is closed. For a mesh that is not, it is the count over that point.
///
/// @param S  #V by 3, finite, no zero row.
/// @param F  #F by 3 rows of S.
/// @throws std::invalid_argument  a row of S is zero or not finite; an index is out of range.
/// O(#F).
[[nodiscard]] SHAPE3D_MAPPING_EXPORT Certificate certify(const ConstPoints& S,
                                                         const ConstTriangles& F);

}  // namespace shape3d::mapping
