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

  [[nodiscard]] TileRows rows(const Tile& tile) const {
    RowMask slice_mask = (RowMask{1} << (tile.y1 - tile.y0)) - 1, all = 0;
    for (std::int64_t k = 0; k < tile.z1 - tile.z0; ++k) all |= slice_mask << (kTileY * k);
    return {padded.index(tile.x0, tile.y0, tile.z0), padded.row,   padded.slice,
            grid.index(tile.x0, tile.y0, tile.z0),   grid.dims[0], grid.dims[0] * grid.dims[1],
            static_cast<int>(tile.x1 - tile.x0),     all};
  }
};

/// Padded copy of a dense field, ghosts set.
Field pad(const Lattice& lattice, const Field& dense, int threads);
/// The reverse.
Field unpad(const Lattice& lattice, const Field& padded, int threads);
/// Sets the ghosts beside a tile at the border.
void set_ghosts(const Lattice& lattice, const Tile& tile, float* field);

/// Copies the rows of a mask of a padded field.
void copy_rows(const TileRows& rows, RowMask mask, const float* from, float* to);

}  // namespace shape3d::levelset::detail
