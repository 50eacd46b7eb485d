#include "shape3d/learning/fusion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "text.hpp"

namespace shape3d::learning {
namespace {

void require_square(const Eigen::Ref<const Eigen::MatrixXd>& D) {
  if (D.rows() == D.cols()) return;
  throw std::invalid_argument("D is " + std::to_string(D.rows()) + " by " +
                              std::to_string(D.cols()) + ", expected as many rows as columns");
}

}  // namespace

double mean_distance(const Eigen::Ref<const Eigen::MatrixXd>& D) {
  require_square(D);
  const auto n = static_cast<double>(D.rows());
  return n < 2.0 ? 0.0 : (D.sum() - D.trace()) / (n * (n - 1.0));
}

Eigen::MatrixXd fused(const std::vector<FusionPart>& parts) {
  if (parts.empty()) throw std::invalid_argument("there are 0 parts, expected 1 or more");
  double weights = 0.0;
  for (const FusionPart& part : parts) {
    if (part.D.rows() != parts.front().D.rows() || part.D.cols() != parts.front().D.cols()) {
      throw std::invalid_argument("a part is " + std::to_string(part.D.rows()) + " by " +
                                  std::to_string(part.D.cols()) + ", expected " +
                                  std::to_string(parts.front().D.rows()) + " by " +
                                  std::to_string(parts.front().D.cols()) + " as the first");
    }
    detail::require(part.unit >= 0.0 && std::isfinite(part.unit), "unit", part.unit, "0 or more");
    detail::require(part.weight >= 0.0 && std::isfinite(part.weight), "weight", part.weight,
                    "0 or more");
    weights += part.weight;
  }
  detail::require(weights > 0.0, "sum of weights", weights, "more than 0");
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(parts.front().D.rows(), parts.front().D.cols());
  for (const FusionPart& part : parts) {
    if (part.unit > 0.0) D += (part.weight / (weights * part.unit)) * part.D;
  }
  return D;
}

Eigen::MatrixXd locally_scaled(const Eigen::Ref<const Eigen::MatrixXd>& D, int k) {
  require_square(D);
  if (k < 1) throw std::invalid_argument("k is " + std::to_string(k) + ", expected 1 or more");
  const Eigen::Index n = D.rows();
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<double> row;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (j != i && std::isfinite(D(i, j))) row.push_back(D(i, j));
    }
    const std::size_t nearest = std::min(static_cast<std::size_t>(k), row.size());
    if (nearest == 0) continue;
    std::partial_sort(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(nearest), row.end());
    double sum = 0.0;
    for (std::size_t j = 0; j < nearest; ++j) sum += row[j];
    scale[i] = std::sqrt(sum / static_cast<double>(nearest));
  }
  // An item with k copies has no unit of its own: the smallest of the others is taken.
  double least = 1.0;
  bool found = false;
  for (const double s : scale) {
    if (s > 0.0 && (!found || s < least)) least = s, found = true;
  }
  for (double& s : scale) {
    if (s == 0.0) s = least;
  }
  return D.cwiseQuotient(scale * scale.transpose());
}

}  // namespace shape3d::learning
