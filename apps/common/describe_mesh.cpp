#include "describe_mesh.hpp"

#include <array>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>

#include <shape3d/descriptors/voxelize.hpp>
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

namespace {

using descriptors::Descriptor;

// Voxels that several descriptors of one mesh are of.
class SharedVoxels {
 public:
  const descriptors::Voxels& of(const PosedMesh& pose, const Descriptor& descriptor, int threads) {
    descriptors::VoxelizeOptions options = *descriptor.voxels();
    options.threads = threads;
    for (const Made& made : made_) {
      if (made.align == descriptor.align() && same(made.options, options)) return made.voxels;
    }
    made_.push_back({descriptor.align(), options, voxelize(pose.V, pose.F, options)});
    return made_.back().voxels;
  }

 private:
  struct Made {
    descriptors::Align align;
    descriptors::VoxelizeOptions options;
    descriptors::Voxels voxels;
  };
  static bool same(const descriptors::VoxelizeOptions& a, const descriptors::VoxelizeOptions& b) {
    return a.side == b.side && a.fill == b.fill && a.sigma == b.sigma && a.centre == b.centre &&
           a.scale == b.scale && a.factor == b.factor;
  }
  std::deque<Made> made_;
};

}  // namespace

std::vector<Eigen::VectorXd> describe_mesh(const Mesh& mesh,
                                           const std::vector<descriptors::Descriptor>& descriptors,
                                           int threads) {
  descriptors::check_surface(mesh.V, mesh.F);
  std::array<std::optional<PosedMesh>, 2> poses;  // by Align
  SharedVoxels shared;
  std::vector<Eigen::VectorXd> vectors;
  for (const Descriptor& descriptor : descriptors) {
    std::optional<PosedMesh>& pose = poses[static_cast<std::size_t>(descriptor.align())];
    const bool map = descriptor.needs_map();
    if (!pose || (map && pose->S.rows() == 0)) pose = posed_mesh(mesh, descriptor.align(), map);
    if (descriptor.voxels() != nullptr) {
      vectors.push_back(descriptor.compute(shared.of(*pose, descriptor, threads), threads));
    } else {
      vectors.push_back(map ? descriptor.compute(pose->V, pose->F, pose->S, threads)
                            : descriptor.compute(pose->V, pose->F, threads));
    }
    if (!vectors.back().allFinite()) {
      throw std::runtime_error("gives numbers that are not finite for " + descriptor.to_string());
    }
  }
  return vectors;
}

}  // namespace shape3d::apps
