#include "boundary.hpp"

#include <algorithm>
#include <cmath>

#include "filter_rows.hpp"
#include "isa.hpp"
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

/// Ranges of the halves of a row and of the nodes beside them.
SHAPE3D_LEVELSET_INLINE RowRanges ranges_of(const float* center, const TileRows& rows, int count) {
  float least[kTileX + 2], greatest[kTileX + 2];
  for (int i = -1; i <= count; ++i) least[i + 1] = greatest[i + 1] = center[i];
  for (const std::int64_t offset : {-rows.row, rows.row, -rows.slice, rows.slice}) {
    for (int i = 0; i < count; ++i) {
      least[i + 1] = std::min(least[i + 1], center[i + offset]);
      greatest[i + 1] = std::max(greatest[i + 1], center[i + offset]);
    }
  }
  const auto range = [&](int first, int last) {
    Range found{least[first], greatest[first]};
    for (int i = first + 1; i < last; ++i) {
      found.least = std::min(found.least, least[i]);
      found.greatest = std::max(found.greatest, greatest[i]);
    }
    return found;
  };
  return {range(0, std::min(count, 4) + 2), range(std::min(count, 4), count + 2)};
}

}  // namespace

BoundaryDistance::BoundaryDistance(const ImageView& image, const IntensityModel& model,
                                   double limit, int passes, std::int64_t max_samples, Use use,
                                   int threads)
    : lattice_(image.grid()),
      model_(model),
      limit_(static_cast<float>(limit)),
      passes_(passes),
      threads_(threads),
      use_(use),
      single_(model.is_split()),
      rising_(!model.inside().empty() && model.inside().back()),
      intensity_(pad_image(lattice_, image, threads)),
      from_(Field::Constant(lattice_.padded.size(), kFar)),
      to_(from_) {
  const auto count = static_cast<std::size_t>(lattice_.tiles.size());
  crossed_.resize(count);
  choose_tiles(max_samples);
  rows_.assign(static_cast<std::size_t>(passes) + 1, std::vector<RowMask>(count, 0));
  if (use == Use::many) note_ranges();
}

void BoundaryDistance::note_ranges() {
  ranges_.resize(kRows * crossed_.size());
  parallel_for(lattice_.tiles.size(), threads_, [&](std::int64_t t) {
    const TileRows rows = lattice_.rows(lattice_.tiles[t]);
    for_rows(rows, allowed(t, passes_), [&](std::int64_t at, std::int64_t /*dense*/, int bit) {
      const float* center = intensity_.data() + at;
      RowRanges& ranges = ranges_[kRows * t + bit];
      ranges = rows.count == kTileX ? ranges_of(center, rows, kTileX)
                                    : ranges_of(center, rows, rows.count);
    });
  });
}

void BoundaryDistance::choose_tiles(std::int64_t max_samples) {
  const std::int64_t size = lattice_.grid.size();
  const std::int64_t every = max_samples > 0 ? (size + max_samples - 1) / max_samples : 1;
  constexpr std::int64_t kBar = 32;
  wanted_.resize(crossed_.size());
  within_.assign(kMostWithin + 1, std::vector<RowMask>(crossed_.size(), kAllRows));
  for (std::int64_t t = 0; t < lattice_.tiles.size(); ++t) {
    const Tile tile = lattice_.tiles[t];
    wanted_[t] = (tile.y0 / kBar + every / 2 * (tile.z0 / kBar)) % every == 0 ? 1 : 0;
  }
  if (every == 1) return;
  parallel_for(lattice_.tiles.size(), threads_, [&](std::int64_t t) {
    RowReach reach(lattice_.tiles, t,
                   [&](std::int64_t tile) { return wanted_[tile] != 0 ? kAllRows : RowMask{0}; });
    within_[0][t] = reach.mask();
    for (std::size_t n = 1; n <= kMostWithin; ++n) {
      reach.grow(true, true);
      within_[n][t] = reach.mask();
    }
  });
}

/// The rows with nodes beside the boundary.
void BoundaryDistance::find_crossed(const std::vector<double>& levels) {
  parallel_for(lattice_.tiles.size(), threads_, [&](std::int64_t t) {
    HalfRows crossed;
    const RowMask all = lattice_.rows(lattice_.tiles[t]).all & allowed(t, passes_);
    for (RowMask rest = all; rest != 0; rest &= rest - 1) {
      const int bit = __builtin_ctzll(rest);
      const RowRanges& ranges = ranges_[kRows * t + bit];
      for (const double level : levels) {
        if (ranges.low.holds(level)) crossed.low |= RowMask{1} << bit;
        if (ranges.high.holds(level)) crossed.high |= RowMask{1} << bit;
      }
    }
    crossed_[t] = crossed;
  });
}

