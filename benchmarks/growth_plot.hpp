#pragma once

#include <string>
#include <vector>

#include "comparison.hpp"

namespace shape3d::bench {

/// Seconds over triangles of the generated volumes, both axes logarithmic, beside the figures of
/// the dissertation.
/// @return PNG bytes.
/// @throws apps::PictureError  no display can be had.
[[nodiscard]] std::string growth_plot(const std::vector<VolumeResult>& results);

}  // namespace shape3d::bench
