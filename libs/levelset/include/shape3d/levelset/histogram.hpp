#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "shape3d/levelset/export.hpp"
#include "shape3d/levelset/image_view.hpp"

namespace shape3d::levelset {

/// Settings of histogram().
struct HistogramOptions {
  /// Largest number of bins, at least 2. Integers get bins of a whole number of values, one if the
  /// range allows; reals get exactly this many.
  int max_bins = 4096;
  /// Samples of this value are padding and left out.
  std::optional<double> padding;
  /// Without `padding`: take the least value for padding when it stands out as a peak. It does when
  /// 1 in 1000 to 1 in 4 of the samples have it, more than 20 times as many as the bins of the 2 %
  /// of the range above it hold on average, and the others are not all equal. Values clipped at the
  /// least that a scanner writes make such a peak, too.
  bool detect_padding = true;
  int threads = 0;  ///< 0: all processors. The result does not depend on it.
};

/// H(u): how often intensities occur.
struct Histogram {
  double lower = 0.0;      ///< Lower edge of bin 0.
  double bin_width = 1.0;  ///< Intensity units.
  Eigen::ArrayXd counts;  ///< Samples in each bin; bin b holds lower + b·bin_width ≤ u < … + 1.
  double minimum = 0.0, maximum = 0.0;  ///< Of the samples counted.
  std::optional<double> padding;        ///< The value left out.
  std::int64_t padding_samples = 0;     ///< How many had it.

  [[nodiscard]] double total() const { return counts.sum(); }
  [[nodiscard]] int bins() const { return static_cast<int>(counts.size()); }
  /// Middle of the values that a bin stands for. For integers in bins of one value: that value.
  [[nodiscard]] double center(int bin) const { return lower + (bin + 0.5) * bin_width; }
  /// Bins that hold a sample.
  [[nodiscard]] int occupied() const { return static_cast<int>((counts > 0.0).count()); }
  /// H(u) normalised: counts / (total · bin_width), of integral 1.
  [[nodiscard]] Eigen::ArrayXd density() const { return counts / (total() * bin_width); }
};

/// Histogram of an image of any sample type, padding left out.
///
/// A bin of integers is centred on its values: with one value a bin, value u lies in the bin
/// [u − ½, u + ½). When nothing but padding is there, `counts` is empty.
///
/// @throws std::invalid_argument  validate(image) fails; max_bins is below 2; threads is negative;
/// a
///         sample is NaN or infinite (the message names the first such voxel).
/// O(samples). Deterministic.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Histogram histogram(const ImageView& image,
                                                          const HistogramOptions& options = {});

}  // namespace shape3d::levelset
