#pragma once

#include <string>
#include <vector>

#include "shape3d/learning/svm.hpp"

namespace shape3d::learning::detail {

/// What is trained on and what is predicted for one fold.
struct FoldRows {
  std::vector<Eigen::Index> seen;  ///< Rows of other folds that have a label.
  std::vector<Eigen::Index> held;  ///< Rows of this fold, with a label or without.
  std::vector<int> classes;        ///< Of `seen`, ascending.
};

/// By fold, 0 … the largest number.
/// @throws std::invalid_argument  there is not a fold for each row; one is negative; a fold with
/// rows leaves nothing to train on.
std::vector<FoldRows> rows_of_folds(const Labels& labels, const std::vector<int>& folds);

/// The rows of X in this order.
Features rows_of(const FeaturesView& X, const std::vector<Eigen::Index>& rows);

}  // namespace shape3d::learning::detail
