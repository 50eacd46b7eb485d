#include "sphere_grid.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace shape3d::descriptors::detail {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

void gauss_legendre(int n, Eigen::VectorXd& nodes, Eigen::VectorXd& weights) {
  const Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd beside(n - 1);
  for (int k = 1; k < n; ++k) beside[k - 1] = k / std::sqrt(4.0 * k * k - 1.0);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside, Eigen::ComputeEigenvectors);
  nodes = solver.eigenvalues();
  weights = 2.0 * solver.eigenvectors().row(0).array().square().transpose();
}

SphereGrid::SphereGrid(int K, int rows, int columns)
    : legendre_(K),
      cos_phi_(K + 1, columns),
      sin_phi_(K + 1, columns),
      polar_(static_cast<Eigen::Index>(Legendre::count(K)), rows) {
  gauss_legendre(rows, cos_theta_, weights_);
  sin_theta_ = ((1.0 - cos_theta_.array()) * (1.0 + cos_theta_.array())).sqrt();
  for (int j = 0; j < columns; ++j) {
    for (int m = 0; m <= K; ++m) {
      const int turn = m * j % columns;  // exact, for large m
      const double angle = 2.0 * kPi * turn / columns;
      cos_phi_(m, j) = std::cos(angle);
      sin_phi_(m, j) = std::sin(angle);
    }
  }
  for (int i = 0; i < rows; ++i) {
    legendre_.evaluate(cos_theta_[i], sin_theta_[i], polar_.col(i).data());
    polar_.col(i) *= weights_[i] * 2.0 * kPi / columns;
  }
}

Eigen::Vector3d SphereGrid::direction(int row, int column) const {
  const double phi = 2.0 * kPi * column / columns();
  return {sin_theta_[row] * std::cos(phi), sin_theta_[row] * std::sin(phi), cos_theta_[row]};
}

void SphereGrid::transform(const Eigen::MatrixXd& samples, double* out) const {
  const int K = legendre_.degree();
  const Eigen::MatrixXd cosines = cos_phi_ * samples.transpose();  // K + 1 by rows
  const Eigen::MatrixXd sines = sin_phi_ * samples.transpose();
  const std::size_t pairs = Legendre::count(K);
  for (int m = 0; m <= K; ++m) {
    for (int l = m; l <= K; ++l) {
      const std::size_t place = Legendre::index(l, m);
      const auto polar = polar_.row(static_cast<Eigen::Index>(place));
      out[place] = polar.dot(cosines.row(m));
      out[pairs + place] = -polar.dot(sines.row(m));
    }
  }
}

}  // namespace shape3d::descriptors::detail
