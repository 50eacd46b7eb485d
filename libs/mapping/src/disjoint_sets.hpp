#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace shape3d::mapping::detail {

/// Union-find; each element also has a parity against the root of its set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size), parity_(size, 0) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }

  /// The root of x, and whether x has the other parity.
  [[nodiscard]] std::pair<std::uint32_t, bool> find(std::uint32_t x) {
    std::uint32_t root = x;
    std::uint8_t parity = 0;
    while (parent_[root] != root) {
      parity ^= parity_[root];
      root = parent_[root];
    }
    std::uint8_t rest = parity;
    while (parent_[x] != root) {  // path compression
      const std::uint32_t next = parent_[x];
      const std::uint8_t own = parity_[x];
      parent_[x] = root;
      parity_[x] = rest;
      rest ^= own;
      x = next;
    }
    return {root, parity != 0};
  }

  [[nodiscard]] std::uint32_t root(std::uint32_t x) { return find(x).first; }

  /// Joins the sets of a and b; `differ`: they have different parity.
  /// @return  false when they were joined before with the other relation.
  bool join(std::uint32_t a, std::uint32_t b, bool differ = false) {
    const auto [root_a, parity_a] = find(a);
    const auto [root_b, parity_b] = find(b);
    if (root_a == root_b) return (parity_a != parity_b) == differ;
    const auto [low, high] = std::minmax(root_a, root_b);
    parent_[high] = low;
    parity_[high] = (parity_a != parity_b) != differ ? 1 : 0;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> parity_;
};

}  // namespace shape3d::mapping::detail
