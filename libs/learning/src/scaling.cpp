#include "shape3d/learning/scaling.hpp"

#include <cmath>

#include "checks.hpp"

namespace shape3d::learning {

Features Scaling::apply(const FeaturesView& X) const {
  detail::require_columns(X, offset.size());
  if (kind == ScalingKind::none) return X;
  return ((X.rowwise() - offset.transpose()).array().rowwise() * factor.transpose().array())
      .matrix();
}

Features Scaling::undo(const FeaturesView& Y) const {
  detail::require_columns(Y, offset.size());
  if (kind == ScalingKind::none) return Y;
  const Eigen::VectorXd inverse = (factor.array() != 0.0).select(factor.cwiseInverse(), 0.0);
  return ((Y.array().rowwise() * inverse.transpose().array()).matrix().rowwise() +
          offset.transpose());
}

Scaling fit_scaling(const FeaturesView& X, ScalingKind kind) {
  detail::require_features(X);
  Scaling scaling;
  scaling.kind = kind;
  scaling.offset = Eigen::VectorXd::Zero(X.cols());
  scaling.factor = Eigen::VectorXd::Ones(X.cols());
  if (kind == ScalingKind::none) return scaling;

  const Eigen::VectorXd least = X.colwise().minCoeff();
  const Eigen::VectorXd largest = X.colwise().maxCoeff();
  if (kind == ScalingKind::range) {
    scaling.offset = 0.5 * least + 0.5 * largest;
    scaling.factor = (0.5 * largest - 0.5 * least).cwiseInverse();
  } else {
    scaling.offset = X.colwise().mean();
    scaling.factor = (X.rowwise() - scaling.offset.transpose())
                         .colwise()
                         .squaredNorm()
                         .transpose()
                         .cwiseQuotient(Eigen::VectorXd::Constant(X.cols(), double(X.rows())))
                         .cwiseSqrt()
                         .cwiseInverse();
  }
  // Constant components; also those that vary by less than can be divided by.
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    if (least(j) == largest(j) || !std::isfinite(scaling.factor(j))) {
      scaling.offset(j) = least(j);
      scaling.factor(j) = 0.0;
    }
  }
  return scaling;
}

}  // namespace shape3d::learning
