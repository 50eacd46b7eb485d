#pragma once

#include <complex>
#include <random>

#include <Eigen/Core>

#include "shape3d/descriptors/hsh.hpp"

namespace shape3d::descriptors::test {

/// Random coefficients of a real function of degree K on S³.
inline HshCoefficients random_coefficients(int K, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  HshCoefficients result;
  result.K = K;
  result.values.resize(static_cast<Eigen::Index>(hsh_count(K)));
  for (int lambda = 0; lambda <= K; ++lambda) {
    for (int l = 0; l <= lambda; ++l) {
      for (int m = 0; m <= l; ++m) {
        const double re = normal(generator), im = m == 0 ? 0.0 : normal(generator);
        const std::complex<double> c(re, im);
        result.values[static_cast<Eigen::Index>(hsh_index(lambda, l, -m))] =
            (m % 2 == 0 ? 1.0 : -1.0) * std::conj(c);
        result.values[static_cast<Eigen::Index>(hsh_index(lambda, l, m))] = c;
      }
    }
  }
  return result;
}

/// Value of the series (5.6).
inline double series(const HshCoefficients& c, double theta0, double theta, double phi) {
  return (c.values.array() * hsh_basis(c.K, theta0, theta, phi).array()).sum().real();
}

}  // namespace shape3d::descriptors::test
