#include "place_text.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "common/text.hpp"
#include "samples_at.hpp"

namespace shape3d::apps::viewer {

std::string place_text(const zmc::VolumeView& volume, const Eigen::Vector3d& lattice) {
  const Eigen::Vector3d world = volume.world(lattice);
  char millimetres[128];
  std::snprintf(millimetres, sizeof millimetres, "L %.1f  P %.1f  S %.1f mm", world.x(), world.y(),
                world.z());
  std::array<std::int64_t, 3> sample{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double place = lattice[static_cast<Eigen::Index>(axis)];
    sample[axis] = std::isfinite(place) ? std::llround(place) : -1;
    if (sample[axis] < 0 || sample[axis] >= volume.dims[axis])
      return std::string(millimetres) + "   outside the volume";
  }
  char value[32];
  // Integers in full; reals with the digits of a float.
  std::snprintf(value, sizeof value, "%.7g", sample_at(volume, sample));
  return std::string(millimetres) + "   voxel " + std::to_string(sample[0]) + " " +
         std::to_string(sample[1]) + " " + std::to_string(sample[2]) + "   value " + value;
}

}  // namespace shape3d::apps::viewer
