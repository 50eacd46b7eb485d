#pragma once

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"

namespace shape3d::learning {

enum class ScalingKind {
  none,     ///< x
  range,    ///< To [−1, 1]: 2 (x − min) / (max − min) − 1.
  standard  ///< (x − mean) / σ, σ² = Σ (x − mean)² / n.
};

/// A scaling of each component by numbers learnt from a training set and kept with what was
/// trained: y_j = (x_j − offset_j) factor_j. A component that is constant in the training set says
/// nothing of it: its factor is 0.
struct Scaling {
  ScalingKind kind = ScalingKind::none;
  Eigen::VectorXd offset, factor;  ///< d numbers each.

  /// @throws std::invalid_argument  X has not d columns.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT Features apply(const FeaturesView& X) const;
  /// The x of a y; constant components are `offset`.
  /// @throws std::invalid_argument  Y has not d columns.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT Features undo(const FeaturesView& Y) const;
};

/// @throws std::invalid_argument  X has no rows or no columns; a number is not finite.
/// O(n d).
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Scaling fit_scaling(const FeaturesView& X, ScalingKind kind);

}  // namespace shape3d::learning
