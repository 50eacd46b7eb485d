#pragma once

#include "shape3d/learning/features.hpp"

namespace shape3d::learning::detail {

/// Throws std::invalid_argument "X has no rows…" or "row 3, column 4 of X is nan…": rows and
/// columns from 0.
void require_features(const FeaturesView& X);

/// Throws std::invalid_argument "X has 44 columns, expected 45" unless X has `columns`; then as
/// above for numbers. No rows are allowed.
void require_columns(const FeaturesView& X, Eigen::Index columns);

/// Throws std::invalid_argument unless there is a label for each row, none below kUnlabelled.
void require_labels(const Labels& labels, Eigen::Index rows);

}  // namespace shape3d::learning::detail
