#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"
#include "shape3d/learning/som.hpp"

namespace shape3d::learning {

/// How well a map fits items.
struct SomQuality {
  double quantization_error = 0.0;  ///< Mean distance of an item to its best prototype, scaled.
  double topographic_error = 0.0;   ///< Share of items whose two best units are not neighbours.
};

/// @throws std::invalid_argument  there is no item.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT SomQuality som_quality(const Som& som, const BestUnits& best);

/// The unified distance matrix (Ultsch and Siemon 1990): units and, between them, the distances of
/// neighbouring prototypes.
struct UMatrix {
  /// 2 rows − 1 by 2 columns − 1, on a toroid 2 rows by 2 columns with the way round at the end.
  /// (2r, 2c) is the unit of row r and column c: the mean distance to its neighbours.
  /// Rectangular: (2r, 2c + 1) and (2r + 1, 2c) are the distances to the next column and row,
  /// (2r + 1, 2c + 1) the mean of the two diagonals over √2.
  /// Hexagonal: (2r, 2c + 1) the distance to the next column; row 2r + 1 holds the distances
  /// between rows r and r + 1 from left to right.
  Eigen::MatrixXd values;
  Eigen::MatrixXd x, y;  ///< Middle of each element, in the units of som_positions().
};

/// Distances are of scaled prototypes.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT UMatrix u_matrix(const Som& som);

/// One component of all prototypes, in the unit of the items: rows by columns.
/// @throws std::invalid_argument  there is no such component.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Eigen::MatrixXd component_plane(const Som& som,
                                                                      Eigen::Index component);

/// Items whose best unit is there: rows by columns.
/// @throws std::invalid_argument  a unit is not of the grid.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Eigen::MatrixXi hit_histogram(const SomGrid& grid,
                                                                    const std::vector<int>& units);

/// The label of each of `count` units (or clusters): the one that most items there have, of equally
/// many the lowest. kUnlabelled where no labelled item is.
/// @throws std::invalid_argument  lengths differ; a unit is not 0 … count − 1.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Labels vote_labels(const std::vector<int>& units,
                                                         const Labels& labels, int count);

/// Share of labelled items that have the label of their unit by vote (purity); 0 without such
/// items.
/// @throws std::invalid_argument  as vote_labels().
[[nodiscard]] SHAPE3D_LEARNING_EXPORT double purity(const std::vector<int>& units,
                                                    const Labels& labels, int count);

/// The class of each row of X: the label of the nearest prototype among units that have one.
/// @param unit_labels  For each unit, as vote_labels() gives them.
/// @throws std::invalid_argument  as best_units(); there is not a label for each unit; no unit has
/// one.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Labels classify_by_som(const Som& som,
                                                             const Labels& unit_labels,
                                                             const FeaturesView& X,
                                                             int threads = 0);

/// A map with what is known of its units, as it is kept in a file.
struct SomModel {
  Som som;
  std::vector<int> hits;      ///< Items of each unit.
  Labels labels;              ///< Of each unit by vote.
  std::vector<int> clusters;  ///< Second level: the cluster of each unit.
  std::vector<std::string>
      names;  ///< Of the item nearest to each prototype among its items; "": none.

  [[nodiscard]] SHAPE3D_LEARNING_EXPORT std::string serialize() const;
  /// @throws std::invalid_argument  the bytes are damaged or not of such a map.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT static SomModel deserialize(std::string_view bytes);
};

}  // namespace shape3d::learning
