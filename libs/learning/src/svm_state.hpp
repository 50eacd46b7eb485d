#pragma once

#include "shape3d/learning/svm.hpp"
#include "svm_machines.hpp"

namespace shape3d::learning {

/// All a trained machine is, in our own memory, and a libsvm model that points to it.
struct Svm::State {
  SvmOptions options;
  Scaling scaling;
  std::vector<int> order;                // labels as libsvm numbers the classes
  std::vector<int> classes;              // ascending
  std::vector<int> counts;               // support vectors of each class of `order`
  Features vectors;                      // support vectors, scaled, class by class
  Features coefficients;                 // #order − 1 by #vectors
  Eigen::VectorXd rho;                   // of each pair
  Eigen::VectorXd sigmoid_a, sigmoid_b;  // of each pair, or empty

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// Takes over what libsvm trained.
  void take(const svm_model& trained);
  /// Points `view` at the members; afterwards they do not change.
  void connect();
  [[nodiscard]] const svm_model* libsvm() const { return &view_; }
  [[nodiscard]] Eigen::Index pairs() const {
    return static_cast<Eigen::Index>(order.size() * (order.size() - 1) / 2);
  }

 private:
  detail::SvmRows rows_;
  std::vector<double*> coefficient_rows_;
  svm_model view_{};
};

}  // namespace shape3d::learning
