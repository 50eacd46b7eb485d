#pragma once

#include "classify.hpp"

namespace shape3d::zmc::detail {

/// What extract() and contour() require of their arguments.
/// @throws std::invalid_argument
void check_arguments(const VolumeView& view, double isovalue, const Options& options);

/// A parallel loop over layers by options.threads, which reports progress between `from` and `to`.
LayerLoop layer_loop(const Options& options, double from, double to);

}  // namespace shape3d::zmc::detail
