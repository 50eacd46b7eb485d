#pragma once

#include "shape3d/levelset/export.hpp"
#include "shape3d/levelset/image_view.hpp"

namespace shape3d::levelset {

/// |∇G_σ ∗ I| in intensity per millimetre: derivatives of a Gaussian along each axis.
///
/// Kernels are sampled, cut at 3σ, and scaled so that constants have gradient 0 and linear ramps
/// their slope exactly. Along an axis σ is at least 0.6 of the spacing: a narrower kernel would not
/// be sampled. Beyond the border samples repeat.
///
/// @param sigma  mm; 0: one spacing along each axis.
/// @param threads  0: all processors. The result does not depend on it.
/// @throws std::invalid_argument  validate(image) fails; sigma is negative, not finite, or wider
/// than
///         32 spacings; threads is negative; a sample is not finite.
/// O(samples · σ / spacing).
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Field gradient_magnitude(const ImageView& image,
                                                               double sigma = 0.0, int threads = 0);

/// G_σ ∗ I, by the same kernels. For images whose noise is large beside the difference of the
/// classes.
/// @param sigma  mm, σ of the Gaussian; on an axis where it is below 0.3 spacings nothing is done.
/// @throws as gradient_magnitude().
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Field smooth(const ImageView& image, double sigma,
                                                   int threads = 0);

/// What smooth() along one axis leaves of the standard deviation of white noise: √Σ g² of the
/// sampled kernel, about (2√π σ)^(−½); 1 below 0.3. By three axes: its cube.
/// @param sigma  In spacings.
/// @throws std::invalid_argument  sigma is negative, not finite or above 32.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT double noise_gain(double sigma);

/// Standard deviation of white noise: the median absolute value of I(i−1) − 2·I(i) + I(i+1) along
/// x, divided by 0.6745·√6, the ratio for Gaussian noise. Edges hardly change a median.
/// @throws std::invalid_argument  validate(image) fails; a sample is not finite.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT double noise_deviation(const ImageView& image,
                                                             int threads = 0);

}  // namespace shape3d::levelset
