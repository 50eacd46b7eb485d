#pragma once

#include <memory>
#include <vector>

#include <svm.h>

#include "shape3d/learning/features.hpp"
#include "shape3d/learning/svm.hpp"

namespace shape3d::learning::detail {

/// Rows as libsvm takes them: every component with its index from 1, then the index −1.
class SvmRows {
 public:
  SvmRows() = default;
  explicit SvmRows(const FeaturesView& X);
  SvmRows(SvmRows&&) noexcept = default;
  SvmRows& operator=(SvmRows&&) noexcept = default;

  [[nodiscard]] svm_node* operator[](Eigen::Index i) const {
    return rows_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] svm_node** data() { return rows_.data(); }

 private:
  std::vector<svm_node> nodes_;
  std::vector<svm_node*> rows_;
};

/// What libsvm is told. `weights` are factors of C by label; options.gamma is not 0.
struct SvmParameters {
  SvmParameters(const SvmOptions& options, const std::vector<int>& classes,
                std::vector<double> weights);
  SvmParameters(const SvmParameters&) = delete;
  SvmParameters& operator=(const SvmParameters&) = delete;

  svm_parameter libsvm{};

 private:
  std::vector<int> labels_;
  std::vector<double> weights_;
};

struct DestroySvm {
  void operator()(svm_model* model) const { svm_free_and_destroy_model(&model); }
};
using SvmMachines = std::unique_ptr<svm_model, DestroySvm>;

/// Trains on the rows; they must outlive the machines. Silent.
SvmMachines train_machines(std::vector<svm_node*>& rows, const Labels& labels,
                           const svm_parameter& parameters);

/// Throws std::invalid_argument when an option is out of range.
void require_svm_options(const SvmOptions& options);

/// Labels that occur among those of `members`, ascending, without kUnlabelled.
std::vector<int> classes_of(const Labels& labels, const std::vector<Eigen::Index>& members);

/// Factors of C for `classes` as options.balanced and options.class_weights say.
/// @throws std::invalid_argument  class_weights are too few.
std::vector<double> weights_of_classes(const SvmOptions& options, const Labels& labels,
                                       const std::vector<Eigen::Index>& members,
                                       const std::vector<int>& classes);

/// P(first | decision value f) = 1 / (1 + exp(a f + b)).
struct Sigmoid {
  double a = 0.0, b = 0.0;
};

/// The sigmoid of greatest likelihood for targets that are drawn in from 0 and 1 by Bayes' rule
/// (Platt 2000), by Newton's method with halved steps (Lin, Lin, Weng 2007).
Sigmoid fit_sigmoid(const std::vector<double>& decisions, const std::vector<bool>& is_first);

/// The sigmoid of two classes by decision values of five-fold cross-validation.
/// @param rows      Members of both classes. @param is_first  Whether each is of the first.
/// @param penalties C of the first and of the second class.
Sigmoid pair_sigmoid(const std::vector<svm_node*>& rows, const std::vector<bool>& is_first,
                     const svm_parameter& parameters, double first_weight, double second_weight,
                     std::uint64_t seed);

}  // namespace shape3d::learning::detail
