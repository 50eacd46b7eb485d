#include "narrow_band.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parallel.hpp"

namespace shape3d::levelset::detail {
namespace {

/// Distances are made right this many nodes away from those beside the front, which moves by two
/// nodes between two redistancings, in which it also carries what the front left behind.
constexpr int kSpreadingPasses = 3;
/// Redistancings over which the net displacement is looked at, too.
constexpr int kWindow = 8;

}  // namespace

NarrowBand::NarrowBand(const Lattice& lattice, const Field& psi, const Field& advance,
                       const Field& factor, float limit, int threads)
    : lattice_(lattice),
      speed_(advance),
      factor_(factor),
      current_(pad(lattice, psi, threads)),
      next_(lattice.padded.size()),
      limit_(limit),
      slope_(0.5F / static_cast<float>(lattice.grid.spacing.maxCoeff())),
      threads_(threads) {
  const auto count = static_cast<std::size_t>(lattice.tiles.size());
  is_active_.assign(count, 1);
  active_ = flagged(is_active_);
  max_speed_.assign(count, 0.0F);
  near_.assign(count, kAllRows);
  next_near_ = near_;
  calm_.assign(count, 0);
  inside_.assign(count, 0);
  crossed_.assign(count, 0);
  beside_.assign(count, 0);
  volume_.assign(count, 0.0);
  parallel_for(lattice.tiles.size(), threads, [&](std::int64_t t) {
    float greatest = 0.0F;
    lattice.for_rows(lattice.tiles[t], [&](std::int64_t /*row*/, std::int64_t at, int n) {
      for (int i = 0; i < n; ++i) greatest = std::max(greatest, std::abs(advance[at + i]));
    });
    max_speed_[t] = greatest;
  });
  volume_before_ = anchor_ = volume_;
  redistance(-1.0);
}

float NarrowBand::max_speed() const {
  float greatest = 0.0F;
  for (const std::int64_t t : active_) greatest = std::max(greatest, max_speed_[t]);
  return greatest;
}

/// Calls body(tile number, tile, rows to compute) for the active tiles and swaps the buffers. The
/// bodies write next_, and next_near_ of their tile.
template <class Body>
void NarrowBand::for_active(const Body& body) {
  parallel_for(active_tiles(), threads_, [&](std::int64_t n) {
    const std::int64_t t = active_[n];
    body(t, lattice_.tiles[t], lattice_.tiles.with_neighbours(near_, t));
  });
  for (const std::int64_t t : active_) near_[t] = next_near_[t];
  std::swap(current_, next_);
}

namespace {

/// Rows of a tile with a node nearer than the limit, among those of a mask.
RowMask near_rows(const Lattice& lattice, const Tile& tile, RowMask mask, float limit,
                  const float* psi) {
  RowMask near = 0;
  for (std::int64_t k = tile.z0; k < tile.z1; ++k) {
    for (std::int64_t j = tile.y0; j < tile.y1; ++j) {
      const RowMask bit = RowMask{1} << ((j - tile.y0) + kTileY * (k - tile.z0));
      if ((mask & bit) != 0 && count_near(psi + lattice.padded.index(tile.x0, j, k),
                                          static_cast<int>(tile.x1 - tile.x0), limit) > 0)
        near |= bit;
    }
  }
  return near;
}

/// A row that is not computed has all its nodes at the limit, on one side.
void add_far_row(const float* psi, int count, Change& change) {
  if (psi[0] > 0.0F) return;
  change.inside += count;
  change.lanes[0] += static_cast<float>(count);
}

}  // namespace

std::int64_t NarrowBand::advance(const Step& step) {
  const std::int64_t row = lattice_.padded.row, slice = lattice_.padded.slice;
  const Field& factor = factor_.size() > 0 ? factor_ : speed_;  // not read without curvature
  for_active([&](std::int64_t t, const Tile& tile, RowMask mask) {
    Change change;
    lattice_.for_rows(
        tile, mask,
        [&](std::int64_t at, std::int64_t dense, int count) {
          const float* psi = current_.data() + at;
          float* out = next_.data() + at;
          advance_row(psi, row, slice, speed_.data() + dense, factor.data() + dense, count,
                      lattice_.spacings, step, out);
          add_change(psi, out, count, slope_, change);
        },
        [&](std::int64_t at, std::int64_t /*dense*/, int count) {
          std::copy_n(current_.data() + at, count, next_.data() + at);
          add_far_row(current_.data() + at, count, change);
        });
    set_ghosts(lattice_, tile, next_.data());
    next_near_[t] = near_rows(lattice_, tile, mask, limit_, next_.data());
    inside_[t] = change.inside;
    crossed_[t] = change.crossed;
  });
  std::int64_t crossed = 0;
  for (const std::int64_t t : active_) crossed += crossed_[t];
  return crossed;
}

void NarrowBand::spread() {
  for_active([&](std::int64_t t, const Tile& tile, RowMask mask) {
    beside_[t] = tile_distance_beside(lattice_, tile, mask, {}, limit_, Far::kept, current_.data(),
                                      next_.data());
    next_near_[t] = near_rows(lattice_, tile, mask, limit_, next_.data());
  });
  for (int pass = 0; pass < kSpreadingPasses; ++pass) {
    const bool last = pass + 1 == kSpreadingPasses;
    for_active([&](std::int64_t t, const Tile& tile, RowMask mask) {
      tile_relax(lattice_, tile, mask, true, limit_, current_.data(), next_.data());
      next_near_[t] = near_rows(lattice_, tile, mask, limit_, next_.data());
      if (!last) return;
      Change change;
      lattice_.for_rows(
          tile, mask,
          [&](std::int64_t at, std::int64_t /*dense*/, int nodes) {
            add_change(next_.data() + at, next_.data() + at, nodes, slope_, change);
          },
          [&](std::int64_t at, std::int64_t /*dense*/, int nodes) {
            add_far_row(next_.data() + at, nodes, change);
          });
      inside_[t] = change.inside;
      volume_[t] = std::accumulate(change.lanes, change.lanes + 16, 0.0);
    });
  }
}

NarrowBand::Motion NarrowBand::redistance(double rest) {
  spread();
  const bool window_end = ++redistancings_ % kWindow == 0;
  // The volume swept in a tile, over the area of the front in it. A front of any direction crosses
  // 3/2 lattice edges for each face of a node on average, and each of these has a node on both
  // sides: one node beside the front stands for a third of a face.
  const double length = lattice_.grid.mean_spacing();
  Motion motion;
  double swept = 0.0;
  std::vector<char> moving(is_active_.size(), 0);
  for (std::size_t t = 0; t < moving.size(); ++t) {
    motion.nodes += beside_[t];
    if (is_active_[t] == 0) continue;
    const double change = std::abs(volume_[t] - volume_before_[t]) * 3.0 * length;
    volume_before_[t] = volume_[t];
    swept += change;
    if (beside_[t] == 0) continue;
    const double displacement = change / beside_[t];
    motion.greatest = std::max(motion.greatest, displacement);
    // To and fro about the same place, as where an object is one node thin, is rest: a tile whose
    // net displacement over a window was small is calm until it is a tenth of a node from there.
    const double net = std::abs(volume_[t] - anchor_[t]) * 3.0 * length / beside_[t];
    if (net > 0.1 * length) calm_[t] = 0;
    if (window_end && net <= std::max(rest, 0.02 * length)) calm_[t] = 1;
    moving[t] = rest >= 0.0 && calm_[t] != 0 ? 0 : displacement > rest ? 1 : 0;
  }
  motion.mean = motion.nodes > 0 ? swept / static_cast<double>(motion.nodes) : 0.0;
  if (window_end) {
    for (std::size_t t = 0; t < calm_.size(); ++t)
      if (calm_[t] == 0) anchor_[t] = volume_[t];
  }
  std::vector<char> now = lattice_.tiles.dilate(moving);
  settle(is_active_, now);
  is_active_ = std::move(now);
  active_ = flagged(is_active_);
  return motion;
}

/// Tiles that are no longer active get the same values in both buffers. Those that the front has
/// left altogether hold nothing but ±limit.
void NarrowBand::settle(const std::vector<char>& was, const std::vector<char>& now) {
  std::vector<std::int64_t> leaving;
  for (std::size_t t = 0; t < was.size(); ++t)
    if (was[t] != 0 && now[t] == 0) leaving.push_back(static_cast<std::int64_t>(t));
  parallel_for(static_cast<std::int64_t>(leaving.size()), threads_, [&](std::int64_t n) {
    const Tile tile = lattice_.tiles[leaving[n]];
    lattice_.for_rows(tile, [&](std::int64_t at, std::int64_t /*dense*/, int count) {
      std::copy_n(current_.data() + at, count, next_.data() + at);
    });
    set_ghosts(lattice_, tile, next_.data());
  });
}

std::int64_t NarrowBand::inside() const {
  return std::accumulate(inside_.begin(), inside_.end(), std::int64_t{0});
}

Field NarrowBand::copy() const { return unpad(lattice_, current_, threads_); }

Field NarrowBand::take() {
  next_.resize(0);
  return unpad(lattice_, current_, threads_);
}

}  // namespace shape3d::levelset::detail
