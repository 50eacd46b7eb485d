#include "narrow_band.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parallel.hpp"

namespace shape3d::levelset::detail {
namespace {

/// Distances are made right this many nodes away from the front; up to 8 steps of half a node lie
/// between two redistancings, in which it also carries what the front left behind.
constexpr int kSpreadingPasses = 3;

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
  volume_before_ = volume_;
  redistance(-1.0);
}

float NarrowBand::max_speed() const {
  float greatest = 0.0F;
  for (const std::int64_t t : active_) greatest = std::max(greatest, max_speed_[t]);
  return greatest;
}

std::int64_t NarrowBand::advance(const Step& step) {
  const std::int64_t row = lattice_.padded.row, slice = lattice_.padded.slice;
  const Field& factor = factor_.size() > 0 ? factor_ : speed_;  // not read without curvature
  parallel_for(active_tiles(), threads_, [&](std::int64_t n) {
    const std::int64_t t = active_[n];
    const Tile tile = lattice_.tiles[t];
    Change change;
    lattice_.for_rows(tile, [&](std::int64_t at, std::int64_t dense, int count) {
      const float* psi = current_.data() + at;
      float* out = next_.data() + at;
      advance_row(psi, row, slice, speed_.data() + dense, factor.data() + dense, count,
                  lattice_.spacings, step, out);
      add_change(psi, out, count, slope_, change);
    });
    set_ghosts(lattice_, tile, next_.data());
    inside_[t] = change.inside;
    crossed_[t] = change.crossed;
  });
  std::swap(current_, next_);
  std::int64_t crossed = 0;
  for (const std::int64_t t : active_) crossed += crossed_[t];
  return crossed;
}

void NarrowBand::spread(const std::vector<std::int64_t>& tiles) {
  const auto count = static_cast<std::int64_t>(tiles.size());
  parallel_for(count, threads_, [&](std::int64_t n) {
    const std::int64_t t = tiles[n];
    beside_[t] = tile_distance_beside(lattice_, lattice_.tiles[t], {}, limit_, Far::kept,
                                      current_.data(), next_.data());
  });
  std::swap(current_, next_);
  for (int pass = 0; pass < kSpreadingPasses; ++pass) {
    const bool last = pass + 1 == kSpreadingPasses;
    parallel_for(count, threads_, [&](std::int64_t n) {
      const std::int64_t t = tiles[n];
      const Tile tile = lattice_.tiles[t];
      tile_relax(lattice_, tile, limit_, current_.data(), next_.data());
      if (!last) return;
      Change change;
      lattice_.for_rows(tile, [&](std::int64_t at, std::int64_t /*dense*/, int nodes) {
        add_change(next_.data() + at, next_.data() + at, nodes, slope_, change);
      });
      inside_[t] = change.inside;
      volume_[t] = std::accumulate(change.lanes, change.lanes + 16, 0.0);
    });
    std::swap(current_, next_);
  }
}

NarrowBand::Motion NarrowBand::redistance(double rest) {
  spread(active_);
  // The volume swept in a tile, over the area of the front in it: half a node's face for each node
  // beside the front, for they lie on both sides.
  const double length = lattice_.grid.mean_spacing();
  Motion motion;
  double swept = 0.0;
  std::vector<char> moving(is_active_.size(), 0);
  for (std::size_t t = 0; t < moving.size(); ++t) {
    motion.nodes += beside_[t];
    if (is_active_[t] == 0) continue;
    const double change = std::abs(volume_[t] - volume_before_[t]) * 2.0 * length;
    volume_before_[t] = volume_[t];
    swept += change;
    const double displacement = beside_[t] > 0 ? change / beside_[t] : 0.0;
    motion.greatest = std::max(motion.greatest, displacement);
    if (beside_[t] > 0 && displacement > rest) moving[t] = 1;
  }
  motion.mean = motion.nodes > 0 ? swept / static_cast<double>(motion.nodes) : 0.0;
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

Field NarrowBand::take() {
  next_.resize(0);
  return unpad(lattice_, current_, threads_);
}

}  // namespace shape3d::levelset::detail
