#pragma once

#include <memory>

#include <Eigen/Core>

#include "shape3d/descriptors/export.hpp"
#include "shape3d/descriptors/surface.hpp"

// Spherical harmonics of functions on the sphere (section 4.4 and appendix C).
//
// Conventions: θ in [0, π] from the z axis, φ from the x axis; Y_l^m orthonormal with the
// Condon–Shortley phase, Y_l^{−m} = (−1)^m conj Y_l^m. Functions are real, so that
// C_l^{−m} = (−1)^m conj C_l^m. A function may have several components, one a column.
namespace shape3d::descriptors {

/// Number of coefficients of degree ≤ K: (K + 1)².
[[nodiscard]] constexpr Eigen::Index sh_count(int K) {
  return (Eigen::Index{K} + 1) * (Eigen::Index{K} + 1);
}
/// Row of C_l^m, −l ≤ m ≤ l.
[[nodiscard]] constexpr Eigen::Index sh_index(int l, int m) { return Eigen::Index{l} * l + l + m; }

/// Smallest and largest number of rows of an image on the sphere.
inline constexpr int kMinImageSize = 4, kMaxImageSize = 1024;

/// Largest degree that an image of n rows determines: n/2 − 1, one less than the bandwidth B = n/2
/// of (C.3).
[[nodiscard]] constexpr int sh_largest_degree(int size) { return size / 2 - 1; }

/// Direction of row j and column k of an image of n rows and 2n columns: θ_j = π(2j + 1)/2n,
/// φ_k = πk/n. No pixel lies on a pole. In tables of samples pixel (j, k) is row 2nj + k.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::Vector3d image_direction(int size, int row,
                                                                         int column);

/// Weights a_j of (C.3) for the n rows: Σ_j a_j p(cos θ_j) = ∫ p(x) dx over [−1, 1] for every
/// polynomial p of degree < n (Fejér's first rule). Positive; their sum is 2.
/// @throws std::invalid_argument  size is odd or outside kMinImageSize … kMaxImageSize.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd image_weights(int size);

/// How coefficients are computed from an image.
enum class ShRoute {
  quadrature,  ///< The double sum (C.3) as it stands, O(n² K²).
  fft,         ///< The same sum with an FFT along each row, O(n² log n + n K²).
  svd  ///< Pseudo-inverse of the matrix of all Y (C.2), made once by singular value decomposition,
       ///< O(n² K⁴), then O(n² K²): the least-squares fit, every pixel counting the same.
};

/// The transform of images of one size, with what depends on size and K prepared once.
///
/// All routes give the coefficients of a band-limited function (degree ≤ K) to rounding. Of other
/// functions quadrature and fft give the discrete projection, in which degrees up to n − 1 − K do
/// not leak into those ≤ K, and svd the best fit.
class SHAPE3D_DESCRIPTORS_EXPORT ShTransform {
 public:
  /// @param K  Largest degree, 0 … sh_largest_degree(size); at most 32 for ShRoute::svd, whose
  /// matrix has 2n² (K+1)² numbers, at most 2²⁷.
  /// @throws std::invalid_argument  size is odd or outside kMinImageSize … kMaxImageSize; K is out
  /// of range, with the largest K allowed in the message; the matrix of svd is too large.
  ShTransform(int size, int K, ShRoute route = ShRoute::fft);
  ~ShTransform();
  ShTransform(ShTransform&&) noexcept;
  ShTransform& operator=(ShTransform&&) noexcept;

  [[nodiscard]] int size() const;
  [[nodiscard]] int K() const;

