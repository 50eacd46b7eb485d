#include "describe_mesh.hpp"

#include <array>
#include <optional>
#include <stdexcept>
#include <string>

#include <shape3d/mapping/align.hpp>
#include <shape3d/mapping/spherical_map.hpp>

namespace shape3d::apps {

PosedMesh posed_mesh(const Mesh& mesh, descriptors::Align align, bool map) {
  PosedMesh result{mesh.V, mesh.F, {}};
  if (align == descriptors::Align::cpca) {
    result.V = mapping::posed(mesh.V, mapping::align(mesh.V, mesh.F));
  }
  if (map) {
    mapping::SphericalMap spherical = mapping::spherical_map(result.V, result.F);
    if (spherical.status != mapping::Status::certified) {
      throw std::runtime_error("has no spherical map: " +
                               std::string(mapping::to_string(spherical.status)));
    }
    result.S = std::move(spherical.S);
  }
  return result;
}

std::vector<Eigen::VectorXd> describe_mesh(const Mesh& mesh,
                                           const std::vector<descriptors::Descriptor>& descriptors,
                                           int threads) {
  descriptors::check_surface(mesh.V, mesh.F);
  std::array<std::optional<PosedMesh>, 2> poses;  // by Align
  std::vector<Eigen::VectorXd> vectors;
  for (const descriptors::Descriptor& descriptor : descriptors) {
    std::optional<PosedMesh>& pose = poses[static_cast<std::size_t>(descriptor.align())];
    const bool map = descriptor.needs_map();
    if (!pose || (map && pose->S.rows() == 0)) pose = posed_mesh(mesh, descriptor.align(), map);
    vectors.push_back(map ? descriptor.compute(pose->V, pose->F, pose->S, threads)
                          : descriptor.compute(pose->V, pose->F, threads));
    if (!vectors.back().allFinite()) {
      throw std::runtime_error("gives numbers that are not finite for " + descriptor.to_string());
    }
  }
  return vectors;
}

}  // namespace shape3d::apps
