#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"

namespace shape3d::learning {

/// A division into clusters.
struct Clusters {
  std::vector<int> assignment;  ///< The cluster of each row, 0 … count − 1, numbered as they first
                                ///< occur.
  Features centroids;    ///< count by d, the mean of each.
  double scatter = 0.0;  ///< Σ ‖x − centroid‖².
  [[nodiscard]] int count() const { return static_cast<int>(centroids.rows()); }
};

/// k-means (Lloyd) from seeded starts by k-means++, the best of `starts`. No cluster is empty: one
/// that runs empty takes the item that is farthest from its centroid.
/// @param k  1 … number of different rows; fewer clusters are not given.
/// @throws std::invalid_argument  k or starts is out of range; a number is not finite.
/// O(starts · iterations · n k d).
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Clusters kmeans(const FeaturesView& X, int k,
                                                      std::uint64_t seed, int starts = 10);

/// How far clusters lie apart and how close their items are, the less the better (Davies and
/// Bouldin 1979): 1/k Σ_i max_{j ≠ i} (S_i + S_j) / ‖c_i − c_j‖, S_i the mean distance of items to
/// their centroid. Infinite when two centroids coincide.
/// @throws std::invalid_argument  fewer than two clusters; there is not a cluster for each row.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT double davies_bouldin(const FeaturesView& X,
                                                            const Clusters& clusters);

/// k-means for each number of clusters, and the one of least Davies–Bouldin index: how Vesanto and
/// Alhoniemi 2000 cluster the prototypes of a map.
struct ClusterChoice {
  Clusters clusters;
  std::vector<double> index;  ///< Davies–Bouldin of 2, 3 … `most` clusters.
};

/// @param most  Largest number tried, 2 … number of different rows; 0 stands for √n, at least 2.
/// @throws std::invalid_argument  most is out of range; fewer than two different rows.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT ClusterChoice kmeans_by_davies_bouldin(const FeaturesView& X,
                                                                             int most,
                                                                             std::uint64_t seed,
                                                                             int starts = 10);

/// Distance of two clusters.
enum class Linkage {
  single,    ///< Of their nearest items.
  complete,  ///< Of their farthest items.
  average,   ///< Mean over the pairs of items.
  ward       ///< √(2 n m / (n + m)) ‖c − c'‖, by which the scatter grows least.
};

/// One step: two clusters become one.
struct Merge {
  int first = 0, second = 0;  ///< Items 0 … n − 1; n + s is the cluster of step s. first < second.
  double height = 0.0;        ///< Their distance.
};

/// Agglomerative clustering of all items, n − 1 steps of ascending height; of equal distances the
/// pair of lower numbers (of their lowest items) first.
/// @throws std::invalid_argument  there is no row; a number is not finite.
/// O(n³) at worst, n² distances of memory.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT std::vector<Merge> agglomerate(const FeaturesView& X,
                                                                     Linkage linkage);

/// The tree cut so that k clusters are left.
/// @throws std::invalid_argument  k is not 1 … n; merges are not those of X.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Clusters cut_tree(const FeaturesView& X,
                                                        const std::vector<Merge>& merges, int k);

}  // namespace shape3d::learning
