#include "sparse_zero_regions.hpp"

#include <algorithm>

namespace shape3d::zmc::detail {

void SparseZeroRegions::scan(const LatticeCells& window, std::int64_t window_plane,
                             std::int64_t first, std::int64_t last) {
  for_each_all_zero_cell(window.lattice(), first, last, [&](const CellPlace& p) {
    cells_.push_back(p.i + nx_ * (p.j + ny_ * (p.k + window_plane)));
    signs_.push_back(static_cast<std::int8_t>(sign_of_solved_neighbour(window, p, seen_)));
  });
}

std::size_t SparseZeroRegions::find(std::int64_t i, std::int64_t j, std::int64_t k) const {
  if (i < 0 || j < 0 || k < 0 || i >= nx_ || j >= ny_) return kNone;
  const std::int64_t key = i + nx_ * (j + ny_ * k);
  const auto found = std::lower_bound(cells_.begin(), cells_.end(), key);
  if (found == cells_.end() || *found != key) return kNone;
  return static_cast<std::size_t>(found - cells_.begin());
}

void SparseZeroRegions::solve() {
  if (!(seen_.positive && seen_.negative)) return;
  const auto neighbours = [&](std::size_t cell) {
    const std::int64_t i = cells_[cell] % nx_, row = cells_[cell] / nx_;
    std::array<std::size_t, 6> found{};
    for (std::size_t n = 0; n < found.size(); ++n) {
      const NeighbourStep& step = kNeighbourSteps[n];
      found[n] = find(i + step.di, row % ny_ + step.dj, row / ny_ + step.dk);
    }
    return found;
  };
  std::vector<std::size_t> frontier;
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (signs_[cell] != 0) frontier.push_back(cell);
  }
  struct Labelled {
    std::size_t cell;
    std::int8_t sign;
  };
  std::vector<Labelled> next;
  while (!frontier.empty()) {
    next.clear();
    for (const std::size_t from : frontier) {
      for (const std::size_t cell : neighbours(from)) {
        if (cell == kNone || signs_[cell] != 0) continue;
        for (const std::size_t back : neighbours(cell)) {
          if (back == kNone || signs_[back] == 0) continue;
          next.push_back({cell, signs_[back]});
          break;
        }
      }
    }
    frontier.clear();
    for (const Labelled& label : next) {
      if (signs_[label.cell] != 0) continue;
      signs_[label.cell] = label.sign;
      frontier.push_back(label.cell);
    }
  }
}

void SparseZeroRegions::apply(const SignLattice& window, std::int64_t window_plane,
                              ZeroRegions& regions) const {
  const auto at = [&](std::int64_t plane) {
    return std::lower_bound(cells_.begin(), cells_.end(), nx_ * ny_ * plane) - cells_.begin();
  };
  const auto first = at(window_plane), last = at(window_plane + window.nz - 1);
  if (!(seen_.positive && seen_.negative)) {
    regions.set_uniform(seen_.positive ? 1 : seen_.negative ? -1 : 0, last - first);
    return;
  }
  regions.set_single(window, last - first);
  for (auto cell = first; cell < last; ++cell) {
    const std::int64_t key = cells_[static_cast<std::size_t>(cell)];
    const int sign = signs_[static_cast<std::size_t>(cell)];
    if (sign != 0) regions.set_sign(key % nx_, key / nx_ - ny_ * window_plane, sign);
  }
}

}  // namespace shape3d::zmc::detail
