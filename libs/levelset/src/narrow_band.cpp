#include "narrow_band.hpp"

#include <algorithm>
#include <cmath>

#include "parallel.hpp"
#include "row_reach.hpp"

namespace shape3d::levelset::detail {
namespace {

/// Redistancings over which the mean place of the front is looked at, too.
constexpr int kWindow = 4;

}  // namespace

NarrowBand::NarrowBand(const Lattice& lattice, Field psi, const Field& advance, const Field& factor,
                       float limit, double reach, int threads)
    : lattice_(lattice),
      speed_(advance),
      factor_(factor),
      current_(pad(lattice, psi, threads)),
      next_(lattice.padded.size()),
      limit_(limit),
      threads_(threads) {
  psi = Field();
  const Eigen::Vector3d& h = lattice.grid.spacing;
  // A ramp as wide as the largest spacing has the same sum wherever a plane lies between nodes; in
  // nodes it must not be wider than the rows that are computed.
  width_ =
      static_cast<float>(std::min(std::max(h.minCoeff(), 0.5 * h.maxCoeff()), 3.0 * h.minCoeff()));
  for (int axis = 0; axis < 3; ++axis) {
    steps_[axis] = std::clamp(static_cast<int>(std::lround(std::sqrt(3.0) * reach / h[axis])), 1,
                              kMostPasses - 1);
  }
  const auto count = static_cast<std::size_t>(lattice.tiles.size());
  Reaches all;
  all.fill(kAllRows);
  rows_.assign(count, all);
  near_.assign(count, kAllRows);
  tallies_.resize(count);
  changes_.resize(count);
  tile_speed_.assign(count, 0.0F);
  parallel_for(lattice.tiles.size(), threads, [&](std::int64_t t) {
    float greatest = 0.0F;
    const TileRows rows = lattice.rows(lattice.tiles[t]);
    for_rows(rows, kAllRows, [&](std::int64_t /*padded*/, std::int64_t at, int) {
      for (int i = 0; i < rows.count; ++i) greatest = std::max(greatest, std::abs(advance[at + i]));
    });
    tile_speed_[t] = greatest;
  });
  is_active_.assign(count, 1);
  is_moving_.assign(count, 1);
  active_ = flagged(is_active_);
  spread(Far::cut, 0.0);
  for (Tally& tally : tallies_)
    tally.volume_before = tally.window_start = tally.mean = tally.now.volume;
  for (Tally& tally : tallies_) tally.moving = kAllRows;
  for (std::size_t t = 0; t < count; ++t) is_moving_[t] = tallies_[t].beside.nodes > 0 ? 1 : 0;
  activate();
}

/// Calls body(tile number, tile, rows) for the active tiles and swaps the buffers.
template <class Body>
void NarrowBand::for_active(const Body& body) {
  parallel_for(active_tiles(), threads_, [&](std::int64_t n) {
    const std::int64_t t = active_[n];
    const Tile tile = lattice_.tiles[t];
    body(t, lattice_.rows(tile));
    set_ghosts(lattice_, tile, next_.data());
  });
  std::swap(current_, next_);
}

std::int64_t NarrowBand::advance(const Step& step) {
  const Field& factor = factor_.size() > 0 ? factor_ : speed_;  // not read without curvature
  for_active([&](std::int64_t t, const TileRows& rows) {
    changes_[t] = advance_rows(rows, rows_[t].back(), current_.data(), speed_.data(), factor.data(),
                               lattice_.spacings, step, next_.data());
  });
  std::int64_t crossed = 0;
  for (const std::int64_t t : active_) {
    crossed += changes_[t].crossed;
    inside_ += changes_[t].inside;
    tallies_[t].now.inside += changes_[t].inside;
  }
  return crossed;
}

/// The rows of tile t by their distance from rows with a node beside the front: those that move,
/// or all. Along x, four nodes are as near as can be told.
NarrowBand::Reaches NarrowBand::reaches(std::int64_t t, bool moving) const {
  const auto halves = [&](std::int64_t tile) {
    const Tally& tally = tallies_[tile];
    if (!moving) return tally.beside.rows;
    if (is_moving_[tile] == 0) return HalfRows{};
    return HalfRows{tally.beside.rows.low & tally.moving, tally.beside.rows.high & tally.moving};
  };
  RowReach reach(lattice_.tiles, t, [&](std::int64_t tile) {
    return reach_along_x(lattice_.tiles, tile, steps_[0], halves);
  });
  Reaches rows;
  const int passes = std::max(steps_[1], steps_[2]);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    if (pass < passes) reach.grow(pass < steps_[1], pass < steps_[2]);
    rows[pass] = reach.mask();
  }
  return rows;
}

