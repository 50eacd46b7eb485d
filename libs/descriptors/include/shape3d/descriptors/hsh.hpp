#pragma once

#include <memory>

#include <Eigen/Core>

#include "shape3d/descriptors/export.hpp"
#include "shape3d/descriptors/hsh_basis.hpp"
#include "shape3d/descriptors/surface.hpp"
#include "shape3d/descriptors/voxels.hpp"

namespace shape3d::descriptors {

/// How the unit ball, ρ = |x| ≤ 1, is laid on the sphere S³; θ and φ are kept (section 5.2.2).
enum class SphereMap {
  two_sided,  ///< sin θ0 = ρ on both halves, z0 = ±√(1−ρ²): the dissertation's. f_{λ,l} = 0 for
              ///< odd λ − l (20 of the 45 with K = 8), as its Tables 5.1 and 5.2 show.
  equal_volume,  ///< θ0 − sin θ0 cos θ0 = πρ³: equal volumes of the ball are equal parts of S³.
  stereographic  ///< θ0 = 2 atan(sρ), s = HshOptions::stretch: conformal; s = 1 covers a half.
};

/// How the integral C = ∫ f conj(Y) over S³ is computed.
enum class Quadrature {
  voxels,     ///< Sum over the voxels, each with the measure of its part of the ball on S³.
  separable,  ///< f by trilinear interpolation at the nodes of Gauss–Gegenbauer in θ0 × Gauss–
              ///< Legendre in θ × equal steps in φ, exact for products of degree 2K.
  svd  ///< f by trilinear interpolation at angles spaced uniformly, times the pseudo-inverse of
       ///< the matrix of all Y (appendix D). For comparison: the matrix is HshOptions::grid³ ×
       ///< hsh_count(K).
};

/// Settings of the transform.
struct HshOptions {
  int K = 8;  ///< Largest degree λ, 0 … kMaxHshDegree, and below half of the side of the voxels.
  SphereMap map = SphereMap::equal_volume;
  double stretch = 4.0;  ///< s of SphereMap::stereographic, 0.1 … 100.
  Quadrature quadrature = Quadrature::voxels;
  int grid = 0;  ///< n of HshSampling for separable and svd; 0: the larger of K + 1 and side/2 for
                 ///< separable, of 20 (the dissertation's) and 2K + 2 for svd.
};

/// θ0 of the sphere map (the upper half of two_sided). @param rho  In [0, 1].
/// @throws std::invalid_argument  rho is outside [0, 1]; stretch is outside 0.1 … 100.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT double hsh_angle(SphereMap map, double stretch,
                                                          double rho);

/// Coefficients C_{λ,l}^m of a real function (5.6): C^{−m} = (−1)^m conj C^m.
struct HshCoefficients {
  int K = 0;
  SphereMap map = SphereMap::equal_volume;
  double stretch = 4.0;
  Eigen::VectorXcd values;  ///< hsh_count(K), at hsh_index(λ, l, m).

  [[nodiscard]] std::complex<double> at(int lambda, int l, int m) const {
    return values[static_cast<Eigen::Index>(hsh_index(lambda, l, m))];
  }
};

/// The transform from voxels, with what depends only on the options and the side prepared once.
class SHAPE3D_DESCRIPTORS_EXPORT HshTransform {
 public:
  /// @param side  Of the voxels, kMinSide … kMaxSide.
  /// @throws std::invalid_argument  an option is out of range; K is not below side/2, with the
  /// largest K allowed in the message.
  /// O(side³ log side); for Quadrature::svd one decomposition of grid³ × hsh_count(K), O(grid³
  /// hsh_count(K)²), and its memory.
  HshTransform(const HshOptions& options, int side);
  ~HshTransform();
  HshTransform(HshTransform&&) noexcept;
  HshTransform& operator=(HshTransform&&) noexcept;

  [[nodiscard]] const HshOptions& options() const;
  [[nodiscard]] int side() const;

  /// Coefficients of the function that is the voxels' value inside the ball.
  ///
  /// Quadrature::voxels groups voxels by their exact radius: first spherical harmonics of each
  /// group, O(side³ K²), then Gegenbauer functions, O(side² K³).
  /// @param threads  0: all processors. The result is the same, bit for bit, for any number.
  /// @throws std::invalid_argument  the voxels' side is another; threads is negative.
  /// May be called concurrently.
  [[nodiscard]] HshCoefficients operator()(const Voxels& voxels, int threads = 0) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

/// Coefficients of the surface itself, as a measure: Σ_i w_i conj Y(x_i), without voxels.
///
/// @param points  In the unit of the frame; points outside its ball are left out.
/// @param frame   Weights count in units of frame.radius².
/// @throws std::invalid_argument  an option is out of range (quadrature and grid are not used); the
/// sizes of points differ; threads is negative.
/// O(points K² + points K³ / 3). Deterministic for any number of threads.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT HshCoefficients hsh_of_points(const SurfacePoints& points,
                                                                       const Frame& frame,
                                                                       const HshOptions& options,
                                                                       int threads = 0);

/// Energies ‖f_{λ,l}‖ = √Σ_m |C_{λ,l}^m|² (5.10, 5.11), hsh_pair_count(K) at hsh_pair_index(λ, l).
/// Invariant under rotation of the ball.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd hsh_energies(
    const HshCoefficients& coefficients);

/// Number of Gram invariants: Σ_l n(n+1)/2 with n = K + 1 − l, that is (K+1)(K+2)(K+3)/6.
[[nodiscard]] constexpr std::size_t gram_count(int K) {
  const auto k = static_cast<std::size_t>(K);
  return (k + 1) * (k + 2) * (k + 3) / 6;
}

/// Gram invariants ⟨f_{λ,l}, f_{λ',l}⟩ = Σ_m C_{λ,l}^m conj C_{λ',l}^m (real for real f): by l,
/// then λ ≥ l, then λ' = λ … K. Their diagonal is the energies squared; the rest says how the
/// radial parts of one l are turned against one another, which norms forget.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd gram_invariants(
    const HshCoefficients& coefficients);

/// Square roots of the Gram matrices G_l, symmetric and positive: as gram_invariants(), with the
/// numbers off the diagonal times √2, so that the Euclidean distance of two vectors is that of all
/// the matrices. They are of the unit of the function, as energies are, and equal these where only
/// one λ has a part of degree l. Invariant under rotation. O(K⁴).
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd gram_roots(
    const HshCoefficients& coefficients);

/// The truncated series (5.6) at the voxel centres inside the ball, 0 outside. For two_sided its
/// value on the upper half. O(side³ K²).
/// @throws std::invalid_argument  side is out of range; the coefficients' size is not hsh_count(K).
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Voxels reconstruct(const HshCoefficients& coefficients,
                                                            int side, int threads = 0);

/// What truncation leaves (5.12): ‖f − Σ_{λ≤K} …‖ / ‖f‖ in the measure of S³, by quadrature over
/// the voxels inside the ball; 0 where f = 0.
/// @throws std::invalid_argument  as reconstruct().
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT double hsh_residual(const HshCoefficients& coefficients,
                                                             const Voxels& voxels, int threads = 0);

}  // namespace shape3d::descriptors
