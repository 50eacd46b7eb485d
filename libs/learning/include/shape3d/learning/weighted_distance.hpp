#pragma once

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"

namespace shape3d::learning {

/// Weights of the class-weighted distance (5.19).
struct ClassWeights {
  double same = 0.25;  ///< For items of the same class; > 0.
  double other = 1.0;  ///< For items of different classes; ≥ same.
};

/// Class-weighted distance (5.19): W_ij D_ij,
/// W_ij = other + (same − other) Σ_c P_ic Q_jc,
/// where P_ic is how probable it is that item i is of class c: the weight expected when classes are
/// drawn by these numbers. With predicted classes (rows of one 1, hard_probabilities()) it is
/// `same` or `other`. What is known of items must come from a classifier that has not seen their
/// labels.
/// @param D  #P by #Q distances, ≥ 0. @param P  #P by classes. @param Q  #Q by classes.
/// @throws std::invalid_argument  sizes do not fit; weights are out of range; a row of P or Q has a
/// number outside 0 … 1, or a sum above 1 + 1e-6 (a sum below 1 leaves room for other classes).
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Eigen::MatrixXd class_weighted(
    const Eigen::Ref<const Eigen::MatrixXd>& D, const FeaturesView& P, const FeaturesView& Q,
    const ClassWeights& weights = {});

/// A row for each label: 1 at the label, 0 elsewhere; zeros for kUnlabelled.
/// @throws std::invalid_argument  a label is not below `classes`.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Features hard_probabilities(const Labels& labels,
                                                                  int classes);

}  // namespace shape3d::learning
