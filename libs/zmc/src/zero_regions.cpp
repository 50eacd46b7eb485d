#include "zero_regions.hpp"

#include <algorithm>
#include <vector>

namespace shape3d::zmc::detail {
namespace {

constexpr unsigned kAllZero = 0xFF00u;

bool is_all_zero(const SignLattice& lattice, const CellPlace& p) {
  return (lattice.cell_mask(p.i, p.j, p.k) & kAllZero) == kAllZero;
}

bool is_cell(const SignLattice& lattice, const CellPlace& p) {
  return p.i >= 0 && p.j >= 0 && p.k >= 0 && p.i + 1 < lattice.nx && p.j + 1 < lattice.ny &&
         p.k + 1 < lattice.nz && lattice.cell_valid(p.i, p.j, p.k);
}

CellPlace neighbour(const CellPlace& p, const NeighbourStep& s) {
  return {p.i + s.di, p.j + s.dj, p.k + s.dk};
}

/// Of a cell that is not all zero, by its mask.
int solved_face_sign(const LatticeCells& cells, unsigned mask, const CellPlace& p, int face) {
  const unsigned signs = cells.table().face_signs[cells.table().case_of_mask[mask]];
  if (signs != CellTable::kAmbiguousFaces) {
    return static_cast<int>((signs >> face) & 1u) - static_cast<int>((signs >> (face + 6)) & 1u);
  }
  const CellConfig& config = cells.config_of_mask(mask, p.i, p.j, p.k);
  return ((config.face_positive >> face) & 1) - ((config.face_negative >> face) & 1);
}

}  // namespace

void for_each_all_zero_cell(const SignLattice& lattice, std::int64_t first, std::int64_t last,
                            const std::function<void(const CellPlace&)>& visit) {
  for (std::int64_t k = first; k < std::min(last, lattice.nz - 1); ++k) {
    for (std::int64_t j = 0; j + 1 < lattice.ny; ++j) {
      const std::array<std::int64_t, 4> r{lattice.row(j, k), lattice.row(j + 1, k),
                                          lattice.row(j, k + 1), lattice.row(j + 1, k + 1)};
      unsigned all = kRowZero;
      for (const std::int64_t row : r) all &= lattice.flags[static_cast<std::size_t>(row)];
      if (all == 0) continue;
      for (std::int64_t w = 0; w < lattice.words; ++w) {
        Word zero = below_mask(lattice.nx - 1, w);
        for (const std::int64_t row : r) {
          zero &= load(lattice.z_row(row) + w) & load_next(lattice.z_row(row), w);
        }
        if (lattice.masked) {
          zero &= lattice.cell_bits[static_cast<std::size_t>(r[0] * lattice.words + w)];
        }
        for (; zero != 0; zero &= zero - 1) visit({64 * w + __builtin_ctzll(zero), j, k});
      }
    }
  }
}

int sign_of_solved_neighbour(const LatticeCells& cells, const CellPlace& cell, SeenSigns& seen) {
  int sign = 0;
  for (const NeighbourStep& step : kNeighbourSteps) {
    const CellPlace q = neighbour(cell, step);
    if (!is_cell(cells.lattice(), q)) continue;
    const unsigned mask = cells.lattice().cell_mask(q.i, q.j, q.k);
    if ((mask & kAllZero) == kAllZero) continue;
    const int sees = solved_face_sign(cells, mask, q, step.face_of_neighbour);
    (sees > 0 ? seen.positive : seen.negative) = true;
    if (sign == 0) sign = sees;
  }
  return sign;
}

int face_sign(const LatticeCells& cells, const ZeroRegions& regions, std::int64_t i, std::int64_t j,
              std::int64_t k, int face) {
  const unsigned mask = cells.lattice().cell_mask(i, j, k);
  if ((mask & kAllZero) == kAllZero) return regions.sign(i, cells.lattice().row(j, k));
  return solved_face_sign(cells, mask, {i, j, k}, face);
}

void ZeroRegions::set_uniform(int sign, std::int64_t count) {
  uniform_ = true;
  uniform_sign_ = sign;
  count_ = count;
}

void ZeroRegions::set_single(const SignLattice& lattice, std::int64_t count) {
  uniform_ = false;
  words_ = lattice.words;
  count_ = count;
  positive_.assign(static_cast<std::size_t>(lattice.rows() * lattice.words), Word{0});
  negative_.assign(static_cast<std::size_t>(lattice.rows() * lattice.words), Word{0});
}

void ZeroRegions::solve(const LatticeCells& cells) {
  const SignLattice& lattice = cells.lattice();
  struct Labelled {
    CellPlace place;
    int sign;
  };
  // Distance 1: the signs of solved neighbours.
  std::vector<Labelled> frontier;
  SeenSigns seen;
  std::int64_t count = 0;
  for_each_all_zero_cell(lattice, 0, lattice.nz, [&](const CellPlace& p) {
    ++count;
    const int sign = sign_of_solved_neighbour(cells, p, seen);
    if (sign != 0) frontier.push_back({p, sign});
  });
  if (!(seen.positive && seen.negative)) {
    set_uniform(seen.positive ? 1 : seen.negative ? -1 : 0, count);
    return;
  }
  set_single(lattice, count);

  const auto sign_at = [&](const CellPlace& p) { return sign(p.i, lattice.row(p.j, p.k)); };
  // Writes the signs of a level; keeps each of its cells once.
  const auto commit = [&](std::vector<Labelled>& labels) {
    std::size_t kept = 0;
    for (const Labelled& label : labels) {
      if (sign_at(label.place) != 0) continue;
      set_sign(label.place.i, lattice.row(label.place.j, label.place.k), label.sign);
      labels[kept++] = label;
    }
    labels.resize(kept);
  };
  commit(frontier);
  // Distance n + 1: cells without a sign beside the cells of distance n. All their neighbours that
  // have a sign before the level is committed are at distance n.
  std::vector<Labelled> next;
  while (!frontier.empty()) {
    next.clear();
    for (const Labelled& from : frontier) {
      for (const NeighbourStep& step : kNeighbourSteps) {
        const CellPlace p = neighbour(from.place, step);
        if (!is_cell(lattice, p) || !is_all_zero(lattice, p) || sign_at(p) != 0) continue;
        int sign = 0;
        for (const NeighbourStep& back : kNeighbourSteps) {
          const CellPlace q = neighbour(p, back);
          if (!is_cell(lattice, q) || !is_all_zero(lattice, q)) continue;
          sign = sign_at(q);
          if (sign != 0) break;
        }
        next.push_back({p, sign});  // more than once, with the same sign, where several lead here
      }
    }
    commit(next);
    std::swap(frontier, next);
  }
}

}  // namespace shape3d::zmc::detail
