#include "padded_field.hpp"

#include <algorithm>
#include <cstring>

#include "parallel.hpp"

namespace shape3d::levelset::detail {

Field pad(const Lattice& lattice, const Field& dense, int threads) {
  Field field(lattice.padded.size());
  parallel_for(lattice.tiles.size(), threads, [&](std::int64_t t) {
    const Tile tile = lattice.tiles[t];
    const TileRows rows = lattice.rows(tile);
    for_rows(rows, kAllRows, [&](std::int64_t to, std::int64_t from, int) {
      std::copy_n(dense.data() + from, rows.count, field.data() + to);
    });
    set_ghosts(lattice, tile, field.data());
  });
  return field;
}

Field unpad(const Lattice& lattice, const Field& padded, int threads) {
  Field field(lattice.grid.size());
  parallel_for(lattice.tiles.size(), threads, [&](std::int64_t t) {
    const TileRows rows = lattice.rows(lattice.tiles[t]);
    for_rows(rows, kAllRows, [&](std::int64_t from, std::int64_t to, int) {
      std::copy_n(padded.data() + from, rows.count, field.data() + to);
    });
  });
  return field;
}

void set_ghosts(const Lattice& lattice, const Tile& tile, float* field) {
  const PaddedLattice& p = lattice.padded;
  const float* floor = lattice.ghost_floor;
  const bool low_x = tile.x0 == 0, high_x = tile.x1 == p.nx;
  const bool low_y = tile.y0 == 0, high_y = tile.y1 == p.ny;
  const bool low_z = tile.z0 == 0, high_z = tile.z1 == p.nz;
  if (!(low_x || high_x || low_y || high_y || low_z || high_z)) return;
  if (low_x || high_x) {
    const TileRows rows = lattice.rows(tile);
    const int count = rows.count;
    for_rows(rows, kAllRows, [&](std::int64_t row, std::int64_t /*dense*/, int) {
      if (low_x) field[row - 1] = std::max(field[row], floor[0]);
      if (high_x) field[row + count] = std::max(field[row + count - 1], floor[0]);
    });
  }
  // Rows and slices include the ghosts set before them.
  const std::int64_t x0 = tile.x0 - (low_x ? 1 : 0), x1 = tile.x1 + (high_x ? 1 : 0);
  const auto copy_row = [&](std::int64_t from, std::int64_t to, float least) {
    for (std::int64_t i = 0; i < x1 - x0; ++i) field[to + i] = std::max(field[from + i], least);
  };
  for (std::int64_t k = tile.z0; k < tile.z1; ++k) {
    if (low_y) copy_row(p.index(x0, 0, k), p.index(x0, -1, k), floor[1]);
    if (high_y) copy_row(p.index(x0, p.ny - 1, k), p.index(x0, p.ny, k), floor[1]);
  }
  for (std::int64_t j = tile.y0 - (low_y ? 1 : 0); j < tile.y1 + (high_y ? 1 : 0); ++j) {
    if (low_z) copy_row(p.index(x0, j, 0), p.index(x0, j, -1), floor[2]);
    if (high_z) copy_row(p.index(x0, j, p.nz - 1), p.index(x0, j, p.nz), floor[2]);
  }
}

void copy_rows(const TileRows& rows, RowMask mask, const float* from, float* to) {
  for_rows(rows, mask, [&](std::int64_t at, std::int64_t /*dense*/, int) {
    if (rows.count == kTileX) {
      std::memcpy(to + at, from + at, kTileX * sizeof(float));
    } else {
      std::copy_n(from + at, rows.count, to + at);
    }
  });
}

}  // namespace shape3d::levelset::detail