/// ψ becomes a distance: beside the front, and outwards from there by a node a pass, one less than
/// the front may go.
void NarrowBand::spread(Far far, double rest) {
  for_active([&](std::int64_t t, const TileRows& rows) {
    tallies_[t].beside.replace(rows_[t].back() & rows.all,
                               distance_beside(rows, rows_[t].back(), current_.data(), {},
                                               lattice_.spacings, limit_, far, next_.data()));
  });
  const int passes = std::max({steps_[0], steps_[1], steps_[2], 2}) - 1;
  for (int pass = 0; pass < passes; ++pass) {
    for_active([&](std::int64_t t, const TileRows& rows) {
      if (pass == 0) {
        const RowMask before = rows_[t].back();
        rows_[t] = reaches(t, true);
        near_[t] = reaches(t, false).back();
        copy_rows(rows, before & ~rows_[t][0], current_.data(), next_.data());
      }
      relax_distance(rows, rows_[t][pass], current_.data(), lattice_.spacings, limit_,
                     next_.data());
      if (pass + 1 < passes) return;
      measure(t, rows, rest);
    });
  }
  inside_ = 0;
  for (const Tally& tally : tallies_) inside_ += tally.now.inside;
}

/// The front in tile t, and the rows where it has moved by more than `rest` mm.
void NarrowBand::measure(std::int64_t t, const TileRows& rows, double rest) {
  Tally& tally = tallies_[t];
  RowMeasures by_row;
  tally.now = measure_rows(rows, near_[t], next_.data(), width_, by_row);
  for_rows(rows, ~near_[t], [&](std::int64_t at, std::int64_t /*dense*/, int bit) {
    // Rows that are not near lie on one side of the front.
    if (next_[at] > 0.0F) return;
    tally.now.inside += rows.count;
    tally.now.volume += rows.count;
    by_row.volume[bit] = static_cast<float>(rows.count);
  });
  tally.moving = 0;
  for (std::size_t bit = 0; bit < 64; ++bit) {
    const int nodes = std::max({int{by_row.near[bit]}, tally.beside.by_row[bit] / 2, 1});
    const double swept = std::abs(static_cast<double>(by_row.volume[bit] - tally.row_volume[bit]));
    if (swept * 2.0 * static_cast<double>(width_) > rest * nodes) tally.moving |= RowMask{1} << bit;
    tally.row_volume[bit] = by_row.volume[bit];
  }
}

/// Whether the front still moves in a tile.
///
/// The displacement is the volume swept over the area. In nodes: a plane of area A has A·2w/V nodes
/// nearer than w, V the volume of a cell, whatever its direction; half of those beside it, at
/// least, also where the border of the volume hides some.
bool NarrowBand::is_moving(Tally& tally, double rest, bool window_end, Motion& motion) const {
  const double per_node =
      2.0 * static_cast<double>(width_) / std::max({tally.now.near, tally.beside.nodes / 2, 1});
  const double displacement = std::abs(tally.now.volume - tally.volume_before) * per_node;
  motion.greatest = std::max(motion.greatest, displacement);
  tally.path += std::abs(tally.now.volume - tally.volume_before);
  // To and fro about the same place, as where an object is one node thin, is rest, too: a tile
  // that ends a window less than half of its path away from where it began, and whose mean over the
  // window is that of the window before, is calm until it is half a node from there, and each time
  // twice as far.
  if (tally.calm) {
    const double away = std::abs(tally.now.volume - tally.mean) * per_node;
    tally.calm = away <= std::ldexp(0.25 * lattice_.grid.spacing.minCoeff(), tally.calmed);
  }
  tally.sum += tally.now.volume;
  if (window_end) {
    const double mean = tally.sum / kWindow;
    tally.sum = 0.0;
    if (!tally.calm) {
      tally.calm = std::abs(tally.now.volume - tally.window_start) < 0.5 * tally.path &&
                   std::abs(mean - tally.mean) * per_node <= window_rest_;
      if (tally.calm) tally.calmed = std::min(tally.calmed + 1, 8);
      tally.mean = mean;
    }
    tally.path = 0.0;
    tally.window_start = tally.now.volume;
  }
  return displacement > rest && !tally.calm;
}

