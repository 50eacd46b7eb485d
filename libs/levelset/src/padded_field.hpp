#pragma once

#include <limits>

#include "distance_rows.hpp"
#include "shape3d/levelset/image_view.hpp"
#include "tiles.hpp"

namespace shape3d::levelset::detail {

/// A grid with all that loops over its tiles need.
struct Lattice {
  Grid grid;
  PaddedLattice padded;
  Tiles tiles;
  Spacings spacings;
  /// Ghosts beyond the border take the value of the nearest node, but no less than this, by axis.
  float ghost_floor[3] = {-std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()};

  explicit Lattice(const Grid& g) : grid(g), padded(g), tiles(g), spacings(g.spacing) {}

  /// Calls visit(offset in a padded field, offset in a dense one, length) for each row of a tile.
  template <class Visit>
  void for_rows(const Tile& tile, const Visit& visit) const {
    for_rows(tile, kAllRows, visit, [](std::int64_t, std::int64_t, int) {});
  }
  /// The same for the rows of a mask; other(…) for the others.
  template <class Visit, class Other>
  void for_rows(const Tile& tile, RowMask mask, const Visit& visit, const Other& other) const {
    const int count = static_cast<int>(tile.x1 - tile.x0);
    for (std::int64_t k = tile.z0; k < tile.z1; ++k) {
      for (std::int64_t j = tile.y0; j < tile.y1; ++j) {
        const std::int64_t row = padded.index(tile.x0, j, k), dense = grid.index(tile.x0, j, k);
        if ((mask >> ((j - tile.y0) + kTileY * (k - tile.z0)) & 1) != 0) {
          visit(row, dense, count);
        } else {
          other(row, dense, count);
        }
      }
    }
  }
};

/// Padded copy of a dense field, ghosts set.
Field pad(const Lattice& lattice, const Field& dense, int threads);
/// The reverse.
Field unpad(const Lattice& lattice, const Field& padded, int threads);
/// Sets the ghosts beside a tile at the border.
void set_ghosts(const Lattice& lattice, const Tile& tile, float* field);

/// distance_beside() for the rows of a mask, ghosts set; returns the number of nodes beside the
/// zero set. Other rows are copied with Far::kept, and left alone with Far::cut.
int tile_distance_beside(const Lattice& lattice, const Tile& tile, RowMask mask, LevelOf level,
                         float limit, Far far, const float* field, float* out);
/// relax_distance() for the rows of a mask, ghosts set. Other rows are copied when `copy` says so.
void tile_relax(const Lattice& lattice, const Tile& tile, RowMask mask, bool copy, float limit,
                const float* distance, float* out);

}  // namespace shape3d::levelset::detail
