#pragma once

#include <string>

#include <Eigen/Core>
#include <shape3d/zmc/volume_view.hpp>

namespace shape3d::apps::viewer {

/// A place of a volume in words: world millimetres (LPS) with one decimal, the nearest sample and
/// its value; "outside the volume" for the last two when no sample is within half a spacing.
[[nodiscard]] std::string place_text(const zmc::VolumeView& volume, const Eigen::Vector3d& lattice);

}  // namespace shape3d::apps::viewer
