#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shape3d/descriptors/descriptor.hpp>

#include "common/mesh.hpp"
#include "common/picture.hpp"

namespace shape3d::apps {

/// What a descriptor makes of a mesh on the way to its vector.
struct ShownParts {
  std::vector<Panel> panels;
  std::deque<Mesh> meshes;         ///< What the panels' views borrow.
  std::optional<double> residual;  ///< Of the reconstruction, relative; (4.11) or (5.12).
};

/// hsh and csm: the voxels, their middle slice, and what is left of them in the coefficients; egi:
/// the image on the sphere; sni, sci, sgi: the map, the image, its reconstruction.
/// @throws as describe_mesh().
[[nodiscard]] ShownParts shown_parts(const Mesh& mesh, const descriptors::Descriptor& descriptor,
                                     int threads);

/// The parts, and the vector as bars below them. @return PNG bytes.
/// @throws PictureError  no display works.
[[nodiscard]] std::string draw_shown(const ShownParts& parts,
                                     const descriptors::Descriptor& descriptor,
                                     const Eigen::VectorXd& vector);

}  // namespace shape3d::apps
