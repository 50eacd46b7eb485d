#pragma once

#include <string_view>

#include "shape3d/levelset/export.hpp"

namespace shape3d::levelset {

/// How a segmentation or an evolution ended.
enum class Status {
  converged,        ///< The front moves less than EvolveOptions::tolerance.
  iteration_limit,  ///< It still moved when EvolveOptions::max_iterations were done.
  front_vanished,   ///< No node is inside any more.
  front_filled,     ///< Every node is inside.
  constant_image,   ///< All samples (padding left out) are equal: there is nothing to separate.
  too_few_bins,     ///< The histogram has fewer occupied bins than the mixture has classes.
  one_sided,        ///< All classes are inside, or all are outside.
  cancelled         ///< The progress callback returned false.
};

/// One plain sentence part, for example "the front vanished: no voxel is inside".
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT std::string_view to_string(Status status);

}  // namespace shape3d::levelset
