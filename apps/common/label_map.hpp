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

}  // namespace shape3d::apps
