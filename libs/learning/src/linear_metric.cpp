#include "shape3d/learning/linear_metric.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <vector>

#include <Eigen/Eigenvalues>

#include "bytes.hpp"
#include "text.hpp"

namespace shape3d::learning {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::uint32_t kVersion = 1;

void require_finite(const FeaturesView& X) {
  if (X.allFinite()) return;
  throw std::invalid_argument("X has a number that is not finite, expected finite ones");
}

// The principal directions of rows without mean, a column each, those of most variance first; their
// number is at most the rank.
MatrixXd principal_directions(const MatrixXd& X, int most) {
  const Index n = X.rows(), d = X.cols();
  const bool by_rows = n < d;
  const MatrixXd square = by_rows ? MatrixXd(X * X.transpose()) : MatrixXd(X.transpose() * X);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(square);
  const VectorXd& values = solver.eigenvalues();
  const double least = values[values.size() - 1] * 1e-12 * static_cast<double>(values.size());
  Index rank = 0;
  for (const double value : values) rank += value > least && value > 0.0 ? 1 : 0;
  if (most > 0) rank = std::min<Index>(rank, most);
  MatrixXd directions(d, rank);
  for (Index k = 0; k < rank; ++k) {
    const Index place = values.size() - 1 - k;
    VectorXd direction = solver.eigenvectors().col(place);
    if (by_rows) direction = X.transpose() * direction / std::sqrt(values[place]);
    // A sign for the same result on every platform: the largest number is positive.
    Index largest = 0;
    direction.cwiseAbs().maxCoeff(&largest);
    directions.col(k) = direction[largest] < 0.0 ? VectorXd(-direction) : direction;
  }
  return directions;
}

// The covariance within classes: the mean over their members of squared distances from their means.
MatrixXd within_covariance(const MatrixXd& Z, const Labels& labels) {
  std::map<int, std::vector<Index>> classes;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] != kUnlabelled) classes[labels[i]].push_back(static_cast<Index>(i));
  }
  MatrixXd W = MatrixXd::Zero(Z.cols(), Z.cols());
  Index freedom = 0;
  for (const auto& [label, rows] : classes) {
    const auto count = static_cast<Index>(rows.size());
    if (count < 2) continue;
    MatrixXd members(count, Z.cols());
    for (Index i = 0; i < count; ++i) members.row(i) = Z.row(rows[static_cast<std::size_t>(i)]);
    members.rowwise() -= members.colwise().mean().eval();
    W.noalias() += members.transpose() * members;
    freedom += count - 1;
  }
  if (freedom == 0) {
    throw std::invalid_argument("labels: no class has two members, expected one at least");
  }
  return W / static_cast<double>(freedom);
}

}  // namespace

LinearMetric learn_linear_metric(const FeaturesView& X, const Labels& labels,
                                 const LinearMetricOptions& options) {
  if (static_cast<Index>(labels.size()) != X.rows()) {
    throw std::invalid_argument("labels has " + std::to_string(labels.size()) +
                                " values, expected " + std::to_string(X.rows()) +
                                ", one for each row of X");
  }
  if (X.rows() < 2) {
    throw std::invalid_argument("X has " + std::to_string(X.rows()) + " rows, expected 2 or more");
  }
  if (options.components < 0) {
    throw std::invalid_argument("components is " + std::to_string(options.components) +
                                ", expected 0 or more");
  }
  detail::require(options.shrinkage > 0.0 && std::isfinite(options.shrinkage), "shrinkage",
                  options.shrinkage, "a number above 0");
  require_finite(X);
  LinearMetric metric;
  metric.mean = X.colwise().mean().transpose();
  const MatrixXd centred = X.rowwise() - metric.mean.transpose();
  const MatrixXd directions = principal_directions(centred, options.components);
  if (directions.cols() == 0) {  // all items are equal
    metric.transform = MatrixXd::Zero(1, X.cols());
    return metric;
  }
  const MatrixXd W = within_covariance(centred * directions, labels);
  const Index k = W.rows();
  const double mean_variance = std::max(W.trace() / static_cast<double>(k), 1e-300);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(W + options.shrinkage * mean_variance *
                                                               MatrixXd::Identity(k, k));
  metric.transform = solver.operatorInverseSqrt() * directions.transpose();
  return metric;
}

LinearMetric principal_components(const FeaturesView& X, int most) {
  if (X.rows() < 1) throw std::invalid_argument("X has 0 rows, expected 1 or more");
  if (most < 0) {
    throw std::invalid_argument("most is " + std::to_string(most) + ", expected 0 or more");
  }
  require_finite(X);
  LinearMetric metric;
  metric.mean = X.colwise().mean().transpose();
  const MatrixXd directions = principal_directions(X.rowwise() - metric.mean.transpose(), most);
  metric.transform = directions.transpose();
  if (directions.cols() == 0) metric.transform = MatrixXd::Zero(1, X.cols());
  return metric;
}

Features LinearMetric::apply(const FeaturesView& X) const {
  if (X.cols() != mean.size()) {
    throw std::invalid_argument("X has " + std::to_string(X.cols()) + " columns, expected " +
                                std::to_string(mean.size()) + " as the metric was learnt from");
  }
  return (X.rowwise() - mean.transpose()) * transform.transpose();
}

std::string LinearMetric::serialize() const {
  detail::ByteWriter writer;
  writer.u32(kVersion);
  writer.vector(mean);
  writer.matrix(transform);
  return writer.finish();
}

LinearMetric LinearMetric::deserialize(std::string_view bytes) {
  detail::ByteReader reader(bytes, "the linear metric");
  const std::uint32_t version = reader.u32();
  if (version != kVersion) {
    throw std::invalid_argument("the linear metric is of version " + std::to_string(version) +
                                ", expected " + std::to_string(kVersion));
  }
  LinearMetric metric;
  metric.mean = reader.vector();
  metric.transform = reader.matrix();
  reader.require(metric.transform.cols() == metric.mean.size(), "its sizes do not fit");
  reader.finish();
  return metric;
}

}  // namespace shape3d::learning
