#pragma once

#include <memory>

#include <Eigen/Core>

#include "shape3d/descriptors/export.hpp"
#include "shape3d/descriptors/hsh.hpp"

namespace shape3d::descriptors {

/// Hyperspherical harmonics of real functions on S³ sampled at fixed angles (appendix D).
///
/// Quadrature::separable: cos θ0 at the n zeros of the Chebyshev polynomial U_n, cos θ at the n
/// Gauss–Legendre nodes, 2n equal steps in φ. Exact for functions of degree up to 2n − 1 − K.
/// Quadrature::svd: n equal steps in each angle, θ0 and θ at the middles; the pseudo-inverse (D.2)
/// of the real form of the matrix (D.1), by singular value decomposition; exact up to degree K.
class SHAPE3D_DESCRIPTORS_EXPORT HshSampling {
 public:
  /// @param K  0 … kMaxHshDegree.
  /// @param n  Nodes along θ0: K + 1 … 512 for separable, 2K + 2 … 40 for svd.
  /// @throws std::invalid_argument  an argument is out of range, or quadrature is neither.
  /// O(n³ K²) for separable; O(n³ hsh_count(K)²) for svd, whose matrix stays in memory.
  HshSampling(int K, Quadrature quadrature, int n);
  ~HshSampling();
  HshSampling(HshSampling&&) noexcept;
  HshSampling& operator=(HshSampling&&) noexcept;

  /// Number of nodes: 2n³ for separable, n³ for svd.
  [[nodiscard]] Eigen::Index size() const;
  /// Angles (θ0, θ, φ) of a node; φ runs fastest, θ0 slowest.
  [[nodiscard]] Eigen::Vector3d node(Eigen::Index i) const;
  /// The hsh_count(K) coefficients of the function with these values at the nodes.
  /// @throws std::invalid_argument  values.size() != size().
  /// separable: O(n³ K); svd: O(n³ hsh_count(K)).
  [[nodiscard]] Eigen::VectorXcd coefficients(
      const Eigen::Ref<const Eigen::VectorXd>& values) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace shape3d::descriptors
