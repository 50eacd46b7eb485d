#include "boundary.hpp"

#include <algorithm>
#include <cmath>

#include "parallel.hpp"
#include "samples.hpp"

namespace shape3d::levelset::detail {
namespace {

constexpr float kFar = 1e30F;
constexpr std::int64_t kRows = kTileY * kTileZ;

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
  rows_.assign(count, 0);
  ranges_.resize(kRows * count);
  const std::int64_t row = lattice_.padded.row, slice = lattice_.padded.slice;
  parallel_for(lattice_.tiles.size(), threads, [&](std::int64_t t) {
    const Tile tile = lattice_.tiles[t];
    for (std::int64_t k = tile.z0; k < tile.z1; ++k) {
      for (std::int64_t j = tile.y0; j < tile.y1; ++j) {
        const float* center = intensity_.data() + lattice_.padded.index(tile.x0, j, k);
        const std::int64_t nodes = tile.x1 - tile.x0;
        Range range{std::min(center[-1], center[nodes]), std::max(center[-1], center[nodes])};
        for (const std::int64_t offset : {std::int64_t{0}, -row, row, -slice, slice}) {
          const Eigen::Map<const Field> nearby(center + offset, nodes);
          range.least = std::min(range.least, nearby.minCoeff());
          range.greatest = std::max(range.greatest, nearby.maxCoeff());
        }
        ranges_[kRows * t + (j - tile.y0) + kTileY * (k - tile.z0)] = range;
      }
    }
  });
}

/// The rows with nodes beside the boundary, and those as many passes away.
void BoundaryDistance::find_rows(double lambda, const std::vector<double>& levels) {
  lambda_ = lambda;
  parallel_for(lattice_.tiles.size(), threads_, [&](std::int64_t t) {
    const Tile tile = lattice_.tiles[t];
    RowMask mask = 0;
    for (std::int64_t k = 0; k < tile.z1 - tile.z0; ++k) {
      for (std::int64_t j = 0; j < tile.y1 - tile.y0; ++j) {
        const std::int64_t place = j + kTileY * k;
        const Range& range = ranges_[kRows * t + place];
        for (const double level : levels) {
          if (static_cast<double>(range.least) <= level &&
              level <= static_cast<double>(range.greatest))
            mask |= RowMask{1} << place;
        }
      }
    }
    rows_[t] = mask;
  });
  std::vector<RowMask> before;
  for (int pass = 0; pass < passes_; ++pass) {
    before = rows_;
    for (std::size_t t = 0; t < rows_.size(); ++t)
      rows_[t] = lattice_.tiles.with_neighbours(before, static_cast<std::int64_t>(t));
  }
  tiles_.clear();
  for (std::size_t t = 0; t < rows_.size(); ++t)
    if (rows_[t] != 0) tiles_.push_back(static_cast<std::int64_t>(t));
}

const std::vector<std::int64_t>& BoundaryDistance::compute(double lambda,
                                                           const std::vector<double>& levels) {
  // What was computed before must not bound what is computed now.
  const auto skip = [](std::int64_t, std::int64_t, int) {};
  parallel_for(static_cast<std::int64_t>(tiles_.size()), threads_, [&](std::int64_t n) {
    const std::int64_t t = tiles_[n];
    lattice_.for_rows(
        lattice_.tiles[t], rows_[t],
        [&](std::int64_t row, std::int64_t /*dense*/, int nodes) {
          std::fill_n(from_.data() + row, nodes, kFar);
          std::fill_n(to_.data() + row, nodes, kFar);
        },
        skip);
  });
  find_rows(lambda, levels);
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
    tile_distance_beside(lattice_, lattice_.tiles[tiles_[n]], rows_[tiles_[n]], level, limit_,
                         Far::cut, field->data(), from_.data());
  });
  for (int pass = 0; pass < passes_; ++pass) {
    parallel_for(count, threads_, [&](std::int64_t n) {
      tile_relax(lattice_, lattice_.tiles[tiles_[n]], rows_[tiles_[n]], false, limit_, from_.data(),
                 to_.data());
    });
    std::swap(from_, to_);
  }
  return tiles_;
}

float BoundaryDistance::side(std::int64_t padded_row) const {
  return model_.log_odds(intensity_[padded_row]) > lambda_ ? -1.0F : 1.0F;
}

}  // namespace shape3d::levelset::detail
