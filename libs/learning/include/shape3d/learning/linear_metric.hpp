#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"

namespace shape3d::learning {

struct LinearMetricOptions {
  /// Largest number of principal components that are looked at; 0: as many as there are.
  int components = 100;
  /// Share of the mean variance that is added to the spread within classes; > 0. The larger, the
  /// nearer is the metric to that of the principal components themselves, and the less it depends
  /// on which classes it was learnt from.
  double shrinkage = 1.0;
};

/// A linear map after which the Euclidean distance tells classes apart.
struct LinearMetric {
  Eigen::VectorXd mean;       ///< n.
  Eigen::MatrixXd transform;  ///< k by n; y = transform (x − mean).

  /// A row for each row of X. @throws std::invalid_argument  X has not n columns.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT Features apply(const FeaturesView& X) const;

  /// Bytes with a version and a check sum, little endian, the same on every platform.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT std::string serialize() const;
  /// @throws std::invalid_argument  they are not of a metric, of another version, or damaged.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT static LinearMetric deserialize(std::string_view bytes);
};

/// Regularised discriminant analysis: with T the covariance of all items and W that within classes
/// (in the first principal components, each class by its size), y = (W + s t I)^{-1/2} (x − mean),
/// t the mean eigenvalue of W. All directions stay: those in which members of one class vary are
/// made short, so that the metric also serves for classes that it has not seen.
/// Items with kUnlabelled count for the mean and the components alone.
/// @throws std::invalid_argument  sizes do not fit; fewer than two items; no class has two members;
/// options are out of range; a number is not finite.
/// O(min(#X, n)² max(#X, n)).
[[nodiscard]] SHAPE3D_LEARNING_EXPORT LinearMetric learn_linear_metric(
    const FeaturesView& X, const Labels& labels, const LinearMetricOptions& options = {});

/// Principal components as a linear map: y = E^T (x − mean), the columns of E the directions of
/// most variance, at most `most` of them and at most the rank; 0: all.
/// @throws std::invalid_argument  X has no row; a number is not finite; `most` is negative.
/// O(min(#X, n)² max(#X, n)).
[[nodiscard]] SHAPE3D_LEARNING_EXPORT LinearMetric principal_components(const FeaturesView& X,
                                                                        int most);

}  // namespace shape3d::learning
