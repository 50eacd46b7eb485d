#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <shape3d/zmc/volume_view.hpp>

namespace shape3d::apps {

/// A volume in memory with its place in the patient: samples x fastest, world LPS, millimetres.
struct Volume {
  std::vector<std::byte> samples;     ///< dims product × sample size bytes; owns what view.data points to.
  zmc::VolumeView view;               ///< view.data == samples.data(); dense.
  std::string format;                 ///< "NIfTI", "NRRD", "MetaImage", "VTI", "DICOM series".
  std::vector<std::string> warnings;  ///< Sentences for stderr: gantry tilt, values rescaled …
};

}  // namespace shape3d::apps
