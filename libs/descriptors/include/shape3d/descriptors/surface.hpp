#pragma once

#include <cstdint>
#include <string_view>

#include <Eigen/Core>

#include "shape3d/descriptors/export.hpp"

namespace shape3d::descriptors {

/// #V by 3 vertex positions, in any unit.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// #F by 3 rows of a Points. Any triangle soup: open, non-manifold, in either orientation, with
/// duplicate and degenerate triangles.
using Triangles = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// What becomes the origin.
enum class Centre {
  area,  ///< Centroid of the surface: ∫ x dA / ∫ dA. Does not depend on how it is triangulated.
  box    ///< Middle of the axis-parallel bounding box; not invariant under rotation.
};

/// Which length of the surface, measured from the origin, is the unit.
enum class Scale {
  rms,   ///< √(∫ |x|² dA / ∫ dA)
  mean,  ///< ∫ |x| dA / ∫ dA, by quadrature on pieces of less than 1/16 of the largest radius.
  maximum  ///< max |x|
};

/// Where a surface lies in the unit ball: a point p of the surface is at (p − centre) / radius.
struct Frame {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1.0;  ///< Of the ball, in the unit of the surface; > 0.
};

/// Refuses what is not a surface.
///
/// @throws std::invalid_argument  V or F has no rows; a coordinate is not finite; an index of F is
/// negative or not below V.rows(). The message names the first one.
SHAPE3D_DESCRIPTORS_EXPORT void check_surface(const Eigen::Ref<const Points>& V,
                                              const Eigen::Ref<const Triangles>& F);

/// Area of the surface, ½ Σ |(b − a) × (c − a)|. O(F).
/// @throws std::invalid_argument  as check_surface().
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT double surface_area(const Eigen::Ref<const Points>& V,
                                                             const Eigen::Ref<const Triangles>& F);

/// Ball in which a surface is described: radius = factor · (length chosen by `scale`).
///
/// Computed relative to the middle of the bounding box and its size, so that neither an offset of
/// 1e9 nor a scale of 1e±9 costs more digits than the coordinates themselves have lost.
/// @param factor  > 0. 2 with Scale::rms leaves the points beyond twice the RMS radius outside.
/// @throws std::invalid_argument  as check_surface(); factor is not positive and finite; every
/// triangle has zero area, so that there is no centroid; the surface is a point.
/// O(V + F). Deterministic.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Frame surface_frame(const Eigen::Ref<const Points>& V,
                                                             const Eigen::Ref<const Triangles>& F,
                                                             Centre centre = Centre::area,
                                                             Scale scale = Scale::rms,
                                                             double factor = 2.0);

/// Points on a surface with weights: ∫_S g dA ≈ Σ_i weights[i] g(points.row(i)).
struct SurfacePoints {
  Points points;            ///< #P by 3.
  Eigen::VectorXd weights;  ///< #P areas, ≥ 0; their sum is the area.
};

/// Quadrature on a surface: each triangle is divided into n² equal ones, n the least with edges not
/// longer than `max_edge`, and each of these gives three points of a third of its area, at the
/// barycentric places (2/3, 1/6, 1/6): exact for quadratic g. Order: triangle by triangle.
///
/// @param max_edge   > 0, unit of V.
/// @throws std::invalid_argument  as check_surface(); max_edge is not positive; more than 2³¹
/// points. O(points).
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT SurfacePoints surface_points(
    const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F, double max_edge);

}  // namespace shape3d::descriptors
