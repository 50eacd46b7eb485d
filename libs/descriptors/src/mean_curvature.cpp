#include <cmath>

#include <Eigen/Geometry>

#include "shape3d/descriptors/spherical_image.hpp"

namespace shape3d::descriptors {

Eigen::VectorXd vertex_mean_curvature(const Eigen::Ref<const Points>& V,
                                      const Eigen::Ref<const Triangles>& F) {
  check_surface(V, F);
  const double size = (V.colwise().maxCoeff() - V.colwise().minCoeff()).maxCoeff();
  Points laplacian = Points::Zero(V.rows(), 3), normals = Points::Zero(V.rows(), 3);
  Eigen::VectorXd area = Eigen::VectorXd::Zero(V.rows());
  if (size == 0.0) return area;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    Eigen::Vector3d edges[3];  // opposite to each corner, in units of the surface's size
    for (int i = 0; i < 3; ++i) {
      edges[i] = (V.row(F(t, (i + 2) % 3)) - V.row(F(t, (i + 1) % 3))) / size;
    }
    const Eigen::Vector3d normal = edges[0].cross(edges[1]);  // twice the area
    const double twice = normal.norm();
    if (twice == 0.0) continue;
    for (int i = 0; i < 3; ++i) {
      const auto a = F(t, i), b = F(t, (i + 1) % 3), c = F(t, (i + 2) % 3);
      area[a] += twice / 6.0;
      normals.row(a) += normal;
      const double cotangent = -edges[(i + 1) % 3].dot(edges[(i + 2) % 3]) / twice;
      // The edge from b to c has this angle opposite to it.
      laplacian.row(b) -= cotangent * edges[i];
      laplacian.row(c) += cotangent * edges[i];
    }
  }
  Eigen::VectorXd curvature(V.rows());
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    const double length = normals.row(v).norm();
    curvature[v] = area[v] > 0.0 && length > 0.0
                       ? laplacian.row(v).dot(normals.row(v)) / (length * 4.0 * area[v] * size)
                       : 0.0;
  }
  return curvature;
}

}  // namespace shape3d::descriptors
