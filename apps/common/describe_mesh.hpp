#pragma once

#include <vector>

#include <Eigen/Core>

#include <shape3d/descriptors/descriptor.hpp>

#include "mesh.hpp"

namespace shape3d::apps {

/// A mesh in the pose, and with the spherical map, that descriptors need.
struct PosedMesh {
  Mesh::Points V;
  Mesh::Triangles F;
  Mesh::Points S;  ///< #V by 3, or empty.
};

/// Aligns a mesh by continuous principal component analysis, and maps it to the sphere.
/// @throws std::invalid_argument  the libraries refuse the mesh.
/// @throws std::runtime_error     there is no spherical map of it.
[[nodiscard]] PosedMesh posed_mesh(const Mesh& mesh, descriptors::Align align, bool map);

/// The vector of each descriptor; a pose and a map that several need are computed once.
/// @throws as posed_mesh() and Descriptor::compute().
[[nodiscard]] std::vector<Eigen::VectorXd> describe_mesh(
    const Mesh& mesh, const std::vector<descriptors::Descriptor>& descriptors, int threads);

}  // namespace shape3d::apps
