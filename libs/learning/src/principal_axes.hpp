#pragma once

#include <Eigen/Core>

#include "shape3d/learning/features.hpp"

namespace shape3d::learning::detail {

struct PrincipalAxes {
  Eigen::RowVectorXd mean;
  Features axes;  ///< k by d, unit vectors by descending variance, the first of the largest
                  ///< components by size positive; zeros beyond the rank.
  Eigen::VectorXd deviation;  ///< k standard deviations (of n).
};

/// The first k principal axes of the rows, by the smaller of covariance and Gram matrix.
PrincipalAxes principal_axes(const FeaturesView& X, Eigen::Index k);

}  // namespace shape3d::learning::detail
