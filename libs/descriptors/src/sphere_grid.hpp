#pragma once

#include <vector>

#include <Eigen/Core>

#include "legendre.hpp"

namespace shape3d::descriptors::detail {

/// Nodes and weights of Gauss–Legendre quadrature on [−1, 1], ascending; exact to degree 2n − 1.
/// By the eigenvectors of the Jacobi matrix (Golub and Welsch 1969).
void gauss_legendre(int n, Eigen::VectorXd& nodes, Eigen::VectorXd& weights);

/// Spherical harmonics of functions sampled on Gauss–Legendre circles, exact for products of degree
/// up to min(2 rows − 1, columns − 1).
class SphereGrid {
 public:
  /// rows circles of latitude with columns equally spaced longitudes.
  SphereGrid(int K, int rows, int columns);

  [[nodiscard]] int rows() const { return static_cast<int>(cos_theta_.size()); }
  [[nodiscard]] int columns() const { return static_cast<int>(cos_phi_.cols()); }
  [[nodiscard]] double cos_theta(int row) const { return cos_theta_[row]; }
  [[nodiscard]] Eigen::Vector3d direction(int row, int column) const;

  /// ∫ f conj(Y_l^m) dΩ for m ≥ 0: real parts at Legendre::index(l, m) of `out`, imaginary parts
  /// Legendre::count(K) further.
  /// @param samples  rows() × columns().
  void transform(const Eigen::MatrixXd& samples, double* out) const;

 private:
  Legendre legendre_;
  Eigen::VectorXd cos_theta_, sin_theta_, weights_;
  Eigen::MatrixXd cos_phi_, sin_phi_;  // cos mφ and sin mφ, K + 1 by columns
  Eigen::MatrixXd polar_;              // P̄ times weight, Legendre::count(K) by rows
};

}  // namespace shape3d::descriptors::detail
