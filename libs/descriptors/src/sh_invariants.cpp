#include <stdexcept>
#include <string>

#include <Eigen/SVD>

#include "sh_checks.hpp"
#include "shape3d/descriptors/sh.hpp"

namespace shape3d::descriptors {
namespace {

void check_three_components(const Eigen::Ref<const Eigen::MatrixXcd>& coefficients) {
  if (coefficients.cols() != 3) {
    throw std::invalid_argument("coefficients has " + std::to_string(coefficients.cols()) +
                                " components, expected the 3 of a vector field");
  }
}

}  // namespace

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
  check_three_components(coefficients);
  Eigen::MatrixXd gram(3 * (Eigen::Index{K} + 1), 3);
  for (int l = 0; l <= K; ++l) {
    const auto block = coefficients.middleRows(sh_index(l, -l), 2 * l + 1);
    gram.middleRows(3 * l, 3) = (block.transpose() * block.conjugate()).real();
  }
  return gram;
}

Eigen::VectorXd sh_component_roots(const Eigen::Ref<const Eigen::MatrixXcd>& coefficients) {
  const int K = detail::degree_of(coefficients);
  check_three_components(coefficients);
  // Singular values of the coefficients themselves: roots of the eigenvalues of G_l would have half
  // of the digits where they are small.
  Eigen::VectorXd roots = Eigen::VectorXd::Zero(3 * (Eigen::Index{K} + 1));
  for (int l = 0; l <= K; ++l) {
    const Eigen::MatrixXcd block = coefficients.middleRows(sh_index(l, -l), 2 * l + 1);
    const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXcd>(block).singularValues();
    roots.segment(3 * l, values.size()) = values;
  }
  return roots;
}

}  // namespace shape3d::descriptors
