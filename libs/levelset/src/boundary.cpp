#include "boundary.hpp"

#include <algorithm>
#include <cmath>

#include "parallel.hpp"
#include "samples.hpp"

namespace shape3d::levelset::detail {
namespace {

constexpr float kFar = 1e30F;

/// Padded copy of an image, ghosts equal to the border.
Field pad_image(const Lattice& lattice, const ImageView& image, int threads) {
  Field field(lattice.padded.size());
  const PaddedLattice& p = lattice.padded;
  parallel_for(p.nz, threads, [&](std::int64_t k) {
    for (std::int64_t j = 0; j < p.ny; ++j) load_row(image, j, k, field.data() + p.index(0, j, k));
  });
  parallel_for(lattice.tiles.size(), threads,
               [&](std::int64_t t) { set_ghosts(lattice, lattice.tiles[t], field.data()); });
  return field;
}

}  // namespace

BoundaryDistance::BoundaryDistance(const ImageView& image, const IntensityModel& model,
                                   double limit, int passes, int threads)
    : lattice_(image.grid()),
      model_(model),
      limit_(static_cast<float>(limit)),
      passes_(passes),
      threads_(threads),
      single_(model.is_split()),
      rising_(!model.inside().empty() && model.inside().back()),
      intensity_(pad_image(lattice_, image, threads)),
      from_(Field::Constant(lattice_.padded.size(), kFar)),
      to_(from_) {
  const auto count = static_cast<std::size_t>(lattice_.tiles.size());
  least_.resize(count);
  greatest_.resize(count);
  const PaddedLattice& p = lattice_.padded;
  const std::int64_t reach = passes + 1;
  parallel_for(lattice_.tiles.size(), threads, [&](std::int64_t t) {
    const Tile tile = lattice_.tiles[t];
    const std::int64_t x0 = std::max<std::int64_t>(tile.x0 - reach, -1);
    const std::int64_t x1 = std::min(tile.x1 + reach, p.nx + 1);
    float least = intensity_[p.index(tile.x0, tile.y0, tile.z0)], greatest = least;
    for (std::int64_t k = std::max<std::int64_t>(tile.z0 - reach, 0);
         k < std::min(tile.z1 + reach, p.nz); ++k) {
      for (std::int64_t j = std::max<std::int64_t>(tile.y0 - reach, 0);
           j < std::min(tile.y1 + reach, p.ny); ++j) {
        const auto row = intensity_.segment(p.index(x0, j, k), x1 - x0);
        least = std::min(least, row.minCoeff());
        greatest = std::max(greatest, row.maxCoeff());
      }
    }
    least_[t] = least;
    greatest_[t] = greatest;
  });
}

void BoundaryDistance::find_tiles(double lambda, const std::vector<double>& levels) {
  std::vector<char> near(least_.size(), 0);
  for (std::size_t t = 0; t < near.size(); ++t) {
    for (const double level : levels)
      if (least_[t] <= level && level <= greatest_[t]) near[t] = 1;
  }
  lambda_ = lambda;
  tiles_ = flagged(near);
}

const std::vector<std::int64_t>& BoundaryDistance::compute(double lambda,
                                                           const std::vector<double>& levels) {
  // Nodes outside the tiles in the list must be far: they bound those inside it.
  parallel_for(static_cast<std::int64_t>(tiles_.size()), threads_, [&](std::int64_t n) {
    const Tile tile = lattice_.tiles[tiles_[n]];
    lattice_.for_rows(tile, [&](std::int64_t row, std::int64_t /*dense*/, int count) {
      std::fill_n(from_.data() + row, count, kFar);
      std::fill_n(to_.data() + row, count, kFar);
    });
  });
  find_tiles(lambda, levels);
  const auto count = static_cast<std::int64_t>(tiles_.size());
  const Field* field = &intensity_;
  LevelOf level{levels.empty() ? 0.0F : static_cast<float>(levels.front()), rising_ ? -1.0F : 1.0F};
  if (!(single_ && levels.size() == 1)) {
    // Several levels: a field whose zeros are at the levels, linear in intensity around each.
    level_field_.resize(intensity_.size());
    parallel_for(lattice_.padded.nz + 2, threads_, [&](std::int64_t slice) {
      for (std::int64_t n = slice * lattice_.padded.slice; n < (slice + 1) * lattice_.padded.slice;
           ++n) {
        level_field_[n] =
            static_cast<float>(model_.signed_level_distance(intensity_[n], levels, lambda));
      }
    });
    field = &level_field_;
    level = {0.0F, -1.0F};
  }
  parallel_for(count, threads_, [&](std::int64_t n) {
    tile_distance_beside(lattice_, lattice_.tiles[tiles_[n]], level, limit_, Far::cut,
                         field->data(), from_.data());
  });
  for (int pass = 0; pass < passes_; ++pass) {
    parallel_for(count, threads_, [&](std::int64_t n) {
      tile_relax(lattice_, lattice_.tiles[tiles_[n]], limit_, from_.data(), to_.data());
    });
    std::swap(from_, to_);
  }
  return tiles_;
}

float BoundaryDistance::side(std::int64_t tile) const {
  return model_.log_odds(least_[tile]) > lambda_ ? -1.0F : 1.0F;
}

}  // namespace shape3d::levelset::detail
