#pragma once

#include <cstdint>
#include <vector>

#include "shape3d/levelset/export.hpp"
#include "shape3d/levelset/histogram.hpp"
#include "shape3d/levelset/image_view.hpp"
#include "shape3d/levelset/intensity_model.hpp"
#include "shape3d/levelset/progress.hpp"

namespace shape3d::levelset {

/// How the overlap of the gradient with the boundaries is measured.
enum class Overlap {
  cosine,  ///< S(w) = Σ |∇|·Y / (‖∇‖₂ ‖Y‖₂): does not reward boundaries for being many.
  product  ///< S(w) = Σ |∇|·Y, (3.8) with the magnitude that is meant; rewards speckle.
};

/// Settings of calibrate().
struct CalibrationOptions {
  Overlap overlap = Overlap::cosine;
  /// ℓ in Y = exp(−(d/ℓ)²), mm; 0: the geometric mean spacing.
  double boundary_width = 0.0;
  /// C of (3.10), brought to the scale of the search: the scope is the share
  /// min(1, C · misfit) of the way from λ = 0 to the least and to the greatest log-odds.
  double scope_constant = 100.0;
  double max_scope =
      0.9;  ///< The scope is no wider, for there Λ ends at the class means; in (0, 1].
  int coarse_samples = 7;  ///< Values of λ in the first pass, odd, at least 3.
  int refinements = 3;     ///< Passes that halve the step around the best; at least 0.
  /// S is summed over about this many samples at most, in bars of 32 × 32 rows along x spread
  /// evenly over the volume; 0: over all.
  std::int64_t max_samples = 1'000'000;
  int threads = 0;  ///< 0: all processors. The result does not depend on it.
  ProgressFunction progress;
};

/// One point of the curve S(w).
struct OverlapSample {
  double lambda = 0.0;   ///< Offset as log-odds.
  double w = 0.0;        ///< Offset of (3.6), −tanh(λ/2).
  double level = 0.0;    ///< The intensity with Λ = λ; NaN when there are several or none.
  double overlap = 0.0;  ///< S.
};

/// Outcome of calibrate().
struct Calibration {
  double lambda = 0.0;         ///< argmax S, with a parabola through the three best samples.
  double w = 0.0;              ///< ŵ (3.9).
  std::vector<double> levels;  ///< Intensities of the boundaries at ŵ.
  double scope = 0.0;          ///< Share of the log-odds range that was searched, 0 … max_scope.
  double scope_w = 0.0;        ///< w_sc (3.10): the largest |w| searched.
  std::vector<OverlapSample> curve;  ///< All samples of S, ascending in λ.
  bool cancelled = false;
};

/// Searches ŵ = argmax S(w), coarse to fine (dissertation, 3.6 to 3.10).
///
/// @param gradient  |∇G_σ ∗ I| on image.grid(): gradient_magnitude().
/// @param misfit    misfit() of the model's mixture, for the scope.
/// @return          λ = w = 0 when the model is not two-sided or no level lies in the scope.
/// @throws std::invalid_argument  validate(image) fails, sizes differ, an option is out of range.
/// O(samples) for each value of w; working memory 8 bytes a sample.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Calibration calibrate(const ImageView& image,
                                                            const Field& gradient,
                                                            const IntensityModel& model,
                                                            double misfit,
                                                            const CalibrationOptions& options = {});

/// d(x, w) of (3.7), signed: distance in mm to {Λ(I(x)) = λ}, negative inside (Λ > λ), 0 at
/// samples on it, ±`limit` where it is farther.
///
/// The boundary is placed between samples by linear interpolation of intensity. Beside it the
/// distance is that to the plane through the crossings on the lattice edges (to the nearest
/// crossing where the object is one sample thin); from there the eikonal equation is solved to
/// first order.
/// @throws std::invalid_argument  validate(image) fails; limit is not positive and finite.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Field boundary_distance(const ImageView& image,
                                                              const IntensityModel& model,
                                                              double lambda, double limit,
                                                              int threads = 0);

/// Y = exp(−(d/ℓ)²) of (3.7), 0 beyond d = 3.1ℓ, where it is under 7e-5.
/// @param boundary_width  ℓ in mm, positive.
/// @throws as boundary_distance().
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Field boundary_detector(const ImageView& image,
                                                              const IntensityModel& model,
                                                              double lambda, double boundary_width,
                                                              int threads = 0);

}  // namespace shape3d::levelset
