#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "shape3d/levelset/calibration.hpp"
#include "shape3d/levelset/evolve.hpp"
#include "shape3d/levelset/export.hpp"
#include "shape3d/levelset/front.hpp"
#include "shape3d/levelset/gradient.hpp"
#include "shape3d/levelset/histogram.hpp"
#include "shape3d/levelset/intensity_model.hpp"
#include "shape3d/levelset/mixture.hpp"
#include "shape3d/levelset/speed.hpp"
#include "shape3d/levelset/status.hpp"

namespace shape3d::levelset {

/// Settings of segment(). `threads` and `progress` here take the place of those of the stages.
struct SegmentOptions {
  SegmentOptions() { evolution.coarse_levels = 2; }

  HistogramOptions histogram;
  MixtureOptions mixture;
  /// When it has classes: taken in place of an estimate, for example local_mixture().
  GaussianMixture known_mixture;
  InsideOptions inside;
  double sigma = 0.0;  ///< σ of the gradient, mm; 0: one spacing along each axis.
  /// σ of a Gaussian that the intensities are smoothed with first, in voxels (of each axis); 0:
  /// none. Negative: chosen by the noise n, noise_deviation(), and the distance D of the mean
  /// intensities of the two sides: the least after which the noise is D/6, so that the half way
  /// between the sides is three deviations from each and one sample in 740 is on the wrong side;
  /// 0 while n ≤ D/6, at most 1.5. Less would leave specks; more takes away what is thin.
  double smoothing = -1.0;
  bool calibrated = true;  ///< false: w = 0 also with Method::combined, to show what it is for.
  CalibrationOptions calibration;
  SpeedOptions speed;
  EvolveOptions evolution;
  int threads = 0;
  ProgressFunction progress;
};

/// Wall-clock seconds by stage.
struct SegmentTimings {
  double histogram = 0.0, mixture = 0.0, smoothing = 0.0, gradient = 0.0, calibration = 0.0,
         speed = 0.0, evolution = 0.0;
  /// All before the evolution.
  [[nodiscard]] double estimation() const {
    return histogram + mixture + smoothing + gradient + calibration + speed;
  }
};

/// All that segment() found on its way.
struct Segmentation {
  Status status = Status::iteration_limit;
  std::vector<std::string> warnings;  ///< Sentences, for example on spacings over 20 : 1.
  Histogram histogram;                ///< H.
  MixtureFit fit;                     ///< P.
  IntensityModel model;               ///< P_in, P_out.
  double noise = 0.0;                 ///< noise_deviation() of the image.
  double smoothing = 0.0;             ///< σ used, voxels.
  Calibration calibration;            ///< ŵ, S(w).
  double gradient_scale = 0.0;        ///< g of k_I.
  Evolution evolution;                ///< ψ on image.grid(), front statistics.
  std::int64_t inside = 0;            ///< Nodes with ψ ≤ 0.
  double volume = 0.0;                ///< mm³: inside · hx·hy·hz.
  SegmentTimings timings;

  /// 1 where ψ ≤ 0, else 0; x fastest.
  [[nodiscard]] SHAPE3D_LEVELSET_EXPORT Eigen::Array<std::uint8_t, -1, 1> labels() const;
};

/// The whole of chapter 3 on a region of interest: histogram, mixture, model, gradient,
/// calibration, speed, evolution.
///
/// @param image  The region of interest: subvolume() of a larger image.
/// @param start  ψ at the start, for example sphere_front(); empty: the box of the region, with
///               Border::outside whatever the options say.
/// @return       A status before the evolution (constant_image, too_few_bins, one_sided, cancelled)
///               leaves what comes after it empty.
/// @throws std::invalid_argument  as the stages do: an invalid view or option, a sample that is not
///         finite, a start of the wrong size or with no node inside.
/// Peak memory beside the image: 20 bytes a sample (24 with curvature or smoothing).
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Segmentation segment(const ImageView& image,
                                                           const SegmentOptions& options = {},
                                                           const Field& start = {});

}  // namespace shape3d::levelset
