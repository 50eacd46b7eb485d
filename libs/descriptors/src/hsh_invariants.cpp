#include <cmath>

#include <Eigen/Eigenvalues>

#include "shape3d/descriptors/hsh.hpp"

namespace shape3d::descriptors {

Eigen::VectorXd hsh_energies(const HshCoefficients& coefficients) {
  Eigen::VectorXd energies(static_cast<Eigen::Index>(hsh_pair_count(coefficients.K)));
  for (int lambda = 0; lambda <= coefficients.K; ++lambda) {
    for (int l = 0; l <= lambda; ++l) {
      energies[static_cast<Eigen::Index>(hsh_pair_index(lambda, l))] =
          coefficients.values
              .segment(static_cast<Eigen::Index>(hsh_index(lambda, l, -l)), 2 * l + 1)
              .norm();
    }
  }
  return energies;
}

Eigen::VectorXd gram_invariants(const HshCoefficients& coefficients) {
  Eigen::VectorXd invariants(static_cast<Eigen::Index>(gram_count(coefficients.K)));
  const auto part = [&](int lambda, int l) {
    return coefficients.values.segment(static_cast<Eigen::Index>(hsh_index(lambda, l, -l)),
                                       2 * l + 1);
  };
  Eigen::Index next = 0;
  for (int l = 0; l <= coefficients.K; ++l) {
    for (int lambda = l; lambda <= coefficients.K; ++lambda) {
      for (int other = lambda; other <= coefficients.K; ++other) {
        invariants[next++] = part(other, l).dot(part(lambda, l)).real();
      }
    }
  }
  return invariants;
}

Eigen::VectorXd gram_roots(const HshCoefficients& coefficients) {
  Eigen::VectorXd invariants(static_cast<Eigen::Index>(gram_count(coefficients.K)));
  const Eigen::VectorXd gram = gram_invariants(coefficients);
  Eigen::Index from = 0, next = 0;
  for (int l = 0; l <= coefficients.K; ++l) {
    const Eigen::Index n = coefficients.K + 1 - l;
    Eigen::MatrixXd matrix(n, n);
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = a; b < n; ++b) matrix(a, b) = matrix(b, a) = gram[from++];
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
    // Of 2l + 1 dimensions: further eigenvalues are 0 up to rounding, of either sign.
    const Eigen::VectorXd roots = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    const Eigen::MatrixXd root =
        solver.eigenvectors() * roots.asDiagonal() * solver.eigenvectors().transpose();
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = a; b < n; ++b) {
        invariants[next++] = a == b ? root(a, a) : std::sqrt(2.0) * root(a, b);
      }
    }
  }
  return invariants;
}

}  // namespace shape3d::descriptors
