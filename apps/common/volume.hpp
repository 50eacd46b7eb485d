#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <shape3d/zmc/volume_view.hpp>

namespace shape3d::apps {

/// A volume in memory with its place in the patient: samples x fastest, world LPS, millimetres.
/// Move-only, since view.data points into samples.
struct Volume {
  Volume() = default;
  Volume(const Volume&) = delete;
  Volume& operator=(const Volume&) = delete;
  Volume(Volume&& other) noexcept { *this = std::move(other); }
  /// The moved-from volume is empty: no samples, view.data null.
  Volume& operator=(Volume&& other) noexcept {
    if (this == &other) return *this;
    samples = std::exchange(other.samples, {});
    view = std::exchange(other.view, {});
    format = std::exchange(other.format, {});
    warnings = std::exchange(other.warnings, {});
    return *this;
  }
  ~Volume() = default;

  std::vector<std::byte> samples;  ///< dims product × sample size bytes; what view.data points to.
  zmc::VolumeView view;  ///< view.data == samples.data(); dense; direction has unit columns.
  std::string format;    ///< "NIfTI", "NRRD", "MetaImage", "VTI" or "DICOM series".
  std::vector<std::string> warnings;  ///< Sentences for stderr: gantry tilt, uneven slices …
};

}  // namespace shape3d::apps
