#pragma once

#include <string_view>

#include "shape3d/zmc/export.hpp"

namespace shape3d::zmc {

/// How an extraction ended.
enum class Status {
  ok,                   ///< A surface.
  empty,                ///< A valid surface of no triangles: the isovalue separates no samples.
  too_many_vertices,    ///< More vertices than Options::max_vertices or the index type allow; only
                        ///< counts are set.
  zero_region_at_seam,  ///< stream() of a source that cannot be read twice: cells of eight zeros
                        ///< beside a seam.
  cancelled             ///< Options::progress returned false; the surface is empty.
};

/// One plain sentence part, for example "too many vertices for the index type".
[[nodiscard]] SHAPE3D_ZMC_EXPORT std::string_view to_string(Status status);

}  // namespace shape3d::zmc
