#pragma once

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"

namespace shape3d::learning {

/// How often items of a class were taken for items of another.
struct Confusion {
  Eigen::MatrixXi counts;  ///< classes by classes: row the true class, column the predicted one.

  [[nodiscard]] SHAPE3D_LEARNING_EXPORT int total() const;
  /// Correct classification rate: the share of the diagonal; 0 when there is no item.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT double correct_rate() const;
  /// The mean over classes with items of the share of each that is right; 0 when there is no item.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT double balanced_rate() const;
  /// The share of the largest true class: what it takes to say always the same.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT double majority_rate() const;
};

/// Items whose truth is kUnlabelled are passed over.
/// @param classes  Their number.
/// @throws std::invalid_argument  lengths differ; a label is not below `classes`; a prediction is
/// kUnlabelled.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Confusion confusion(const Labels& truth,
                                                          const Labels& predicted, int classes);

/// McNemar's exact test of two classifiers on the same items.
struct PairedTest {
  int first_only = 0;   ///< Items that only the first has right.
  int second_only = 0;  ///< Items that only the second has right.
  double p = 1.0;  ///< Two-sided: how probable so unequal a division is between equal classifiers.
};

/// @throws std::invalid_argument  lengths differ.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT PairedTest paired_test(const Labels& truth,
                                                             const Labels& first,
                                                             const Labels& second);

}  // namespace shape3d::learning
