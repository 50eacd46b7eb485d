#include "mean_curvature_flow.hpp"

#include <chrono>
#include <cmath>
#include <vector>

#include <Eigen/SparseCholesky>

namespace shape3d::bench {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Points = decltype(test::ClosedMesh::V);

Matrix stiffness(const test::ClosedMesh& mesh) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int i = mesh.F(t, k), j = mesh.F(t, (k + 1) % 3), opposite = mesh.F(t, (k + 2) % 3);
      const Eigen::Vector3d a = mesh.V.row(i) - mesh.V.row(opposite);
      const Eigen::Vector3d b = mesh.V.row(j) - mesh.V.row(opposite);
      const double weight = 0.5 * a.dot(b) / std::max(a.cross(b).norm(), 1e-300);
      entries.emplace_back(i, j, -weight);
      entries.emplace_back(j, i, -weight);
      entries.emplace_back(i, i, weight);
      entries.emplace_back(j, j, weight);
    }
  }
  Matrix L(mesh.V.rows(), mesh.V.rows());
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

/// Lumped masses, scaled to a sum of 1 together with the mesh; centred.
Eigen::VectorXd normalise(const test::ClosedMesh& mesh, Points& X) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(X.rows());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Eigen::Vector3d a = X.row(mesh.F(t, 1)) - X.row(mesh.F(t, 0));
    const Eigen::Vector3d b = X.row(mesh.F(t, 2)) - X.row(mesh.F(t, 0));
    const double third = a.cross(b).norm() / 6;
    for (int k = 0; k < 3; ++k) mass[mesh.F(t, k)] += third;
  }
  const double area = mass.sum();
  mass /= area;
  const Eigen::RowVector3d centroid = mass.transpose() * X;
  X.rowwise() -= centroid;
  X /= std::sqrt(area);
  return mass;
}

}  // namespace

FlowResult mean_curvature_flow(const test::ClosedMesh& mesh, int steps, double step) {
  const auto start = std::chrono::steady_clock::now();
  FlowResult result;
  Points X = mesh.V;
  const Matrix L = stiffness(mesh);
  Eigen::VectorXd mass = normalise(mesh, X);
  Eigen::SimplicialLDLT<Matrix> solver;
  Matrix system = step * L;
  solver.analyzePattern(system);
  for (; result.steps < steps; ++result.steps) {
    system = step * L;
    system.diagonal() += mass;
    solver.factorize(system);
    if (solver.info() != Eigen::Success) break;
    const Eigen::MatrixX3d next = solver.solve(Eigen::MatrixX3d(mass.asDiagonal() * X));
    if (!next.allFinite()) break;
    X = next;
    mass = normalise(mesh, X);
  }
  const Eigen::VectorXd radii = X.rowwise().norm();
  const double mean = mass.dot(radii);
  result.roundness = std::sqrt(mass.dot((radii.array() - mean).square().matrix())) / mean;
  result.S = X.rowwise().normalized();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace shape3d::bench
