#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"
#include "shape3d/learning/scaling.hpp"

namespace shape3d::learning {

enum class SomLattice {
  rectangular,  ///< Four neighbours at distance 1.
  hexagonal     ///< Six neighbours at distance 1; odd rows stand half a unit to the right.
};

enum class SomShape {
  sheet,
  toroid  ///< The last row and column are neighbours of the first. Hexagonal: an even number of
          ///< rows.
};

/// Where the units of a map are. Unit i is in row i / columns, column i % columns.
struct SomGrid {
  int rows = 12, columns = 6;  ///< At least 1 each, 2 units at least; toroid: at least 3 each.
  SomLattice lattice = SomLattice::hexagonal;
  SomShape shape = SomShape::sheet;

  [[nodiscard]] int units() const { return rows * columns; }
};

/// @throws std::invalid_argument  sizes are out of range, or odd rows of a hexagonal toroid.
SHAPE3D_LEARNING_EXPORT void check_grid(const SomGrid& grid);

/// Positions R of (4.15), #units by 2: x to the right, y down; neighbours are 1 apart.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Eigen::MatrixX2d som_positions(const SomGrid& grid);

/// ‖R_b − R_i‖ of all pairs, #units by #units; on a toroid the shortest way round.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Eigen::MatrixXd som_distances(const SomGrid& grid);

/// Units at distance 1 of each, ascending.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT std::vector<std::vector<int>> som_neighbours(
    const SomGrid& grid);

enum class SomTraining {
  batch,      ///< All items move all prototypes at once; no α.
  sequential  ///< (4.14), item by item in seeded order.
};

enum class SomStart {
  pca,  ///< A plane through the mean along the first two principal axes, ± one standard deviation.
  random  ///< Each component uniform between its least and its largest value; seeded.
};

/// Settings of the training.
struct SomOptions {
  SomGrid grid;
  SomTraining training = SomTraining::batch;
  SomStart start = SomStart::pca;
  ScalingKind scaling = ScalingKind::none;  ///< Of the components, before all else.
  int epochs = 50;                          ///< Times that every item is shown, ≥ 1.
  double sigma_first =
      0.0;  ///< σ at the beginning, > 0; 0 stands for half the longer side, at least 1.
  double sigma_last =
      0.5;  ///< σ at the end, > 0. The way is geometric: σ(t) = first (last/first)^t.
  double alpha_first = 0.5;  ///< α at the beginning, sequential alone; 0 < α ≤ 1.
  double alpha_last = 0.01;  ///< α at the end; also geometric.
  std::uint64_t seed = 1;
  /// Called after each epoch with the share done, 0 … 1; false cancels: the map is as it is then.
  std::function<bool(double)> progress;
};

/// A self-organizing map (section 4.5): prototype vectors on a grid.
struct Som {
  SomGrid grid;
  Scaling scaling;      ///< Of the items.
  Features prototypes;  ///< #units by d, of scaled items.
  bool cancelled = false;

  /// The prototypes in the units of the items.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT Features unscaled_prototypes() const;

  /// Bytes with a check sum, the same on every platform.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT std::string serialize() const;
  /// @throws std::invalid_argument  the bytes are damaged or not of a map.
  [[nodiscard]] SHAPE3D_LEARNING_EXPORT static Som deserialize(std::string_view bytes);
};

/// Trains a map with the neighbourhood h of (4.15).
///
/// Batch: with b(x) the best unit (4.13) of each item, M_i = Σ_x h_{b(x) i} x / Σ_x h_{b(x) i}, the
/// fixed point of (4.14). A unit that no item reaches (h underflows) stays where it is.
/// @param threads  0: all processors; batch alone uses them. The map is the same, bit for bit, for
/// any number.
/// @throws std::invalid_argument  X has no rows or columns; a number is not finite; an option is
/// out of range. O(epochs · n · units · d), and d² n (n² d where n < d) for the principal axes.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Som train_som(const FeaturesView& X,
                                                    const SomOptions& options = {},
                                                    int threads = 0);

/// The two best units of each item.
struct BestUnits {
  std::vector<int> first, second;  ///< Of equally near ones, the lower number.
  Eigen::VectorXd distance;        ///< ‖x − M_b‖ of the first, scaled.
};

/// Best-matching units (4.13). Distances are those of the plain sum Σ (x_j − M_j)²: a matrix
/// product only says which prototypes cannot be nearest.
/// @throws std::invalid_argument  X has not d columns; a number is not finite.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT BestUnits best_units(const Som& som, const FeaturesView& X,
                                                           int threads = 0);

}  // namespace shape3d::learning
