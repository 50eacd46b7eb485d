#include <cmath>

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

}  // namespace shape3d::descriptors
