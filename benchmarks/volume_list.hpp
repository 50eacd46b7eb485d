#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <shape3d/zmc/volume_view.hpp>

#include "ct_volume.hpp"

namespace shape3d::bench {

/// A volume in memory, and what it is called.
struct LoadedVolume {
  std::string name;
  std::vector<std::byte> samples;
  zmc::VolumeView
      view;  ///< Of samples; dense, unit spacing: what is compared does not depend on it.
  double isovalue = 0.0;
};

/// A volume that is made or read when its turn comes.
struct ListedVolume {
  const CtSize* generated = nullptr;  ///< Null: it is read.
  std::function<LoadedVolume()> load;
};

/// The five volumes of kCtSizes.
[[nodiscard]] std::vector<ListedVolume> generated_volumes();

/// The volumes at a path: one file, or all MetaImages and DICOM series below a folder, in the order
/// of their paths. Of development data (a folder holding table31 or classic) these two folders.
///
/// @param argument  PATH or PATH@ISOVALUE. Without an isovalue: engine 128, bonsai 40 and tooth
/// 150,
///                  where the customary surfaces are; −400 (skin, air in lungs) where the least
///                  sample is −900 or below, as in CT; else the integer halfway between the
///                  extremes.
/// @throws apps::FileError  there is nothing at the path, or no volume.
/// @throws std::invalid_argument  the isovalue is not a finite number.
[[nodiscard]] std::vector<ListedVolume> volumes_at(const std::string& argument);

}  // namespace shape3d::bench
