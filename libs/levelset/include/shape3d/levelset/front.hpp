#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "shape3d/levelset/export.hpp"
#include "shape3d/levelset/image_view.hpp"

namespace shape3d::levelset {

/// Start fronts: signed distances in mm, negative inside.

/// Distance to the surface of a box whose faces lie half a spacing outside its outermost nodes, so
/// that the nodes of `box`, border slices too, are inside.
/// @throws std::invalid_argument  validate(grid) fails; the box is empty or reaches outside the
/// grid.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Field box_front(const Grid& grid, const Box& box);

/// Distance to a sphere.
/// @param center  Lattice coordinates (i, j, k), not necessarily integers.
/// @param radius  mm, positive.
/// @throws std::invalid_argument  validate(grid) fails; the centre is not within the lattice; the
///         radius is not finite and positive.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Field sphere_front(const Grid& grid,
                                                         const Eigen::Vector3d& center,
                                                         double radius);

/// Front of a label map: nodes with a label other than 0 are inside. The front lies half-way
/// between nodes; distances are of first order and reach 4 of the largest spacing.
/// @param labels  nx·ny·nz.
/// @throws std::invalid_argument  validate(grid) fails; sizes differ.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Field
label_front(const Grid& grid, const Eigen::Ref<const Eigen::Array<std::uint8_t, -1, 1>>& labels);

/// Signed distance to the zero set of ψ, truncated at ±limit mm; zeros stay zeros and signs signs.
/// Distances beside the front as in boundary_distance().
/// @throws std::invalid_argument  validate(grid) fails; sizes differ; a value is not finite; limit
/// is
///         not positive and finite.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Field redistance(const Grid& grid, const Field& psi,
                                                       double limit, int threads = 0);

}  // namespace shape3d::levelset
