#pragma once

#include <vector>

#include "shape3d/learning/clustering.hpp"

namespace shape3d::learning::detail {

/// Means of clusters 0 … count − 1, none of which is empty.
Features centroids_of(const FeaturesView& X, const std::vector<int>& assignment, int count);

/// Numbers clusters as they first occur, and measures them.
Clusters clusters_of(const FeaturesView& X, const std::vector<int>& assignment);

}  // namespace shape3d::learning::detail
