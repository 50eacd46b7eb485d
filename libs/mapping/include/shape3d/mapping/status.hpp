#pragma once

#include <string_view>

#include "shape3d/mapping/export.hpp"

namespace shape3d::mapping {

/// How the computation of a spherical map ended.
enum class Status {
  certified,      ///< A map that is proved to be one to one.
  tangled,        ///< Triangles stayed flipped; no map.
  wrong_degree,   ///< No triangle is flipped, but the sphere is covered more than once; no map.
  crowded,        ///< Parts of the surface shrink below what double can tell apart; no map.
  solver_failed,  ///< The sparse Cholesky factorisation broke down; no map.
  cancelled       ///< The caller's progress function returned false; no map.
};

/// One plain sentence part, for example "triangles stayed flipped".
[[nodiscard]] SHAPE3D_MAPPING_EXPORT std::string_view to_string(Status status);

}  // namespace shape3d::mapping
