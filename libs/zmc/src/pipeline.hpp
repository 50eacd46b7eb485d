#pragma once

#include "classify.hpp"

namespace shape3d::zmc::detail {

/// What extract() and contour() require of their arguments.
/// @throws std::invalid_argument
void check_arguments(const VolumeView& view, double isovalue, const Options& options);

/// Samples of a view.
inline std::int64_t sample_count(const VolumeView& view) {
  return view.dims[0] * view.dims[1] * view.dims[2];
}

/// A loop over the layers of a volume of so many samples, by options.threads but by one thread
/// where the volume is too small to gain from more; reports progress between `from` and `to`.
LayerLoop layer_loop(const Options& options, std::int64_t samples, double from, double to);

}  // namespace shape3d::zmc::detail
