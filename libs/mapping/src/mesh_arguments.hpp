#pragma once

#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping::detail {

/// Throws std::invalid_argument that names the first row of F with an index outside V, and how many
/// such rows there are.
void check_indices(const ConstPoints& V, const ConstTriangles& F);

/// Throws std::invalid_argument that names the first row of V that is not finite, and how many such
/// rows there are.
void check_finite(const ConstPoints& V);

/// A box, and a power of two that brings its extent to 1 … 2 exactly.
struct Frame {
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
  double unit = 1.0;  ///< A length of V; a power of two.
};

/// Frame of the vertices that triangles use. Throws std::invalid_argument when the extent
/// overflows.
Frame frame_of(const ConstPoints& V, const ConstTriangles& F);

}  // namespace shape3d::mapping::detail
