#include "shape3d/learning/weighted_distance.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "text.hpp"

namespace shape3d::learning {
namespace {

void check_probabilities(const char* name, const FeaturesView& P, Eigen::Index rows) {
  if (P.rows() != rows) {
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(P.rows()) +
                                " rows, expected " + std::to_string(rows) + " as D has");
  }
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    // Written so that NaN fails.
    if ((P.row(i).array() >= 0.0).all() && P.row(i).sum() <= 1.0 + 1e-6) continue;
    throw std::invalid_argument("row " + std::to_string(i) + " of " + name +
                                " is no probabilities, expected numbers from 0 whose sum is at "
                                "most 1");
  }
}

}  // namespace

Eigen::MatrixXd class_weighted(const Eigen::Ref<const Eigen::MatrixXd>& D, const FeaturesView& P,
                               const FeaturesView& Q, const ClassWeights& weights) {
  detail::require(weights.same > 0.0 && std::isfinite(weights.same), "same", weights.same,
                  "a number above 0");
  detail::require(weights.other >= weights.same && std::isfinite(weights.other), "other",
                  weights.other, "a number not below same");
  check_probabilities("P", P, D.rows());
  check_probabilities("Q", Q, D.cols());
  if (P.cols() != Q.cols()) {
    throw std::invalid_argument("Q has " + std::to_string(Q.cols()) + " columns, expected " +
                                std::to_string(P.cols()) + " as P has");
  }
  const Eigen::MatrixXd same = P * Q.transpose();
  return (D.array() * (weights.other + (weights.same - weights.other) * same.array())).matrix();
}

Features hard_probabilities(const Labels& labels, int classes) {
  if (classes < 0) {
    throw std::invalid_argument("classes is " + std::to_string(classes) + ", expected 0 or more");
  }
  Features P = Features::Zero(static_cast<Eigen::Index>(labels.size()), classes);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] == kUnlabelled) continue;
    if (labels[i] < 0 || labels[i] >= classes) {
      throw std::invalid_argument("label " + std::to_string(i) + " is " +
                                  std::to_string(labels[i]) + ", expected less than " +
                                  std::to_string(classes) + ", the number of classes");
    }
    P(static_cast<Eigen::Index>(i), labels[i]) = 1.0;
  }
  return P;
}

}  // namespace shape3d::learning
