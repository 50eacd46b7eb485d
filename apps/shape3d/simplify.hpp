#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <shape3d/mapping/progressive.hpp>

#include "common/mesh.hpp"
#include "progress.hpp"

namespace shape3d::apps {

/// "quadrics", "lindstrom_turk", "hoppe"; empty for another word.
[[nodiscard]] std::optional<mapping::CollapseCost> collapse_cost_named(const std::string& name);

/// The levels of a mesh down to `coarsest` triangles.
/// @throws FileError  the mesh of `path` is not an oriented manifold: what is wrong, how often, and
/// what to do.
[[nodiscard]] mapping::ProgressiveMesh make_levels(const Mesh& mesh, const std::string& path,
                                                   mapping::CollapseCost cost,
                                                   std::int64_t coarsest, Progress& progress);

}  // namespace shape3d::apps
