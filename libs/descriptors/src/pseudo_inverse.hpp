#pragma once

#include <Eigen/Core>

namespace shape3d::descriptors::detail {

/// V Σ⁻¹ U' of the singular value decomposition of a matrix of full column rank, with no fewer rows
/// than columns.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix);

}  // namespace shape3d::descriptors::detail
