#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "shape3d/descriptors/export.hpp"

namespace shape3d::descriptors {

/// Largest degree of the hyperspherical harmonics.
inline constexpr int kMaxHshDegree = 60;

/// Number of functions Y_{λ,l}^m with λ ≤ K: (K+1)(K+2)(2K+3)/6.
[[nodiscard]] constexpr std::size_t hsh_count(int K) {
  const auto k = static_cast<std::size_t>(K);
  return (k + 1) * (k + 2) * (2 * k + 3) / 6;
}

/// Place of (λ, l, m), −l ≤ m ≤ l ≤ λ: by λ, then l, then m, as in appendix D:
/// (0,0,0) (1,0,0) (1,1,−1) (1,1,0) (1,1,1) (2,0,0) …
[[nodiscard]] constexpr std::size_t hsh_index(int lambda, int l, int m) {
  return (lambda == 0 ? 0 : hsh_count(lambda - 1)) + static_cast<std::size_t>(l) * l +
         static_cast<std::size_t>(l + m);
}

/// Number of pairs l ≤ λ ≤ K, the length of the descriptor (5.10): (K+1)(K+2)/2.
[[nodiscard]] constexpr std::size_t hsh_pair_count(int K) {
  const auto k = static_cast<std::size_t>(K);
  return (k + 1) * (k + 2) / 2;
}

/// Place of (λ, l): by λ, then l.
[[nodiscard]] constexpr std::size_t hsh_pair_index(int lambda, int l) {
  return static_cast<std::size_t>(lambda) * (static_cast<std::size_t>(lambda) + 1) / 2 +
         static_cast<std::size_t>(l);
}

/// The factor of Y_{λ,l}^m in θ0 (5.7, 5.8),
///   R_{λ,l}(θ0) = N_{λ,l} C_{λ−l}^{l+1}(cos θ0) sin^l θ0,
/// for all l ≤ λ ≤ K, with ∫_0^π R_{λ,l} R_{λ',l} sin² θ0 dθ0 = δ_{λλ'}.
///
/// The sign is (−1)^{λ+l} at θ0 → 0, as in (5.8). Computed by the three-term recurrence in λ of the
/// *normalised* functions from R_{l,l} ∝ sin^l θ0, which neither overflows nor cancels; the sum
/// (5.9) loses all digits from λ of about 40 on.
///
/// @param K       0 … kMaxHshDegree.
/// @param theta0  In [0, π].
/// @return        hsh_pair_count(K) values at hsh_pair_index(λ, l).
/// @throws std::invalid_argument  K or theta0 is out of range.
/// O(K²).
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd hsh_radial(int K, double theta0);

/// All Y_{λ,l}^m(θ, φ, θ0) with λ ≤ K (5.7); Y_l^m with the Condon–Shortley phase, so that
/// Y_{λ,l}^{−m} = (−1)^m conj Y_{λ,l}^m. Orthonormal under sin² θ0 sin θ dθ0 dθ dφ on S³.
///
/// @param theta0, theta  In [0, π]. @param phi  Any finite angle.
/// @return  hsh_count(K) values at hsh_index(λ, l, m).
/// @throws std::invalid_argument  an argument is out of range.
/// O(K³).
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXcd hsh_basis(int K, double theta0,
                                                                    double theta, double phi);

}  // namespace shape3d::descriptors
