#pragma once

// The cells of one cell row, 64 at a time.

#include <array>

#include "sign_lattice.hpp"

#define SHAPE3D_ZMC_INLINE inline __attribute__((always_inline))

namespace shape3d::zmc::detail {

/// The lattice rows round a cell row: (j, k), (j + 1, k), (j, k + 1), (j + 1, k + 1).
struct CellRow {
  std::array<std::int64_t, 4> row{};
  std::array<const Word*, 4> n{}, z{};
  const Word* valid = nullptr;  ///< Bits of cells without a masked sample, or null.
  unsigned any_flags = 0;
};

inline CellRow cell_row(const SignLattice& lattice, std::int64_t j, std::int64_t k) {
  CellRow c;
  c.row = {lattice.row(j, k), lattice.row(j + 1, k), lattice.row(j, k + 1),
           lattice.row(j + 1, k + 1)};
  for (int r = 0; r < 4; ++r) {
    c.n[r] = lattice.n_row(c.row[r]);
    c.z[r] = lattice.z_row(c.row[r]);
    c.any_flags |= lattice.flags[static_cast<std::size_t>(c.row[r])];
  }
  if (lattice.masked) c.valid = lattice.cell_bits.data() + c.row[0] * lattice.words;
  return c;
}

/// Signs of the corners of 64 cells, by corner bit: 0 … 3 at x = i on the four rows, 4 … 7 at x = i
/// + 1. The z words are only filled with Zeros; n is then free of the marks of used zeros, which
/// stay in `used`.
struct CellWords {
  std::array<Word, 8> n{}, z{};
  std::array<Word, 4> used{};
  Word active = 0;     ///< Cells with both signs: they contain patches.
  Word with_zero = 0;  ///< Cells with a zero sample.
};

template <bool Zeros>
SHAPE3D_ZMC_INLINE CellWords cell_words(const CellRow& row, std::int64_t w, Word in_cells) {
  CellWords c;
  Word any_negative = 0, any_positive = 0;
  for (int r = 0; r < 4; ++r) {
    c.n[r] = load(row.n[r] + w);
    c.n[r + 4] = load_next(row.n[r], w);
    if constexpr (Zeros) {
      c.z[r] = row.z[r][w];
      c.z[r + 4] = load_next(row.z[r], w);
      c.used[r] = c.n[r] & c.z[r];
      c.n[r] &= ~c.z[r];
      c.n[r + 4] &= ~c.z[r + 4];
      c.with_zero |= c.z[r] | c.z[r + 4];
    }
    any_negative |= c.n[r] | c.n[r + 4];
    any_positive |= ~(c.n[r] | c.z[r]) | ~(c.n[r + 4] | c.z[r + 4]);
  }
  c.active = any_negative & any_positive & in_cells;
  if (row.valid != nullptr) c.active &= row.valid[w];
  return c;
}

/// The crossings round 64 cells: along x on the four rows, along y on rows 0 and 2, along z on rows
/// 0 and 1. By lane: 0 … 3, 4 … 5, 6 … 7.
using CrossingWords = std::array<Word, 8>;

template <bool Zeros>
SHAPE3D_ZMC_INLINE CrossingWords crossing_words(const CellWords& c, Word in_cells) {
  const auto between = [&](int a, int b) {
    return Zeros ? (c.n[a] ^ c.n[b]) & ~(c.z[a] | c.z[b]) : c.n[a] ^ c.n[b];
  };
  return {between(0, 4) & in_cells,
          between(1, 5) & in_cells,
          between(2, 6) & in_cells,
          between(3, 7) & in_cells,
          between(0, 1),
          between(2, 3),
          between(0, 2),
          between(1, 3)};
}

}  // namespace shape3d::zmc::detail
