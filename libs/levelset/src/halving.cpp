#include "halving.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "parallel.hpp"

namespace shape3d::levelset::detail {
namespace {

constexpr std::int64_t kLeastNodes = 8;

bool can_halve(const Grid& grid, std::size_t axis) {
  return grid.dims[axis] >= kLeastNodes &&
         grid.spacing[static_cast<Eigen::Index>(axis)] <= 1.5 * grid.spacing.minCoeff();
}

}  // namespace

bool Halving::possible(const Grid& grid) {
  return can_halve(grid, 0) || can_halve(grid, 1) || can_halve(grid, 2);
}

Halving::Halving(const Grid& fine) : fine_(fine), coarse_(fine) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!can_halve(fine, axis)) continue;
    factor_[axis] = 2;
    coarse_.dims[axis] = (fine.dims[axis] + 1) / 2;
    coarse_.spacing[static_cast<Eigen::Index>(axis)] *= 2.0;
  }
}

/// Calls visit(coarse row, rows, count) for each row of blocks: the first fine nodes of the rows
/// that the blocks are made of.
template <class Visit>
void Halving::for_blocks(int threads, const Visit& visit) const {
  parallel_for(coarse_.dims[2], threads, [&](std::int64_t k) {
    std::array<std::int64_t, 4> rows{};
    for (std::int64_t j = 0; j < coarse_.dims[1]; ++j) {
      int count = 0;
      for (std::int64_t z = k * factor_[2]; z < std::min((k + 1) * factor_[2], fine_.dims[2]); ++z)
        for (std::int64_t y = j * factor_[1]; y < std::min((j + 1) * factor_[1], fine_.dims[1]);
             ++y)
          rows[static_cast<std::size_t>(count++)] = fine_.index(0, y, z);
      visit(coarse_.index(0, j, k), rows.data(), count);
    }
  });
}

Field Halving::restrict_front(const Field& psi, int threads) const {
  const auto limit = static_cast<float>(coarse_.spacing.maxCoeff());
  Field result(coarse_.size());
  for_blocks(threads, [&](std::int64_t at, const std::int64_t* rows, int count) {
    for (std::int64_t i = 0; i < coarse_.dims[0]; ++i) {
      const std::int64_t last = std::min((i + 1) * factor_[0], fine_.dims[0]);
      float sum = 0.0F;
      int nodes = 0;
      for (int r = 0; r < count; ++r) {
        for (std::int64_t x = i * factor_[0]; x < last; ++x, ++nodes)
          sum += std::clamp(psi[rows[r] + x], -limit, limit);
      }
      result[at + i] = sum / static_cast<float>(nodes);
    }
  });
  return result;
}

Field Halving::restrict_speed(const Field& advance, const Field& factor, float bound,
                              int threads) const {
  Field result(coarse_.size());
  for_blocks(threads, [&](std::int64_t at, const std::int64_t* rows, int count) {
    for (std::int64_t i = 0; i < coarse_.dims[0]; ++i) {
      const std::int64_t last = std::min((i + 1) * factor_[0], fine_.dims[0]);
      float sum = 0.0F;
      int nodes = 0, rising = 0, falling = 0;
      for (int r = 0; r < count; ++r) {
        for (std::int64_t x = i * factor_[0]; x < last; ++x, ++nodes) {
          const float f = advance[rows[r] + x];
          const float least = factor.size() > 0 ? bound * factor[rows[r] + x] : bound;
          sum += f;
          rising += f > least ? 1 : 0;
          falling += f < -least ? 1 : 0;
        }
      }
      const bool moves = rising == nodes || falling == nodes;
      result[at + i] = moves ? sum / static_cast<float>(nodes) : 0.0F;
    }
  });
  return result;
}

Field Halving::prolong(const Field& psi, const Field& before, const Field& after,
                       int threads) const {
  // Blocks that changed sides (1), and those beside them (2).
  std::vector<char> mark(static_cast<std::size_t>(coarse_.size()));
  for (Eigen::Index n = 0; n < after.size(); ++n)
    mark[static_cast<std::size_t>(n)] = (before[n] <= 0.0F) != (after[n] <= 0.0F) ? 1 : 0;
  const std::vector<char> changed = mark;
  parallel_for(coarse_.dims[2], threads, [&](std::int64_t k) {
    for (std::int64_t j = 0; j < coarse_.dims[1]; ++j) {
      for (std::int64_t i = 0; i < coarse_.dims[0]; ++i) {
        const std::int64_t at = coarse_.index(i, j, k);
        if (changed[at] != 0) continue;
        const auto is_changed = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
          return x >= 0 && x < coarse_.dims[0] && y >= 0 && y < coarse_.dims[1] && z >= 0 &&
                 z < coarse_.dims[2] && changed[coarse_.index(x, y, z)] != 0;
        };
        if (is_changed(i - 1, j, k) || is_changed(i + 1, j, k) || is_changed(i, j - 1, k) ||
            is_changed(i, j + 1, k) || is_changed(i, j, k - 1) || is_changed(i, j, k + 1))
          mark[at] = 2;
      }
    }
  });
  // A node that is not zero must not become one.
  const auto least = static_cast<float>(0.05 * fine_.spacing.minCoeff());
  Field result(fine_.size());
  for_blocks(threads, [&](std::int64_t at, const std::int64_t* rows, int count) {
    for (int r = 0; r < count; ++r) {
      for (std::int64_t x = 0; x < fine_.dims[0]; ++x) {
        const std::int64_t block = at + x / factor_[0];
        const float own = psi[rows[r] + x];
        const float distance = std::max(std::abs(after[block]), least);
        const bool inside = mark[block] == 1 ? after[block] <= 0.0F : own <= 0.0F;
        result[rows[r] + x] = mark[block] == 0 ? own : (inside ? -distance : distance);
      }
    }
  });
  return result;
}

}  // namespace shape3d::levelset::detail
