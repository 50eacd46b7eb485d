#pragma once

#include <optional>

#include "shape3d/levelset/export.hpp"
#include "shape3d/levelset/image_view.hpp"
#include "shape3d/levelset/intensity_model.hpp"

namespace shape3d::levelset {

/// What stops the front.
enum class Method {
  combined,  ///< k from k_I and k_P by the fuzzy table, F_A at the calibrated ŵ (Figs. 3.3, 3.6c).
  intensity,  ///< k = 1, F_A at w = 0: intensity statistics alone (Figs. 3.1, 3.6a).
  gradient    ///< k = k_I, F_A = −1 (the front shrinks) or +1: gradient alone (3.2).
};

/// Settings of make_speed().
struct SpeedOptions {
  Method method = Method::combined;
  double exponent = 2.0;  ///< m of k_I = 1 / (1 + (|∇|/g)^m); positive.
  /// g is this quantile of the gradient: the noise of flat regions then has k_I near 1. In (0, 1).
  double gradient_quantile = 0.95;
  double boundary_width = 0.0;  ///< ℓ of k_P = 1 − exp(−(d/ℓ)²), mm; 0: the geometric mean spacing.
  double direction = -1.0;   ///< F_A of Method::gradient: −1 shrinks, +1 expands.
  double min_factor = 0.05;  ///< k is at least this, so that no front is stuck for ever; in [0, 1].
  int threads = 0;           ///< 0: all processors. The result does not depend on it.
};

/// F = k·(F_A + F_G) without its geometric part F_G.
struct Speed {
  Field advance;  ///< k·F_A, in [−1, 1]: positive expands the inside, one mm per unit of time at 1.
  Field factor;  ///< k, in [0, 1]: scales curvature. Empty when not asked for: all 1.
  double gradient_scale = 0.0;  ///< g, intensity per mm.
};

/// The fuzzy combination of two factors, each in [0, 1].
///
/// Membership: high(k) = 3k² − 2k³ (a smooth step), low(k) = 1 − high(k). A rule holds as far as
/// both of its premises do (the lesser membership); the result is the mean of the conclusions,
/// weighted by how far their rules hold:
///   k_I low,  k_P low  → 0       k_I low,  k_P high → ½
///   k_I high, k_P low  → ½       k_I high, k_P high → 1
/// The dissertation gives no membership functions; these make the result 0 where both are 0, 1
/// where both are 1, ½ where they contradict each other outright, and rising in both.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT float fuzzy_factor(float gradient_factor,
                                                         float boundary_factor);

/// k_I = 1 / (1 + (|∇|/scale)^m).
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT float gradient_factor(float magnitude, float scale,
                                                            float exponent);

/// The q-quantile of a non-negative field, to 1/1024 of its maximum; 0 for a field of zeros.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT double quantile(const Field& field, double q);

/// Speed at every node.
///
/// F_A = tanh((Λ(I) − λ)/2): −φ of (3.6) with the offset applied to the log-odds. It has the zeros
/// and the sign of −φ(x, ŵ), and is equal to it at w = 0; with w near ±1, −φ itself would let one
/// of the two directions crawl.
///
/// @param gradient  |∇G_σ ∗ I|; may be empty for Method::intensity.
/// @param lambda    Calibration::lambda; ignored (0) by Method::intensity.
/// @param factor    Also give k (for curvature).
/// @throws std::invalid_argument  validate(image) fails; sizes differ; an option is out of range; a
///         sample is not finite; the model is not two-sided (but for Method::gradient).
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Speed make_speed(const ImageView& image,
                                                       const Field& gradient,
                                                       const IntensityModel& model, double lambda,
                                                       bool factor,
                                                       const SpeedOptions& options = {});

}  // namespace shape3d::levelset
