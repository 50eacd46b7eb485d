#pragma once

#include <array>
#include <cstdint>

#include "label_map.hpp"

namespace shape3d::apps {

/// How nodule_at() cuts a nodule from what it touches, in parts of the radius of the largest ball
/// in the mask that has its middle at the seed or near it and not in the wall.
struct NoduleOptions {
  double vessel_share = 0.5;  ///< Vessels thinner than this are cut off; from 0, below 1.
  double wall_share = 3.0;    ///< What holds a ball of this size is wall or a large organ; above 1.
  /// Radius of the nodule, mm, about; 0: not known. No ball is taken for larger than this, and what
  /// is farther from the seed than twice this is left out.
  double radius = 0.0;
};

struct Nodule {
  Mask mask;  ///< Empty of samples where the seed is outside the mask or in a wall.
  double inscribed_radius = 0;  ///< mm, of the ball near the seed that lies in the mask.
  double vessel_radius = 0, wall_radius = 0;  ///< Radii of the two openings, mm.
};

/// The nodule of a mask at a seed.
///
/// The wall is the opening of the mask by a large ball; beyond the border of the lattice the mask
/// goes on as it is at the border. Of the rest, the samples deeper than the vessel radius and
/// connected to the middle are its core; the nodule is what balls of the vessel radius round the
/// core's samples cover, and one layer of samples more, for an opening rounds an object off.
/// @param seed  A sample inside the mask: the middle is the deepest sample of the rest within half
/// of
///        the seed's ball.
/// @throws std::invalid_argument  the seed is not within the lattice; a share or the radius is out
/// of
///         range.
/// Cost: exact distance transforms, about six.
[[nodiscard]] Nodule nodule_at(const Mask& mask, const std::array<std::int64_t, 3>& seed,
                               const NoduleOptions& options = {});

}  // namespace shape3d::apps
