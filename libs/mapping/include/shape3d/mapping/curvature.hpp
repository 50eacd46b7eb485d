#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "shape3d/mapping/export.hpp"
#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

/// Settings of curvature().
struct CurvatureOptions {
  /// Degree of the polynomial that is fitted, 2 … 4. On smooth surfaces the error falls with the
  /// power degree − 1 of the edge length; a lower degree smooths noise more.
  int degree = 3;
  /// Rings of neighbours that take part, 1 … 10; more where they have too few vertices.
  int rings = 2;
};

/// Curvatures at the vertices, in the inverse of the unit of V (its square for `gaussian`).
/// Positive where the surface bends away from its outward normal: a sphere of radius r has 1 / r.
struct Curvature {
  Eigen::VectorXd mean;                         ///< H = (κ1 + κ2) / 2.
  Eigen::VectorXd gaussian;                     ///< K = κ1 κ2.
  Eigen::VectorXd maximum, minimum;             ///< κ1 ≥ κ2, the principal curvatures.
  Points maximum_direction, minimum_direction;  ///< Their unit tangents; the signs are arbitrary.
  Points normal;                                ///< Outward unit normals of the fitted surface.
  /// Vertices with fewer than five others in their component, or whose neighbours lie on a line as
  /// seen along the normal, or in triangles of no area: NaN in all of the above.
  std::int64_t undetermined = 0;
};

/// Curvature by polynomial fitting (osculating jets, Cazals and Pouget): over the tangent plane at
/// a vertex, z = Σ a_ij x^i y^j is fitted to its neighbours by least squares; the curvatures are
/// those of the fitted surface above the vertex.
///
/// @param V  #V by 3, finite.
/// @param F  #F by 3 rows of V, oriented so that normals point outwards; may have a boundary.
/// @throws std::invalid_argument  a coordinate is not finite; an index is out of range; the extent
/// is beyond the range of double; an option is out of range.
///
/// Errors fall by the power of the edge length given above at interior vertices with neighbours on
/// all sides. Equivariant under motions and scale. Deterministic. O(#V · neighbours), about 0.5 s
/// for 50k vertices.
[[nodiscard]] SHAPE3D_MAPPING_EXPORT Curvature curvature(const ConstPoints& V,
                                                         const ConstTriangles& F,
                                                         const CurvatureOptions& options = {});

}  // namespace shape3d::mapping
