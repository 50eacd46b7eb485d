#pragma once

#include <shape3d/zmc/volume_view.hpp>

namespace shape3d::apps::viewer {

/// A value to begin with: bone (226) where the values are those of CT, from below −500 to above
/// 500; else the threshold of Otsu, which parts the values best into two classes, of about 200,000
/// samples.
[[nodiscard]] double default_isovalue(const zmc::VolumeView& volume, double minimum,
                                      double maximum);

}  // namespace shape3d::apps::viewer