/// Those up to as many passes away.
void BoundaryDistance::find_rows() {
  const auto halves = [&](std::int64_t t) { return crossed_[t]; };
  for (int pass = 0; pass < passes_;) {
    // Up to 8 passes are found at a time; along x they are not told apart.
    const int most = std::min(passes_ - pass, 8);
    const std::vector<RowMask>& from = rows_[pass];
    parallel_for(lattice_.tiles.size(), threads_, [&](std::int64_t t) {
      RowReach reach(lattice_.tiles, t, [&](std::int64_t tile) {
        if (pass == 0) return reach_along_x(lattice_.tiles, tile, most, halves);
        const auto whole = [&](std::int64_t other) { return HalfRows{from[other], from[other]}; };
        return reach_along_x(lattice_.tiles, tile, most, whole);
      });
      if (pass == 0) rows_[0][t] = crossed_[t].low | crossed_[t].high;
      for (int n = 1; n <= most; ++n) {
        reach.grow(true, true);
        rows_[pass + n][t] = reach.mask() & allowed(t, passes_);
      }
    });
    pass += most;
  }
  tiles_.clear();
  for (std::size_t t = 0; t < crossed_.size(); ++t)
    if (rows_.back()[t] != 0) tiles_.push_back(static_cast<std::int64_t>(t));
}

const std::vector<std::int64_t>& BoundaryDistance::compute(double lambda,
                                                           const std::vector<double>& levels) {
  lambda_ = lambda;
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
  const auto start = [&](std::int64_t t, RowMask mask) {
    const Tile tile = lattice_.tiles[t];
    const Beside beside = distance_beside(lattice_.rows(tile), mask, field->data(), level,
                                          lattice_.spacings, limit_, Far::cut, from_.data());
    set_ghosts(lattice_, tile, from_.data());
    return beside;
  };
  if (use_ == Use::once) {
    parallel_for(lattice_.tiles.size(), threads_,
                 [&](std::int64_t t) { crossed_[t] = start(t, allowed(t, passes_)).rows; });
    find_rows();
  } else {
    // What was computed before must not bound what is computed now.
    parallel_for(static_cast<std::int64_t>(tiles_.size()), threads_, [&](std::int64_t n) {
      const TileRows nodes = lattice_.rows(lattice_.tiles[tiles_[n]]);
      for_rows(nodes, rows(tiles_[n]), [&](std::int64_t row, std::int64_t /*dense*/, int) {
        std::fill_n(from_.data() + row, nodes.count, kFar);
        std::fill_n(to_.data() + row, nodes.count, kFar);
      });
    });
    find_crossed(levels);
    find_rows();
    parallel_for(static_cast<std::int64_t>(tiles_.size()), threads_,
                 [&](std::int64_t n) { start(tiles_[n], rows(tiles_[n])); });
  }
  const auto count = static_cast<std::int64_t>(tiles_.size());
  parallel_for(count, threads_, [&](std::int64_t n) {
    const RowMask later = rows(tiles_[n]) & ~rows_[std::min(passes_, 1)][tiles_[n]];
    copy_rows(lattice_.rows(lattice_.tiles[tiles_[n]]), later, from_.data(), to_.data());
  });
  for (int pass = 1; pass <= passes_; ++pass) {
    parallel_for(count, threads_, [&](std::int64_t n) {
      const Tile tile = lattice_.tiles[tiles_[n]];
      const RowMask mask = rows_[pass][tiles_[n]] & allowed(tiles_[n], passes_ - pass);
      relax_distance(lattice_.rows(tile), mask, from_.data(), lattice_.spacings, limit_,
                     to_.data());
      set_ghosts(lattice_, tile, to_.data());
    });
    std::swap(from_, to_);
  }
  return tiles_;
}

Field boundary_bells(const ImageView& image, const IntensityModel& model, double lambda,
                     double width, int threads) {
  const double limit = 2.0 * width;
  // Nodes beside the boundary are up to one from it, and one pass more reaches round corners.
  const int passes =
      std::clamp(static_cast<int>(std::ceil(limit / image.spacing.minCoeff() - 0.2)), 1, 64);
  BoundaryDistance distance(image, model, limit, passes, 0, BoundaryDistance::Use::once, threads);
  distance.compute(lambda, model.levels(lambda));
  const Lattice& lattice = distance.lattice();
  Field result = Field::Zero(lattice.grid.size());
  parallel_for(lattice.tiles.size(), threads, [&](std::int64_t t) {
    const TileRows rows = lattice.rows(lattice.tiles[t]);
    for_rows(rows, distance.rows(t), [&](std::int64_t row, std::int64_t dense, int /*bit*/) {
      float* y = result.data() + dense;
      std::copy_n(distance.field().data() + row, rows.count, y);
      bell(rows.count, static_cast<float>(1.0 / width), static_cast<float>(limit), y);
    });
  });
  return result;
}

float BoundaryDistance::side(std::int64_t padded_row) const {
  return model_.log_odds(intensity_[padded_row]) > lambda_ ? -1.0F : 1.0F;
}

}  // namespace shape3d::levelset::detail
