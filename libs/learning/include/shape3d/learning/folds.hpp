#pragma once

#include <cstdint>
#include <vector>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"

namespace shape3d::learning {

/// Divides items into folds for cross-validation so that each class is spread as evenly as can be:
/// of c items of a class every fold has ⌊c/k⌋ or ⌈c/k⌉, and the sizes of two folds differ by at
/// most one. A class of fewer than k items is missing from some folds.
///
/// @param labels  One for each item; kUnlabelled is a class like the others.
/// @param k       Number of folds, 2 … #labels.
/// @param seed    The same seed gives the same folds on every platform.
/// @return        The fold of each item, 0 … k − 1.
/// @throws std::invalid_argument  k is out of range; a label is below kUnlabelled.
/// O(n log n).
[[nodiscard]] SHAPE3D_LEARNING_EXPORT std::vector<int> stratified_folds(const Labels& labels, int k,
                                                                        std::uint64_t seed);

/// Divides items into folds by group (a class, a subject, a file): all items of a group are in one
/// fold, so that no group is seen both in training and in testing. The largest groups are dealt
/// first, each to the fold that has the fewest items; groups of equal size are in seeded order.
///
/// @param groups  The group of each item: any numbers.
/// @param k       Number of folds, 2 … number of groups.
/// @return        The fold of each item, 0 … k − 1.
/// @throws std::invalid_argument  k is out of range.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT std::vector<int> grouped_folds(const std::vector<int>& groups,
                                                                     int k, std::uint64_t seed);

}  // namespace shape3d::learning
