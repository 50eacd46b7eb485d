#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "corner_mesh.hpp"
#include "shape3d/mapping/progressive.hpp"

namespace shape3d::mapping {

/// A collapse with all that is needed to make and to undo it.
struct ProgressiveStep {
  detail::CollapsePlace place;
  Eigen::RowVector3d kept_before, removed, kept_after;  ///< Positions.
};

struct ProgressiveMesh::Data {
  static constexpr std::int32_t kNever = std::numeric_limits<std::int32_t>::max();

  detail::CornerMesh mesh;
  Points P;                            ///< Of all vertices; those removed keep their last position.
  std::vector<ProgressiveStep> steps;  ///< In the order of collapses.
  std::int64_t level = 0;              ///< Collapses that are made at present.
  /// The step that removes each; kNever for those of the coarsest level. Present while it is not
  /// below `level`.
  std::vector<std::int32_t> vertex_end, triangle_end;
  std::vector<std::int64_t> triangles_at;  ///< Triangles after each number of collapses.
  int lattice_exponent = 0;                ///< New positions are multiples of 2 to the power of it.
  bool complete = true;

  /// Appends a step to a mesh that is at the level behind all steps, and makes it.
  void append(const ProgressiveStep& step);
  void coarsen();
  void refine();
};

}  // namespace shape3d::mapping
