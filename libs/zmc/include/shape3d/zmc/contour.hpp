#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "shape3d/zmc/export.hpp"
#include "shape3d/zmc/options.hpp"
#include "shape3d/zmc/volume_view.hpp"

namespace shape3d::zmc {

/// A contour in a lattice plane.
struct Contour {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>
      V;  ///< #V by 3, world units; none coincide.
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, 2, Eigen::RowMajor>
      E;  ///< #E by 2, rows of vertex ids.
};

/// The 2D contour of the isosurface on the lattice plane `slice` of an axis (section 3.3.1), from
/// the surface's own patch edges.
///
/// The surface inside the layer of cells above the plane (below it for the last plane) is a chain
/// of patches and zero faces; the contour is its boundary in the plane, modulo 2: the patch edges
/// and sides of zero faces that lie in the plane and occur an odd number of times. It is therefore
/// closed: every vertex off the border of the volume has even degree. Edges run with the inside on
/// their left when seen against the axis, in lattice coordinates.
///
/// @param axis   0, 1 or 2 for x, y, z.
/// @param slice  Plane index, 0 ≤ slice < dims[axis].
/// @throws std::invalid_argument  as extract(); axis or slice out of range; options.border is
/// capped. Cost: one classification of the volume, then O(cells of the layer).
[[nodiscard]] SHAPE3D_ZMC_EXPORT Contour contour(const VolumeView& view, double isovalue, int axis,
                                                 std::int64_t slice, const Options& options = {});

}  // namespace shape3d::zmc
