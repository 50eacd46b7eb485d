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

/// `after` is `sides` with the nodes changed that are driven to the side of one of their
/// neighbours.
void push_row(const std::int8_t* __restrict drive, const std::int8_t* __restrict sides,
              const std::array<const std::int8_t*, 4>& beside, std::int64_t count,
              std::int8_t* __restrict after) {
  const std::int8_t* __restrict below = beside[0];
  const std::int8_t* __restrict above = beside[1];
  const std::int8_t* __restrict behind = beside[2];
  const std::int8_t* __restrict before = beside[3];
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int8_t d = drive[i];
    const int there = static_cast<int>(sides[i - 1] == d) | static_cast<int>(sides[i + 1] == d) |
                      static_cast<int>(below[i] == d) | static_cast<int>(above[i] == d) |
                      static_cast<int>(behind[i] == d) | static_cast<int>(before[i] == d);
    // No node has side 0, so that there is nothing to compare with where d is.
    after[i] = there != 0 ? d : sides[i];
  }
}

}  // namespace

Drive drive_of(const Field& advance, const Field& factor, float bound, float least, int threads) {
  Drive drive(static_cast<std::size_t>(advance.size()));
  constexpr std::int64_t kPart = 1 << 16;
  parallel_for((advance.size() + kPart - 1) / kPart, threads, [&](std::int64_t part) {
    const std::int64_t end = std::min<std::int64_t>((part + 1) * kPart, advance.size());
    for (std::int64_t n = part * kPart; n < end; ++n) {
      const float f = advance[n];
      const float limit = std::max(factor.size() > 0 ? bound * factor[n] : bound, least);
      drive[static_cast<std::size_t>(n)] =
          static_cast<std::int8_t>((f < -limit ? 1 : 0) - (f > limit ? 1 : 0));
    }
  });
  return drive;
}

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

Field Halving::restrict_speed(const Drive& drive, int threads) const {
  Field result(coarse_.size());
  for_blocks(threads, [&](std::int64_t at, const std::int64_t* rows, int count) {
    for (std::int64_t i = 0; i < coarse_.dims[0]; ++i) {
      const std::int64_t last = std::min((i + 1) * factor_[0], fine_.dims[0]);
      int nodes = 0, driven = 0;
      for (int r = 0; r < count; ++r) {
        for (std::int64_t x = i * factor_[0]; x < last; ++x, ++nodes)
          driven += drive[static_cast<std::size_t>(rows[r] + x)];
      }
      result[at + i] = driven == nodes ? -1.0F : (driven == -nodes ? 1.0F : 0.0F);
    }
  });
  return result;
}

/// Two passes of push_row() over all rows.
void Halving::push(const Drive& drive, bool outside, int threads,
                   std::vector<std::int8_t>& sides) const {
  const std::int64_t nx = fine_.dims[0], ny = fine_.dims[1], nz = fine_.dims[2];
  std::vector<std::int8_t> after(sides.size());
  for (int pass = 0; pass < 2; ++pass) {
    parallel_for(nz, threads, [&](std::int64_t k) {
      // Beyond the border: outside, or no side at all.
      const std::int8_t beyond = outside ? 1 : 2;
      const std::vector<std::int8_t> none(static_cast<std::size_t>(nx), beyond);
      std::vector<std::int8_t> row(static_cast<std::size_t>(nx + 2), beyond);
      for (std::int64_t j = 0; j < ny; ++j) {
        const std::int64_t at = fine_.index(0, j, k);
        std::copy_n(sides.data() + at, nx, row.data() + 1);
        const std::array<const std::int8_t*, 4> beside = {
            j > 0 ? sides.data() + at - nx : none.data(),
            j + 1 < ny ? sides.data() + at + nx : none.data(),
            k > 0 ? sides.data() + at - nx * ny : none.data(),
            k + 1 < nz ? sides.data() + at + nx * ny : none.data()};
        push_row(drive.data() + at, row.data() + 1, beside, nx, after.data() + at);
      }
    });
    sides.swap(after);
  }
}

Field Halving::prolong(const Field& psi, const Field& before, const Field& after,
                       const Field& advance, const Drive& drive, bool outside, int threads) const {
  std::vector<std::int8_t> sides(static_cast<std::size_t>(fine_.size()));
  const int shift = factor_[0] == 2 ? 1 : 0;
  const auto has_changed = [&](std::int64_t block) {
    return (before[block] <= 0.0F) != (after[block] <= 0.0F);
  };
  for_blocks(threads, [&](std::int64_t at, const std::int64_t* rows, int count) {
    for (int r = 0; r < count; ++r) {
      for (std::int64_t x = 0; x < fine_.dims[0]; ++x) {
        const std::int64_t block = at + (x >> shift);
        const float of = has_changed(block) ? after[block] : psi[rows[r] + x];
        sides[static_cast<std::size_t>(rows[r] + x)] = of <= 0.0F ? -1 : 1;
      }
    }
  });
  push(drive, outside, threads, sides);

  const auto step = static_cast<float>(fine_.spacing.minCoeff());
  const auto limit = static_cast<float>(coarse_.spacing.maxCoeff());
  const float least = 0.05F * step;  // a node that is not zero must not become one
  Field result(fine_.size());
  for_blocks(threads, [&](std::int64_t at, const std::int64_t* rows, int count) {
    for (int r = 0; r < count; ++r) {
      for (std::int64_t x = 0; x < fine_.dims[0]; ++x) {
        const std::int64_t block = at + (x >> shift), node = rows[r] + x;
        const std::int8_t side = sides[static_cast<std::size_t>(node)];
        if (drive[static_cast<std::size_t>(node)] == side) {
          result[node] = -advance[node] * step;
        } else if (has_changed(block)) {
          result[node] = side * std::max(std::abs(after[block]), least);
        } else {
          result[node] = std::clamp(psi[node], -limit, limit);
        }
      }
    }
  });
  return result;
}

}  // namespace shape3d::levelset::detail
