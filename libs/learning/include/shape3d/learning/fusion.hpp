#pragma once

#include <vector>

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"

namespace shape3d::learning {

/// The mean distance between different items: the unit in which distances of one descriptor are
/// compared with those of another.
/// @param D  n by n; the diagonal is not looked at.
/// @return   0 when there is no pair.
/// @throws std::invalid_argument  D is not square.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT double mean_distance(
    const Eigen::Ref<const Eigen::MatrixXd>& D);

/// One descriptor of a fusion.
struct FusionPart {
  Eigen::MatrixXd D;  ///< Distances; all parts of one size.
  double unit =
      1.0;  ///< mean_distance() of a collection; 0: the part says nothing and is left out.
  double weight = 1.0;  ///< ≥ 0.
};

/// Σ weight D / unit, over Σ weight.
/// @throws std::invalid_argument  there is no part; sizes differ; a unit or a weight is negative or
/// not finite; all weights are 0.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Eigen::MatrixXd fused(const std::vector<FusionPart>& parts);

/// Distances in the units of their neighbourhoods: D_ij / √(s_i s_j), s_i the mean distance of item
/// i to its k nearest others. Items in dense parts of a collection then are not the neighbours of
/// nobody, and items in the middle of it not those of everybody. No labels are needed.
/// Infinite distances stay so, and are not those of neighbours.
/// (Zelnik-Manor and Perona 2004, as a distance.)
/// @param D  n by n, symmetric. @param k  1 … n − 1; a larger one stands for n − 1.
/// @throws std::invalid_argument  D is not square; k < 1.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT Eigen::MatrixXd locally_scaled(
    const Eigen::Ref<const Eigen::MatrixXd>& D, int k);

}  // namespace shape3d::learning
