#pragma once

#include <algorithm>
#include <cmath>

#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping::detail {

/// A power of two that brings the largest coordinate to 1 … 2, so that predicates neither overflow
/// nor vanish; multiplying and dividing by it is exact.
inline double scale_of(const ConstPoints& V) {
  const double largest = V.rows() == 0 ? 0.0 : V.cwiseAbs().maxCoeff();
  return largest > 0.0 ? std::ldexp(1.0, std::max(std::ilogb(largest), -1021)) : 1.0;
}

}  // namespace shape3d::mapping::detail
