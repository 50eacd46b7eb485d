#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shape3d/levelset/image_view.hpp"

namespace shape3d::levelset::detail {

/// Where the front may go: nodes that F drives outside (1), inside (−1), or not for certain (0).
using Drive = std::vector<std::int8_t>;

/// @param bound  F counts for certain where |advance| > bound·factor and |advance| > least.
/// @param factor  Empty: 1.
Drive drive_of(const Field& advance, const Field& factor, float bound, float least, int threads);

/// A grid and a coarser one that has a node for each block of up to 2 × 2 × 2 of its nodes.
///
/// A front on the coarser grid moves only through blocks all of whose nodes are driven to the same
/// side, so that it comes to no node where the front of the grid itself would not come.
class Halving {
 public:
  /// Whether an axis can be halved: has eight nodes or more, and its spacing is at most 1.5 times
  /// the least, so that spacings become more alike, not less.
  static bool possible(const Grid& grid);

  /// Halves the axes that can be.
  explicit Halving(const Grid& fine);

  [[nodiscard]] const Grid& coarse() const { return coarse_; }
  /// Nodes of a block, at most.
  [[nodiscard]] std::int64_t block() const { return factor_[0] * factor_[1] * factor_[2]; }

  /// The mean of ψ over each block, ψ cut at the largest coarse spacing.
  [[nodiscard]] Field restrict_front(const Field& psi, int threads) const;

  /// ±1 for blocks that are driven to one side, 0 for the others.
  [[nodiscard]] Field restrict_speed(const Drive& drive, int threads) const;

  /// ψ on the fine grid after the front of the coarse one has moved from `before` to `after`.
  ///
  /// In blocks that changed sides all nodes have the sign of the block. Then the front goes through
  /// the blocks that it stopped at, two nodes far, wherever it is driven. A node on the side that
  /// it is driven to gets ψ = −F·h, so that the front between two such nodes lies where F, linear
  /// between them, is zero; it is at rest there. Other nodes get the distance of their block, and
  /// where nothing has changed they keep theirs, cut as by restrict_front().
  /// @param outside  Nodes beyond the border count as outside; else there are none.
  [[nodiscard]] Field prolong(const Field& psi, const Field& before, const Field& after,
                              const Field& advance, const Drive& drive, bool outside,
                              int threads) const;

 private:
  template <class Visit>
  void for_blocks(int threads, const Visit& visit) const;
  void push(const Drive& drive, bool outside, int threads, std::vector<std::int8_t>& sides) const;

  Grid fine_, coarse_;
  std::array<std::int64_t, 3> factor_{1, 1, 1};
};

}  // namespace shape3d::levelset::detail
