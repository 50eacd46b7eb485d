#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "volume.hpp"

namespace shape3d::apps {

/// What a volume holds.
struct VolumeDescription {
  std::string format;
  std::array<std::int64_t, 3> dims{0, 0, 0};
  zmc::SampleType type = zmc::SampleType::float32;
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();
  std::uint64_t finite = 0;      ///< Samples that are finite numbers.
  std::uint64_t non_finite = 0;  ///< NaN and infinities; finite + non_finite = product of dims.
  double minimum = 0.0;  ///< Of the finite samples; 0 when there are none, as the two below.
  double maximum = 0.0;
  double mean = 0.0;
  /// Counts of finite samples in bins of equal width: bin b holds lower + b·width ≤ v < lower +
  /// (b+1)·width, the last also its upper end. Integers of fewer than kBins values have a bin for
  /// each, centred at it (lower = minimum − ½, width 1); other bins begin at the minimum and end at
  /// the maximum. A constant has one bin. Empty without finite samples.
  std::vector<std::uint64_t> histogram;
  double histogram_lower = 0.0;
  double histogram_width = 0.0;

  static constexpr int kBins = 32;
};

/// Two passes over the samples. The mean is summed in extended precision, row by row.
[[nodiscard]] VolumeDescription describe_volume(const Volume& volume);

}  // namespace shape3d::apps
