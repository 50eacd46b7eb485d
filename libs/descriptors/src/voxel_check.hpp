#pragma once

#include <stdexcept>
#include <string>

#include "shape3d/descriptors/voxels.hpp"
#include "text.hpp"

namespace shape3d::descriptors::detail {

/// Refuses a side outside kMinSide … kMaxSide.
inline void check_side(int side) { require_between("side", side, kMinSide, kMaxSide); }

/// Refuses voxels whose number of values is not side³, or whose side is not the one expected.
inline void check_voxels(const Voxels& voxels, int side) {
  if (voxels.side != side) {
    throw std::invalid_argument("the voxels have side " + std::to_string(voxels.side) +
                                ", expected " + std::to_string(side));
  }
  const auto n = static_cast<std::size_t>(side);
  if (voxels.values.size() != n * n * n) {
    throw std::invalid_argument("the voxels have " + std::to_string(voxels.values.size()) +
                                " values, expected " + std::to_string(n * n * n));
  }
}

/// Refuses a degree that voxels of this side cannot carry: of two samples a wave along the radius
/// of side/2 voxels.
inline void check_bandwidth(int K, int side) {
  if (K >= 0 && K < (side + 1) / 2) return;
  throw std::invalid_argument("K is " + std::to_string(K) + ", expected 0 … " +
                              std::to_string((side + 1) / 2 - 1) + " for " + std::to_string(side) +
                              " voxels along an axis");
}

}  // namespace shape3d::descriptors::detail
