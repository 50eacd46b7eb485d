#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "shape3d/mapping/export.hpp"
#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

/// Five-number summary and the mean of a quantity over triangles or angles.
struct Quantiles {
  double mean = 0, median = 0, p95 = 0, p99 = 0, max = 0;
};

/// How far a map V → S is from conformal. All measures compare each plane triangle of V with the
/// plane triangle of its three points in S; they are unchanged when V is moved or scaled.
struct Distortion {
  /// |angle in S − angle in V|, in degrees, over the 3 #F corners.
  Quantiles angle_change;
  /// σ1 / σ2 ≥ 1 of the linear map between the two triangles, over triangles; 1 is conformal.
  Quantiles sigma_ratio;
  /// Dirichlet energy ½ ∫ |∇S|² over the area of S: ≥ 1, and 1 only for a conformal map.
  double energy_over_area = 0;
  /// Share of the area of V in triangles that receive less than 1 % of their fair part of the
  /// sphere, which is 4π · area / total area.
  double starved_area_share = 0;
  double shortest_edge = 0;               ///< Smallest |S_a − S_b| over edges.
  std::int64_t unmeasured_triangles = 0;  ///< Of zero area in V, where nothing can be compared.
};

/// @param V  #V by 3, finite.
/// @param F  #F by 3 rows of V.
/// @param S  #V by 3, finite.
/// Triangles that are degenerate in V are left out and counted; one that is degenerate in S alone
/// has an infinite σ1 / σ2.
/// @throws std::invalid_argument  the shapes do not fit; a coordinate is not finite; an index is
/// out of range. O(#F log #F).
[[nodiscard]] SHAPE3D_MAPPING_EXPORT Distortion measure_distortion(const ConstPoints& V,
                                                                   const ConstTriangles& F,
                                                                   const ConstPoints& S);

/// Per triangle, for pictures: the mean |angle change| in degrees, σ1 / σ2, and
/// log10(share of the sphere / share of the surface). NaN where V is degenerate.
struct TriangleDistortion {
  std::vector<double> angle_change, sigma_ratio, log10_area_scale;
};

/// @throws std::invalid_argument  as measure_distortion().
[[nodiscard]] SHAPE3D_MAPPING_EXPORT TriangleDistortion triangle_distortion(const ConstPoints& V,
                                                                            const ConstTriangles& F,
                                                                            const ConstPoints& S);

}  // namespace shape3d::mapping
