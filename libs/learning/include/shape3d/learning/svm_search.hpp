#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"
#include "shape3d/learning/svm.hpp"

namespace shape3d::learning {

/// Values of C and γ that are tried with each other.
struct SvmGrid {
  std::vector<double> C, gamma;  ///< Ascending; gamma has one number, of no meaning, for linear.
};

/// The grid that libsvm's grid.py tries: C = 2^−5, 2^−3 … 2^15 and, for rbf, γ = 2^−15, 2^−13 …
/// 2^3.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT SvmGrid default_svm_grid(SvmKernel kernel);

struct SvmSearch {
  Eigen::MatrixXd correct_rate;  ///< #C by #gamma: share of rows that cross-validation has right.
  double C = 0.0,
         gamma = 0.0;  ///< Of the best; of equal ones the least C, then the least γ. 0: cancelled.
  double best = 0.0;   ///< Its rate.
  bool cancelled = false;  ///< `progress` returned false: all rates are NaN.
};

/// Cross-validates every pair of the grid on the same folds, in threads.
///
/// Rows that are kUnlabelled, and those whose class occurs in no other fold, take no part in the
/// rate: the first have no truth, the second nobody can predict.
/// @param folds     The fold of each row, as stratified_folds() gives them.
/// @param options   C and gamma are those of the grid, probabilities are not fitted.
/// @param progress  Called with the share of machines trained, one call at a time; false cancels.
/// @throws std::invalid_argument  as cross_validate_svm(); a list of the grid is empty or holds
/// what is not positive.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT SvmSearch
search_svm(const FeaturesView& X, const Labels& labels, const std::vector<int>& folds,
           const SvmOptions& options, const SvmGrid& grid, int threads = 0,
           const std::function<bool(double)>& progress = {});

}  // namespace shape3d::learning
