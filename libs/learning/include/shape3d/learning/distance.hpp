#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"

namespace shape3d::learning {

/// Distance of two vectors x, y of n numbers.
enum class Distance {
  L1,           ///< Σ |x_i − y_i|
  L2,           ///< √Σ (x_i − y_i)²
  L2_squared,   ///< Σ (x_i − y_i)²: (5.17)
  chi_squared,  ///< Σ (x_i − y_i)² / (|x_i| + |y_i|); 0 where both are 0. For histograms.
  cosine  ///< 1 − x·y / (‖x‖ ‖y‖), 0 … 2; 1 when one of them is 0, 0 when both are.
};

inline constexpr std::string_view kDistanceNames = "L1, L2, L2_squared, chi_squared or cosine";

/// The name, as in the enumeration.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT std::string_view to_string(Distance distance);
/// By its name; empty for another word.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT std::optional<Distance> distance_named(std::string_view name);

/// Distance of two vectors.
/// @throws std::invalid_argument  they are of different lengths.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT double distance(const Eigen::Ref<const Eigen::VectorXd>& x,
                                                      const Eigen::Ref<const Eigen::VectorXd>& y,
                                                      Distance kind);

/// Distances of each row of X to each row of Y, #X by #Y. Equal rows have distance 0 exactly (but
/// for cosine: rounding), and D of (X, X) is symmetric, bit for bit.
/// @param threads  0: all processors; no matter for the result.
/// @throws std::invalid_argument  X and Y have different numbers of columns; a number is not
/// finite. O(#X #Y n).
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Eigen::MatrixXd distances(const FeaturesView& X,
                                                                const FeaturesView& Y,
                                                                Distance kind, int threads = 0);

}  // namespace shape3d::learning
