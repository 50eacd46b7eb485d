#pragma once

#include "support/closed_meshes.hpp"

namespace shape3d::bench {

/// Conformalised mean curvature flow (Kazhdan, Solomon, Ben-Chen 2012, section 4): steps
/// (D_t + δ L) x_{t+1} = D_t x_t with the stiffness matrix L of the mesh it begins with and the
/// mass matrix D_t of the present one, here lumped, which is scaled to unit area after each step. A
/// conformal map to the sphere as far as it converges to one.
struct FlowResult {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> S;  ///< About its centroid, unit rows.
  int steps = 0;  ///< Done; fewer than asked for when a factorisation fails.
  double seconds = 0.0;
  double roundness = 0.0;  ///< Standard deviation over mean of the radii, before projection.
};

/// @param step  δ for a mesh of unit area.
[[nodiscard]] FlowResult mean_curvature_flow(const test::ClosedMesh& mesh, int steps, double step);

}  // namespace shape3d::bench
