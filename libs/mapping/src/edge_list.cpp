#include "edge_list.hpp"

#include <algorithm>

namespace shape3d::mapping::detail {

std::vector<EdgeUse> edge_list(const ConstTriangles& F, const std::vector<bool>& use,
                               Eigen::Index vertices) {
  // Counting sort by the lower vertex, then a short stable sort of each vertex's edges by the
  // other.
  std::vector<std::size_t> begin(static_cast<std::size_t>(vertices) + 1, 0);
  const auto for_each_side = [&](const auto& visit) {
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
      if (!use[static_cast<std::size_t>(t)]) continue;
      for (int i = 0; i < 3; ++i) {
        const std::int32_t a = F(t, i), b = F(t, (i + 1) % 3);
        visit(EdgeUse{std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t),
                      static_cast<std::int8_t>(i), a < b});
      }
    }
  };
  for_each_side([&](const EdgeUse& side) { ++begin[static_cast<std::size_t>(side.low) + 1]; });
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<EdgeUse> uses(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for_each_side(
      [&](const EdgeUse& side) { uses[next[static_cast<std::size_t>(side.low)]++] = side; });
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    std::stable_sort(uses.begin() + static_cast<std::ptrdiff_t>(begin[v]),
                     uses.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]),
                     [](const EdgeUse& a, const EdgeUse& b) { return a.high < b.high; });
  }
  return uses;
}

}  // namespace shape3d::mapping::detail
