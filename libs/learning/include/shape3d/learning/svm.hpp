#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"
#include "shape3d/learning/scaling.hpp"

namespace shape3d::learning {

enum class SvmKernel {
  rbf,    ///< k(x, y) = exp(−γ ‖x − y‖²)
  linear  ///< k(x, y) = x·y
};

/// Settings of a support vector machine.
struct SvmOptions {
  SvmKernel kernel = SvmKernel::rbf;
  double C = 1.0;      ///< Price of a slack, > 0.
  double gamma = 0.0;  ///< γ, ≥ 0; 0 stands for 1/d. Of rbf alone.
  ScalingKind scaling = ScalingKind::standard;
  bool probabilities = false;  ///< Also fit what Svm::probabilities() needs; six times the cost.
  bool balanced = false;  ///< C of class c times n / (classes · n_c): rare classes count as much.
  /// C of class c times class_weights[c], > 0; empty: 1. Multiplies with `balanced`.
  std::vector<double> class_weights;
  std::uint64_t seed = 1;   ///< Of the folds that probabilities are fitted on.
  double tolerance = 1e-3;  ///< Of the optimality conditions, > 0.
  double cache_mb = 100.0;  ///< Of the kernel matrix, for each thread, > 0.
};

/// A classifier of several classes by support vectors (section 5.3): C-SVC of libsvm, one machine
/// for each pair of classes, each of which gives a vote.
///
/// Copies share what they hold; all functions are const and may be called concurrently.
class SHAPE3D_LEARNING_EXPORT Svm {
 public:
  /// Trains on the rows of X that have a label.
  ///
  /// Scaling is fitted first, then libsvm works as its svm-train does on the scaled rows in their
  /// order: the same machines, bit for bit.
  /// @param threads  0: all processors; for `probabilities` alone. No matter for the result.
  /// @throws std::invalid_argument  sizes do not fit; a number is not finite; fewer than two
  /// classes have members (the message says which); an option is out of range; class_weights is
  /// neither empty nor has a weight for each label. O(n² d) to O(n³).
  [[nodiscard]] static Svm train(const FeaturesView& X, const Labels& labels,
                                 const SvmOptions& options = {}, int threads = 0);

  /// The class of each row: most votes; of equal votes, the class whose first member came first in
  /// training.
  /// @throws std::invalid_argument  X has not dimension() columns; a number is not finite.
  /// O(#X · support vectors · d).
  [[nodiscard]] Labels predict(const FeaturesView& X, int threads = 0) const;

  /// How probable each class is for each row, #X by #classes(): column c is of classes()[c], and
  /// the sum of a row is 1. Platt's sigmoid for each pair, fitted on decision values of five-fold
  /// cross-validation, coupled as Wu, Lin and Weng 2004 do. The most probable class need not be the
  /// predicted one.
  /// @throws std::invalid_argument  as predict(); options().probabilities was false.
  [[nodiscard]] Features probabilities(const FeaturesView& X, int threads = 0) const;

  /// Decision values of the pairs, #X by k (k − 1) / 2: (0, 1), (0, 2) … (k−2, k−1) of order();
  /// positive for the first of the pair.
  [[nodiscard]] Eigen::MatrixXd decision_values(const FeaturesView& X, int threads = 0) const;

  [[nodiscard]] const std::vector<int>& classes() const;  ///< Labels with members, ascending.
  [[nodiscard]] const std::vector<int>& order() const;    ///< The same as they came in training.
  [[nodiscard]] Eigen::Index dimension() const;           ///< d.
  [[nodiscard]] Eigen::Index support_vectors() const;
  [[nodiscard]] const SvmOptions& options() const;  ///< As given, but for gamma, which is never 0.
  [[nodiscard]] const Scaling& scaling() const;

  /// All of it as bytes with a check sum, the same on every platform.
  [[nodiscard]] std::string serialize() const;
  /// @throws std::invalid_argument  the bytes are damaged or not of an SVM.
  [[nodiscard]] static Svm deserialize(std::string_view bytes);

 private:
  struct State;
  explicit Svm(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

/// What cross-validation predicts.
struct SvmPredictions {
  Labels labels;             ///< For each row; kUnlabelled where nothing could be trained.
  std::vector<int> classes;  ///< Labels with members, ascending: the columns of probabilities.
  Features probabilities;  ///< #X by #classes when options.probabilities, else empty. A class that
                           ///< training has not seen has 0.
};

/// Predicts each row by a machine that has seen no row of its fold; scaling is fitted without it,
/// too. Rows that are kUnlabelled are predicted and never trained on. A fold whose other folds hold
/// a single class is given that class, with probability 1.
/// @param folds    The fold of each row, ≥ 0, as stratified_folds() gives them.
/// @param threads  0: all processors. No matter for the result.
/// @throws std::invalid_argument  as Svm::train(); folds do not fit; nothing is left to train on.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT SvmPredictions
cross_validate_svm(const FeaturesView& X, const Labels& labels, const std::vector<int>& folds,
                   const SvmOptions& options = {}, int threads = 0);

}  // namespace shape3d::learning
