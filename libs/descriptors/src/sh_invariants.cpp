#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Eigenvalues>

#include "sh_checks.hpp"
#include "shape3d/descriptors/sh.hpp"

namespace shape3d::descriptors {

Eigen::MatrixXd sh_amplitudes(const Eigen::Ref<const Eigen::MatrixXcd>& coefficients) {
  const int K = detail::degree_of(coefficients);
  Eigen::MatrixXd amplitudes((Eigen::Index{K} + 1) * (K + 2) / 2, coefficients.cols());
  Eigen::Index row = 0;
  for (int l = 0; l <= K; ++l) {
    for (int m = 0; m <= l; ++m) {
      amplitudes.row(row++) = coefficients.row(sh_index(l, m)).cwiseAbs();
    }
  }
  return amplitudes;
}

Eigen::VectorXd sh_norms(const Eigen::Ref<const Eigen::MatrixXcd>& coefficients) {
  const int K = detail::degree_of(coefficients);
  Eigen::VectorXd norms(K + 1);
  for (int l = 0; l <= K; ++l) {
    norms[l] = coefficients.middleRows(sh_index(l, -l), 2 * l + 1).norm();
  }
  return norms;
}

Eigen::MatrixXd sh_component_gram(const Eigen::Ref<const Eigen::MatrixXcd>& coefficients) {
  const int K = detail::degree_of(coefficients);
  if (coefficients.cols() != 3) {
    throw std::invalid_argument("coefficients has " + std::to_string(coefficients.cols()) +
                                " components, expected the 3 of a vector field");
  }
  Eigen::MatrixXd gram(3 * (Eigen::Index{K} + 1), 3);
  for (int l = 0; l <= K; ++l) {
    const auto block = coefficients.middleRows(sh_index(l, -l), 2 * l + 1);
    gram.middleRows(3 * l, 3) = (block.transpose() * block.conjugate()).real();
  }
  return gram;
}

Eigen::VectorXd sh_component_roots(const Eigen::Ref<const Eigen::MatrixXcd>& coefficients) {
  const Eigen::MatrixXd gram = sh_component_gram(coefficients);
  Eigen::VectorXd roots(gram.rows());
  for (Eigen::Index row = 0; row < gram.rows(); row += 3) {
    const Eigen::Matrix3d G = gram.middleRows(row, 3);
    const Eigen::Vector3d values =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(G, Eigen::EigenvaluesOnly).eigenvalues();
    for (int i = 0; i < 3; ++i) roots[row + i] = std::sqrt(std::max(values[2 - i], 0.0));
  }
  return roots;
}

}  // namespace shape3d::descriptors
