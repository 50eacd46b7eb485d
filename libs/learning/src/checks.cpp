#include "checks.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "text.hpp"

namespace shape3d::learning::detail {
namespace {

void require_finite(const FeaturesView& X) {
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    if (X.row(i).allFinite()) continue;
    Eigen::Index j = 0;
    while (std::isfinite(X(i, j))) ++j;
    throw std::invalid_argument("row " + std::to_string(i) + ", column " + std::to_string(j) +
                                " of X is " + number(X(i, j)) + ", expected a finite number");
  }
}

}  // namespace

void require_features(const FeaturesView& X) {
  if (X.rows() == 0 || X.cols() == 0) {
    throw std::invalid_argument("X has " + std::to_string(X.rows()) + " rows and " +
                                std::to_string(X.cols()) + " columns, expected at least 1 of each");
  }
  require_finite(X);
}

void require_columns(const FeaturesView& X, Eigen::Index columns) {
  if (X.cols() != columns) {
    throw std::invalid_argument("X has " + std::to_string(X.cols()) + " columns, expected " +
                                std::to_string(columns));
  }
  require_finite(X);
}

void require_labels(const Labels& labels, Eigen::Index rows) {
  if (static_cast<Eigen::Index>(labels.size()) != rows) {
    throw std::invalid_argument("there are " + std::to_string(labels.size()) +
                                " labels, expected one for each of " + std::to_string(rows) +
                                " rows");
  }
  for (const int label : labels) require(label >= kUnlabelled, "a label", label, "-1 or more");
}

}  // namespace shape3d::learning::detail
