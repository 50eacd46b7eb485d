#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "shape3d/levelset/image_view.hpp"

namespace shape3d::levelset::detail {

/// A lattice with one ghost node around it, so that every node has neighbours.
struct PaddedLattice {
  std::int64_t nx, ny, nz;
  std::int64_t row, slice;  ///< Nodes from one row, one slice to the next.

  explicit PaddedLattice(const Grid& grid)
      : nx(grid.dims[0]),
        ny(grid.dims[1]),
        nz(grid.dims[2]),
        row(nx + 2),
        slice((nx + 2) * (ny + 2)) {}

  [[nodiscard]] std::int64_t size() const { return slice * (nz + 2); }
  /// Of lattice node (i, j, k); −1 and n are ghosts.
  [[nodiscard]] std::int64_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return (i + 1) + row * (j + 1) + slice * (k + 1);
  }
};

/// Eight floats are what a vector register of AVX2 holds: a row of a tile is one.
constexpr std::int64_t kTileX = 8, kTileY = 8, kTileZ = 8;

/// Nodes lower ≤ (i, j, k) < upper.
struct Tile {
  std::int64_t x0, x1, y0, y1, z0, z1;
};

/// Rows of a tile, one bit each: row (j, k) of the tile is bit j + 8·k.
using RowMask = std::uint64_t;
static_assert(kTileY == 8 && kTileZ == 8);
constexpr RowMask kAllRows = ~RowMask{0};

/// Where the rows of a tile lie: row (j, k) starts at padded + j·row + k·slice of a padded field
/// and at dense + j·dense_row + k·dense_slice of a dense one.
struct TileRows {
  std::int64_t padded, row, slice;
  std::int64_t dense, dense_row, dense_slice;
  int count;    ///< Nodes of a row, up to 8.
  RowMask all;  ///< The rows there are.
};

/// Calls visit(offset in a padded field, offset in a dense one, bit) for the rows of a mask.
template <class Visit>
inline void for_rows(const TileRows& rows, RowMask mask, const Visit& visit) {
  for (RowMask rest = mask & rows.all; rest != 0; rest &= rest - 1) {
    const int bit = __builtin_ctzll(rest), j = bit & 7, k = bit >> 3;
    visit(rows.padded + j * rows.row + k * rows.slice,
          rows.dense + j * rows.dense_row + k * rows.dense_slice, bit);
  }
}

/// The tiling of a lattice, tiles numbered x fastest.
class Tiles {
 public:
  explicit Tiles(const Grid& grid)
      : dims_(grid.dims),
        count_{(dims_[0] + kTileX - 1) / kTileX, (dims_[1] + kTileY - 1) / kTileY,
               (dims_[2] + kTileZ - 1) / kTileZ} {}

  [[nodiscard]] std::int64_t size() const { return count_[0] * count_[1] * count_[2]; }
  [[nodiscard]] Tile operator[](std::int64_t tile) const {
    const std::int64_t x = tile % count_[0] * kTileX, y = tile / count_[0] % count_[1] * kTileY,
                       z = tile / (count_[0] * count_[1]) * kTileZ;
    return {x, std::min(x + kTileX, dims_[0]), y, std::min(y + kTileY, dims_[1]),
            z, std::min(z + kTileZ, dims_[2])};
  }
  /// Flags of the tiles that have a flag or touch one that has, by faces, edges or corners.
  [[nodiscard]] std::vector<char> dilate(const std::vector<char>& flags) const {
    std::vector<char> result = flags, before;
    std::int64_t stride = 1;
    for (const std::int64_t count : count_) {
      before = result;
      for (std::int64_t t = 0; t < size(); ++t) {
        const std::int64_t place = t / stride % count;
        if (place > 0) result[t] |= before[t - stride];
        if (place + 1 < count) result[t] |= before[t + stride];
      }
      stride *= count;
    }
    return result;
  }

  /// The tile at (x, y, z) steps from tile t, or −1 beyond the border.
  [[nodiscard]] std::int64_t beside(std::int64_t t, int x, int y, int z) const {
    const std::int64_t i = t % count_[0] + x, j = t / count_[0] % count_[1] + y,
                       k = t / (count_[0] * count_[1]) + z;
    const bool within =
        i >= 0 && i < count_[0] && j >= 0 && j < count_[1] && k >= 0 && k < count_[2];
    return within ? i + count_[0] * (j + count_[1] * k) : -1;
  }

 private:
  std::array<std::int64_t, 3> dims_, count_;
};

/// Numbers of the tiles with a flag, ascending.
inline std::vector<std::int64_t> flagged(const std::vector<char>& flags) {
  std::vector<std::int64_t> list;
  for (std::size_t t = 0; t < flags.size(); ++t)
    if (flags[t] != 0) list.push_back(static_cast<std::int64_t>(t));
  return list;
}

}  // namespace shape3d::levelset::detail
