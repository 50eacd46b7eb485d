#pragma once

#include <cstdint>
#include <vector>

#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping::detail {

/// A side of a triangle: from corner `side` to the next one.
struct EdgeUse {
  std::int32_t low = 0, high = 0;  ///< Vertices, low < high.
  std::int32_t triangle = 0;
  std::int8_t side = 0;
  bool forward = true;  ///< The triangle runs from low to high.
};

/// The sides of the triangles that `use` marks, those of one edge together, in the order of
/// triangles. Such triangles have three different indices.
std::vector<EdgeUse> edge_list(const ConstTriangles& F, const std::vector<bool>& use,
                               Eigen::Index vertices);

/// Calls visit(begin, end) for the uses of each edge.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, const Visit& visit) {
  for (std::size_t begin = 0; begin < uses.size();) {
    std::size_t end = begin + 1;
    while (end < uses.size() && uses[end].low == uses[begin].low &&
           uses[end].high == uses[begin].high) {
      ++end;
    }
    visit(uses.data() + begin, uses.data() + end);
    begin = end;
  }
}

}  // namespace shape3d::mapping::detail
