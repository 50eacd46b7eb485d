#pragma once

#include <Eigen/Core>

#include "shape3d/mapping/export.hpp"
#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

/// Settings of align().
struct PoseOptions {
  /// The axes may form a left-handed frame, so that a body and its mirror image get one pose.
  bool allow_reflection = false;
  /// Below this, an eigenvalue gap or the margin of the signs makes the pose ambiguous; in (0, 1).
  /// A change of relative size e in C turns an axis by about e / gap: a hundredth is a tenth of
  /// the pose lost to a thousandth of the shape.
  double ambiguity_tolerance = 0.01;
};

/// Position, orientation and size of a surface by continuous principal component analysis. The
/// posed surface is scale · rotation · (v − centroid): its centroid is the origin, its mean squared
/// distance from there is 1, its variances along x ≥ y ≥ z are uncorrelated.
struct Pose {
  Eigen::Vector3d centroid;  ///< Of the surface (4.2).
  Eigen::Matrix3d rotation;  ///< Rows are the axes; in SO(3), or in O(3) with allow_reflection.
  double scale = 1.0;        ///< 1 / √(λ1 + λ2 + λ3).
  double area = 0.0;         ///< S, in the square of the unit of V.

  Eigen::Vector3d eigenvalues;  ///< λ1 ≥ λ2 ≥ λ3 ≥ 0 of C (4.3), in the square of the unit of V.
  /// (λ1 − λ2) / λ1 and (λ2 − λ3) / λ1, 0 … 1. Where one is small the two axes are arbitrary in
  /// their plane.
  Eigen::Vector2d gaps;
  /// f / λ of each axis in the posed frame, −1 … 1, with f of (4.5): how much farther the surface
  /// extends to the positive side. 0 for an axis across a plane of symmetry. Negative only for
  /// the reversed axis. 0 when λ is 0.
  Eigen::Vector3d skew;
  /// The moments of (4.4) demanded a left-handed frame, and this axis, that of the smallest |skew|,
  /// was reversed instead; −1: none.
  int reversed_axis = -1;
  /// By how much the chosen signs beat the next best ones: the two smallest |skew| added, or
  /// subtracted when an axis was reversed; with allow_reflection the smallest |skew| alone. One
  /// plane of symmetry leaves it large: the other two axes decide the third.
  double sign_margin = 0.0;
  bool ambiguous = false;  ///< A gap or sign_margin is below the tolerance.
};

/// Pose of a surface (Saupe and Vranić's CPCA), from exact integrals over its triangles, so that it
/// does not depend on the tessellation:
///   centroid  ∫ v / S,   C = ∫ u uᵀ / S  with u = v − centroid (4.3),
///   f_x = ∫ sign(x) x² / S  (4.5), where triangles that cross the plane x = 0 are split there.
///
/// @param V  #V by 3, finite; any unit. The surface may be open and of several parts.
/// @param F  #F by 3 rows of V, at least 1; their order and orientation do not matter.
/// @throws std::invalid_argument  a coordinate is not finite; an index is out of range; the total
/// area is zero or its extent is beyond the range of double; the tolerance is out of range.
///
/// Equivariant: align() of moved, turned and scaled vertices has the same posed surface to
/// rounding, unless `ambiguous`. Deterministic. O(#F).
/// @cite Saupe and Vranić 2001; errata: docs/notes/meshes.md.
[[nodiscard]] SHAPE3D_MAPPING_EXPORT Pose align(const ConstPoints& V, const ConstTriangles& F,
                                                const PoseOptions& options = {});

/// scale · rotation · (v − centroid) of each row. After a reflection the triangles run clockwise
/// seen from outside; the caller turns them.
[[nodiscard]] SHAPE3D_MAPPING_EXPORT Points posed(const ConstPoints& V, const Pose& pose);

}  // namespace shape3d::mapping
