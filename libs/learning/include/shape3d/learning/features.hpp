#pragma once

#include <vector>

#include <Eigen/Core>

namespace shape3d::learning {

/// Feature vectors, one item a row: #X by d.
using Features = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
/// A view of feature vectors; binds to Features, to its row blocks and to maps without a copy.
using FeaturesView = Eigen::Ref<const Features>;

/// The class of each item, 0, 1, 2 …; what a number means is the caller's.
using Labels = std::vector<int>;
/// The label of an item of no known class.
inline constexpr int kUnlabelled = -1;

}  // namespace shape3d::learning
