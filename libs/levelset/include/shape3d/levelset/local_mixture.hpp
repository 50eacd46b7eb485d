#pragma once

#include <Eigen/Core>

#include "shape3d/levelset/export.hpp"
#include "shape3d/levelset/histogram.hpp"
#include "shape3d/levelset/image_view.hpp"
#include "shape3d/levelset/mixture.hpp"

namespace shape3d::levelset {

/// Settings of local_mixture().
struct LocalMixtureOptions {
  double radius = 0.0;  ///< Of the ball in the object, mm; 0: twice the geometric mean spacing.
  bool dark = false;    ///< The object is darker than what is round it.
  HistogramOptions histogram;
  int threads = 0;  ///< 0: all processors. The result does not depend on it.
};

/// Two classes for an object at a known place, where a mixture of the whole region would describe
/// larger structures: ground glass between lung and vessels, a nodule in a small box.
///
/// The object has the median of the samples in a ball round the seed, that nearest to it among
/// them. What is round it has the most frequent intensity beyond the half way between the two, the
/// histogram being smoothed by a Gaussian of the noise: the fixed point, from the least (for a dark
/// object the greatest) intensity on. Weights are ½ and both deviations the greatest of the noise
/// and a sixteenth of the distance of the means, so that Λ = 0 half way, where a boundary between
/// two plateaus lies under any symmetric blur.
///
/// @param image  The region round the object: box of a few times its size.
/// @param seed   In samples of the image.
/// @return       Classes by mean. Empty when the object does not stand out by more than the noise.
/// @throws std::invalid_argument  validate(image) fails; the seed is outside the image; the radius
///         is negative or not finite; a sample is not finite.
/// O(samples).
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT GaussianMixture local_mixture(
    const ImageView& image, const Eigen::Vector3d& seed, const LocalMixtureOptions& options = {});

}  // namespace shape3d::levelset
