#include "principal_axes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace shape3d::learning::detail {

PrincipalAxes principal_axes(const FeaturesView& X, Eigen::Index k) {
  PrincipalAxes result;
  result.mean = X.colwise().mean();
  result.axes = Features::Zero(k, X.cols());
  result.deviation = Eigen::VectorXd::Zero(k);
  const Features centred = X.rowwise() - result.mean;
  const double n = static_cast<double>(X.rows());
  const bool by_items = X.rows() < X.cols();
  Eigen::MatrixXd square =
      Eigen::MatrixXd::Zero(std::min(X.rows(), X.cols()), std::min(X.rows(), X.cols()));
  if (by_items) {
    square.selfadjointView<Eigen::Lower>().rankUpdate(centred, 1.0 / n);
  } else {
    square.selfadjointView<Eigen::Lower>().rankUpdate(centred.transpose(), 1.0 / n);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(square);
  const Eigen::Index size = square.rows();
  const double largest = std::max(0.0, solver.eigenvalues()(size - 1));
  const double least = largest * static_cast<double>(size) * std::numeric_limits<double>::epsilon();
  for (Eigen::Index a = 0; a < std::min(k, size); ++a) {
    const double variance = solver.eigenvalues()(size - 1 - a);
    if (!(variance > least)) break;
    const Eigen::VectorXd vector = solver.eigenvectors().col(size - 1 - a);
    Eigen::RowVectorXd axis = vector.transpose();
    if (by_items) axis = vector.transpose() * centred;
    axis.normalize();
    // The sign is free; components as large as the largest but for rounding count as equal.
    const double limit = axis.cwiseAbs().maxCoeff() * (1.0 - 1e-6);
    Eigen::Index place = 0;
    while (std::abs(axis(place)) < limit) ++place;
    if (axis(place) < 0.0) axis = -axis;
    result.axes.row(a) = axis;
    result.deviation(a) = std::sqrt(variance);
  }
  return result;
}

}  // namespace shape3d::learning::detail
