#pragma once

#include <complex>

#include <Eigen/Core>

#include "legendre.hpp"
#include "shape3d/descriptors/hsh_basis.hpp"

namespace shape3d::descriptors::detail {

/// All coefficients from those of m ≥ 0: C^{−m} = (−1)^m conj C^m.
template <class OfNonNegativeOrder>
Eigen::VectorXcd complete(int K, OfNonNegativeOrder&& value) {
  Eigen::VectorXcd values(static_cast<Eigen::Index>(hsh_count(K)));
  for (int lambda = 0; lambda <= K; ++lambda) {
    for (int l = 0; l <= lambda; ++l) {
      for (int m = 0; m <= l; ++m) {
        const std::complex<double> c = value(lambda, l, m);
        values[static_cast<Eigen::Index>(hsh_index(lambda, l, -m))] =
            (m % 2 == 0 ? 1.0 : -1.0) * std::conj(c);
        values[static_cast<Eigen::Index>(hsh_index(lambda, l, m))] = c;
      }
    }
  }
  return values;
}

/// C_{λ,l}^m = Σ_s R_{λ,l}(s) A_l^m(s).
/// @param radial   hsh_pair_count(K) by #s: R_{λ,l} times weight, at hsh_pair_index(λ, l).
/// @param spheres  2 · Legendre::count(K) by #s: real parts of A_l^m at Legendre::index(l, m), then
///                 imaginary parts.
Eigen::VectorXcd radial_transform(int K, const Eigen::Ref<const Eigen::MatrixXd>& radial,
                                  const Eigen::Ref<const Eigen::MatrixXd>& spheres);

}  // namespace shape3d::descriptors::detail