NarrowBand::Motion NarrowBand::redistance(double rest) {
  spread(Far::kept, rest);
  window_rest_ += rest;
  const bool window_end = ++redistancings_ % kWindow == 0;
  Motion motion;
  double swept = 0.0, near = 0.0;
  for (std::size_t t = 0; t < is_active_.size(); ++t) {
    Tally& tally = tallies_[t];
    motion.nodes += tally.beside.nodes;
    near += tally.now.near;
    if (is_active_[t] == 0) {
      tally.sum = window_end ? 0.0 : tally.sum + tally.now.volume;
      if (window_end) {
        tally.path = 0.0;
        tally.window_start = tally.now.volume;
      }
      continue;
    }
    is_moving_[t] = is_moving(tally, rest, window_end, motion) ? 1 : 0;
    swept += std::abs(tally.now.volume - tally.volume_before);
    tally.volume_before = tally.now.volume;
  }
  motion.mean = near > 0.0 ? swept * 2.0 * static_cast<double>(width_) / near : 0.0;
  if (window_end) window_rest_ = 0.0;
  activate();
  return motion;
}

/// Chooses the rows that are computed from now on. Those that no longer are get the same values in
/// both buffers.
void NarrowBand::activate() {
  const std::vector<char> beside_moving = lattice_.tiles.dilate(is_moving_);
  parallel_for(lattice_.tiles.size(), threads_, [&](std::int64_t t) {
    const RowMask before = is_active_[t] != 0 ? rows_[t].back() : 0;
    rows_[t] = beside_moving[t] != 0 ? reaches(t, true) : Reaches{};
    const TileRows rows = lattice_.rows(lattice_.tiles[t]);
    if ((rows_[t].back() & rows.all) == 0) rows_[t] = {};
    const RowMask left = before & ~rows_[t].back();
    if (left == 0) return;
    copy_rows(rows, left, current_.data(), next_.data());
    set_ghosts(lattice_, lattice_.tiles[t], next_.data());
  });
  max_speed_ = 0.0F;
  computed_nodes_ = 0;
  for (std::size_t t = 0; t < is_active_.size(); ++t) {
    is_active_[t] = rows_[t].back() != 0 ? 1 : 0;
    if (is_active_[t] == 0) continue;
    max_speed_ = std::max(max_speed_, tile_speed_[t]);
    const TileRows rows = lattice_.rows(lattice_.tiles[static_cast<std::int64_t>(t)]);
    computed_nodes_ += rows.count * __builtin_popcountll(rows_[t].back() & rows.all);
  }
  active_ = flagged(is_active_);
}

Field NarrowBand::copy() const { return unpad(lattice_, current_, threads_); }

Field NarrowBand::take() {
  parallel_for(lattice_.tiles.size(), threads_, [&](std::int64_t t) {
    const TileRows rows = lattice_.rows(lattice_.tiles[t]);
    for_rows(rows, ~reaches(t, false).back(), [&](std::int64_t at, std::int64_t /*dense*/, int) {
      std::fill_n(current_.data() + at, rows.count, current_[at] > 0.0F ? limit_ : -limit_);
    });
  });
  next_.resize(0);
  return unpad(lattice_, current_, threads_);
}

}  // namespace shape3d::levelset::detail
