#pragma once

#include <array>

#include "shape3d/levelset/image_view.hpp"

namespace shape3d::levelset::detail {

/// A grid and a coarser one that has a node for each block of up to 2 × 2 × 2 of its nodes.
///
/// A front on the coarser grid moves only through blocks all of whose nodes have a speed of the
/// same sign, so that it comes to no node where the front of the grid itself would not come.
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

  /// The mean speed of blocks where advance > bound·factor, or < −bound·factor, at every node; 0
  /// for the others.
  /// @param factor  Empty: 1.
  [[nodiscard]] Field restrict_speed(const Field& advance, const Field& factor, float bound,
                                     int threads) const;

  /// ψ on the fine grid after the front of the coarse one has moved from `before` to `after`.
  ///
  /// In blocks that changed sides all nodes have the sign of the block; in others they keep their
  /// own, and their value where no block beside has changed. The rest have the distance of their
  /// block.
  [[nodiscard]] Field prolong(const Field& psi, const Field& before, const Field& after,
                              int threads) const;

 private:
  template <class Visit>
  void for_blocks(int threads, const Visit& visit) const;

  Grid fine_, coarse_;
  std::array<std::int64_t, 3> factor_{1, 1, 1};
};

}  // namespace shape3d::levelset::detail
