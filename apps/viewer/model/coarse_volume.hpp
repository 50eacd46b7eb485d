#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <shape3d/zmc/volume_view.hpp>

namespace shape3d::apps::viewer {

/// A volume of fewer samples, for pictures that must be there at once.
struct CoarseVolume {
  std::vector<float> samples;
  zmc::VolumeView view;  ///< view.data == samples.data().
  std::array<std::int64_t, 3> factors{1, 1, 1};
};

/// Means of blocks of samples, each at the middle of its block. The factors are doubled, that of
/// the axis with the smallest step in millimetres first, until there are at most `most` blocks or
/// an axis cannot spare more; blocks at the far border may be smaller. A block with a sample that
/// is not finite is NaN.
/// @pre  validate(volume); most ≥ 8.
/// O(samples of the volume), memory 4 bytes a block.
[[nodiscard]] CoarseVolume coarsen(const zmc::VolumeView& volume, std::int64_t most);

}  // namespace shape3d::apps::viewer
