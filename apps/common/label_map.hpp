#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace shape3d::apps {

/// Samples of a lattice inside (1) and outside (0), x fastest, with the spacing in millimetres.
struct Mask {
  std::vector<std::uint8_t> samples;
  std::array<std::int64_t, 3> dims{0, 0, 0};
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();

  [[nodiscard]] std::int64_t index(const std::array<std::int64_t, 3>& p) const {
    return p[0] + dims[0] * (p[1] + dims[1] * p[2]);
  }
};

/// Number of connected components, samples being neighbours by a face.
[[nodiscard]] std::int64_t count_components(const Mask& mask);

/// The component, by faces, that holds sample `seed`; nothing where that is outside the mask.
/// @throws std::invalid_argument  the seed is not within the lattice.
[[nodiscard]] Mask component_at(const Mask& mask, const std::array<std::int64_t, 3>& seed);

/// The sample inside the mask that is nearest to a place in lattice coordinates, if it is within
/// `reach` millimetres; the first in the order of the lattice of several.
[[nodiscard]] std::optional<std::array<std::int64_t, 3>> nearest_inside(
    const Mask& mask, const Eigen::Vector3d& place, double reach);

/// Opening by a ball: the samples that a ball of this radius covers which lies in the mask, between
/// centres of samples. Beyond the border of the lattice everything counts as inside, so that an
/// object that is cut off there is not rounded.
/// @param radius  mm, 0 or more. @throws std::invalid_argument  otherwise.
/// Cost: two exact distance transforms.
[[nodiscard]] Mask open_by_ball(const Mask& mask, double radius);

/// How nodule_at() cuts a nodule from what it touches, in parts of the radius of the largest ball
/// in the mask that has the seed in its middle.
struct NoduleOptions {
  double vessel_share = 0.5;  ///< Vessels thinner than this are cut off; below 1.
  double wall_share = 1.8;    ///< What holds a ball of this size is wall or a large organ; above 1.
};

struct Nodule {
  Mask mask;                    ///< Empty of samples where the seed is outside the mask.
  double inscribed_radius = 0;  ///< mm, of the ball round the seed that lies in the mask.
  double vessel_radius = 0, wall_radius = 0;  ///< Radii of the two openings, mm.
};

/// The nodule of a mask at a seed: the mask without its opening by a large ball, which is the wall;
/// opened by a small ball, which cuts vessels; the component at the seed.
/// @param seed  A sample inside the mask, near the middle of the nodule: the ball round the best
///        sample within half the ball of the seed is taken.
/// @throws std::invalid_argument  the seed is not within the lattice; a share is out of range.
[[nodiscard]] Nodule nodule_at(const Mask& mask, const std::array<std::int64_t, 3>& seed,
                               const NoduleOptions& options = {});

}  // namespace shape3d::apps