  /// Coefficients (4.10), sh_count(K) rows, a column for each component.
  /// @param samples  2n² rows in the order of image_direction().
  /// @throws std::invalid_argument  another number of rows; a sample is not finite.
  /// Deterministic; may be called concurrently.
  [[nodiscard]] Eigen::MatrixXcd operator()(const Eigen::Ref<const Eigen::MatrixXd>& samples) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

/// Least squares from samples at any directions (appendix C), with the pseudo-inverse made once.
class SHAPE3D_DESCRIPTORS_EXPORT ShFit {
 public:
  /// @param directions  #N by 3 unit vectors.
  /// @param K           0 … 32, #N · (K+1)² ≤ 2²⁷.
  /// @throws std::invalid_argument  a direction's length differs from 1 by more than 1e-6; K or the
  /// size of the matrix is out of range.
  /// O(N K⁴). Singular values below 1e-12 of the largest count as zero: then the coefficients are
  /// those of least norm.
  ShFit(const Eigen::Ref<const Points>& directions, int K);
  ~ShFit();
  ShFit(ShFit&&) noexcept;
  ShFit& operator=(ShFit&&) noexcept;

  /// Number of coefficients that the directions determine; sh_count(K) when it is all.
  [[nodiscard]] Eigen::Index rank() const;
  /// Largest over smallest singular value of those not zero.
  [[nodiscard]] double condition() const;

  /// Coefficients, as of ShTransform. @param samples  #N rows.
  /// @throws std::invalid_argument  another number of rows; a sample is not finite.
  [[nodiscard]] Eigen::MatrixXcd operator()(const Eigen::Ref<const Eigen::MatrixXd>& samples) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

/// Y_l^m at each direction: #N by sh_count(K), the matrix (C.1).
/// @throws std::invalid_argument  as ShFit, without its limit on K: here it is 1000.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::MatrixXcd spherical_harmonics(
    const Eigen::Ref<const Points>& directions, int K);

/// The truncated series (4.9) at the pixels of an image: 2n² by components. O(n² K + n K²) by FFT.
/// @throws std::invalid_argument  coefficients.rows() is not a square; size is out of range or its
/// largest degree below K.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::MatrixXd sh_reconstruct(
    const Eigen::Ref<const Eigen::MatrixXcd>& coefficients, int size);

/// What truncation leaves (4.11) relative to the function, ‖f − Σ_{l≤K} …‖ / ‖f‖ over the sphere
/// and all components, by quadrature over the pixels; 0 where f = 0.
/// @throws std::invalid_argument  as sh_reconstruct(); numbers of components differ.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT double sh_residual(
    const Eigen::Ref<const Eigen::MatrixXcd>& coefficients,
    const Eigen::Ref<const Eigen::MatrixXd>& samples, int size);

/// Amplitudes |C_l^m|, 0 ≤ m ≤ l: the dissertation's feature vector. (K+1)(K+2)/2 rows, degree by
/// degree, then m; a column for each component. They depend on the pose; a rotation about z leaves
/// those of a scalar unchanged.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::MatrixXd sh_amplitudes(
    const Eigen::Ref<const Eigen::MatrixXcd>& coefficients);

/// Norms √(Σ_c Σ_m |C_l^{m,c}|²), l = 0 … K, over all components together.
///
/// Invariant under rotation of a scalar, f'(x) = f(Rᵀx), and of a vector field,
/// N'(x) = R N(Rᵀx), whose components are mixed: therefore not one norm a component.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd sh_norms(
    const Eigen::Ref<const Eigen::MatrixXcd>& coefficients);

/// G_l = Σ_m C_l^m (C_l^m)^H of the three components of a vector field: real, symmetric, positive
/// semidefinite 3 × 3 matrices, l = 0 … K, one below the other (3(K+1) by 3). Rotation makes
/// R G_l Rᵀ of it.
/// @throws std::invalid_argument  there are not three components.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::MatrixXd sh_component_gram(
    const Eigen::Ref<const Eigen::MatrixXcd>& coefficients);

/// Square roots of the eigenvalues of each G_l, descending: 3(K+1) numbers, invariant under
/// rotation. Their squares sum to the squared norm of degree l.
/// @throws std::invalid_argument  as sh_component_gram().
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd sh_component_roots(
    const Eigen::Ref<const Eigen::MatrixXcd>& coefficients);

}  // namespace shape3d::descriptors
