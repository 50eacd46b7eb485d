#pragma once

#include <vector>

#include <Eigen/Core>

#include "shape3d/levelset/export.hpp"
#include "shape3d/levelset/mixture.hpp"

namespace shape3d::levelset {

/// Which classes of the mixture are inside Ω.
enum class Inside {
  bright,  ///< Those above the gap between means that separates the mixture best (Otsu's
           ///< criterion on the classes: largest variance between the two groups).
  dark,    ///< Those below it.
  classes  ///< The ones listed.
};

/// Settings of make_intensity_model().
struct InsideOptions {
  Inside inside = Inside::bright;
  std::vector<int> classes;  ///< For Inside::classes: numbers from 0 in the order of the means.
};

/// P_in and P_out of (3.4), and what follows from them.
///
/// With the posteriors p_in = P_in / (P_in + P_out), p_out = 1 − p_in, the classifier of (3.6) is
///   φ(u, w) = p_out(u) − p_in(u) − w = −tanh(Λ(u)/2) − w,   Λ(u) = ln P_in(u) − ln P_out(u).
/// φ(u, w) = 0 is the same as Λ(u) = λ with w = −tanh(λ/2): the offset is kept as λ, for w reaches
/// ±1 in double while λ is still of use.
/// Λ is held constant below the least and above the greatest mean, where the tails of a Gaussian
/// say nothing, and a class is given at least 1/16 of the largest variance when Λ is formed.
class SHAPE3D_LEVELSET_EXPORT IntensityModel {
 public:
  IntensityModel() = default;
  /// @param inside  One flag a class.
  IntensityModel(GaussianMixture mixture, std::vector<bool> inside);

  [[nodiscard]] const GaussianMixture& mixture() const { return mixture_; }
  [[nodiscard]] const std::vector<bool>& inside() const { return inside_; }
  /// Classes on both sides.
  [[nodiscard]] bool two_sided() const;
  /// The classes inside are all those above some class, or all those below one: Λ is monotone, and
  /// a boundary has one intensity.
  [[nodiscard]] bool is_split() const;

  [[nodiscard]] double density_inside(double u) const;   ///< P_in(u).
  [[nodiscard]] double density_outside(double u) const;  ///< P_out(u).
  [[nodiscard]] double log_odds(double u) const;         ///< Λ(u).
  [[nodiscard]] double phi(double u, double w) const;    ///< φ(u, w).

  /// Intensities u between the outer means with Λ(u) = λ, ascending: the boundaries E(x, w) lie
  /// there. Found on a table of 4096 steps, linear between.
  [[nodiscard]] std::vector<double> levels(double lambda) const;
  /// Least and greatest value of Λ.
  [[nodiscard]] double min_log_odds() const { return min_log_odds_; }
  [[nodiscard]] double max_log_odds() const { return max_log_odds_; }
  /// Signed distance in intensity from u to the nearest level, positive inside (Λ > λ); beyond all
  /// levels it goes on. When there is no level: ±∞ by the sign of Λ − λ.
  [[nodiscard]] double signed_level_distance(double u, const std::vector<double>& levels,
                                             double lambda) const;

 private:
  GaussianMixture mixture_;
  std::vector<bool> inside_;
  Eigen::ArrayXd table_;  // Λ at equal steps from the least to the greatest mean
  double min_log_odds_ = 0.0, max_log_odds_ = 0.0;
};

/// w = −tanh(λ/2).
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT double offset_of_log_odds(double lambda);

/// Chooses the classes inside. A model of one class, or with all classes on one side, is made all
/// the same: two_sided() is false.
/// @throws std::invalid_argument  the mixture is empty; a class number is out of range or given
/// twice.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT IntensityModel
make_intensity_model(const GaussianMixture& mixture, const InsideOptions& options = {});

}  // namespace shape3d::levelset
