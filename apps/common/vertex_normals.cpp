#include "vertex_normals.hpp"

#include <Eigen/Geometry>

namespace shape3d::apps {

Mesh::Points vertex_normals(const Mesh& mesh) {
  Mesh::Points normals = Mesh::Points::Zero(mesh.V.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Eigen::Vector3d a = mesh.V.row(mesh.F(t, 0)), b = mesh.V.row(mesh.F(t, 1)),
                          c = mesh.V.row(mesh.F(t, 2));
    const Eigen::RowVector3d normal = (b - a).cross(c - a);
    for (Eigen::Index i = 0; i < 3; ++i) normals.row(mesh.F(t, i)) += normal;
  }
  for (Eigen::Index v = 0; v < normals.rows(); ++v)
    normals.row(v) = normals.row(v).stableNormalized();
  return normals;
}

}  // namespace shape3d::apps
