#pragma once

#include <cstdint>

#include "tiles.hpp"

namespace shape3d::levelset::detail {

/// Rows of a tile that hold something among their first, and among their last four nodes.
struct HalfRows {
  RowMask low = 0, high = 0;
};

/// The rows of tile t that hold something, or lie up to `steps` nodes along x from what does: up to
/// 4 as far as halves of rows tell, up to 8 with whole rows.
template <class Halves>
RowMask reach_along_x(const Tiles& tiles, std::int64_t t, int steps, const Halves& halves) {
  const HalfRows own = halves(t);
  RowMask mask = own.low | own.high;
  const std::int64_t left = tiles.beside(t, -1, 0, 0), right = tiles.beside(t, 1, 0, 0);
  if (left >= 0) {
    const HalfRows rows = halves(left);
    mask |= steps > 4 ? rows.low | rows.high : rows.high;
  }
  if (right >= 0) {
    const HalfRows rows = halves(right);
    mask |= steps > 4 ? rows.low | rows.high : rows.low;
  }
  return mask;
}

/// The rows of a tile and of the eight tiles beside it in y and z, to find those within some steps
/// of marked ones. One word a slice; the tile's own rows are bits 8 … 15 of words 9 … 16.
class RowReach {
 public:
  /// @param marked  marked(tile) is the mask of a tile's marked rows.
  template <class Marked>
  RowReach(const Tiles& tiles, std::int64_t t, const Marked& marked) {
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        const std::int64_t tile = tiles.beside(t, 0, y, z);
        const RowMask mask = tile < 0 ? 0 : marked(tile);
        if (mask == 0) continue;
        any_ = true;
        for (int k = 0; k < 8; ++k)
          words_[8 * (z + 1) + k + 1] |= static_cast<std::uint32_t>(mask >> (8 * k) & 0xffU)
                                         << (8 * (y + 1));
      }
    }
  }

  /// Marks the rows beside marked ones, along y, along z, or both. Up to 8 times.
  void grow(bool y, bool z) {
    if (!any_) return;
    std::uint32_t before[26];
    for (int k = 0; k < 26; ++k) before[k] = words_[k];
    if (y)
      for (int k = 0; k < 26; ++k) words_[k] |= before[k] << 1 | before[k] >> 1;
    if (z)
      for (int k = 1; k < 25; ++k) words_[k] |= before[k - 1] | before[k + 1];
  }
  /// The tile's own rows that are marked.
  [[nodiscard]] RowMask mask() const {
    RowMask mask = 0;
    for (int k = 0; k < 8; ++k) mask |= static_cast<RowMask>(words_[9 + k] >> 8 & 0xffU) << (8 * k);
    return mask;
  }

 private:
  std::uint32_t words_[26] = {};  // one more at each end
  bool any_ = false;
};

}  // namespace shape3d::levelset::detail
