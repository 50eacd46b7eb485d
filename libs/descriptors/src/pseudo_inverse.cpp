#include "pseudo_inverse.hpp"

#include <Eigen/SVD>

namespace shape3d::descriptors::detail {

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix) {
  // QR first: singular values of a triangle of the size of the columns.
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::HouseholderQRPreconditioner> svd(
      matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return svd.matrixV() * svd.singularValues().cwiseInverse().asDiagonal() *
         svd.matrixU().transpose();
}

}  // namespace shape3d::descriptors::detail
