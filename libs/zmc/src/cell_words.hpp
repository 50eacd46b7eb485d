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

/// Signs of the corners of 64 cells: `n[r]` and `z[r]` at x = i, `n_next[r]` and `z_next[r]` at x =
/// i + 1. The z words are only filled with Zeros; n is then free of the marks of used zeros, which
/// stay in `used`.
struct CellWords {
  std::array<Word, 4> n{}, n_next{}, z{}, z_next{}, used{};
  Word active = 0;     ///< Cells with both signs: they contain patches.
  Word with_zero = 0;  ///< Cells with a zero sample.
};

template <bool Zeros>
SHAPE3D_ZMC_INLINE CellWords cell_words(const CellRow& row, std::int64_t w, Word in_row) {
  CellWords c;
  Word any_negative = 0, any_positive = 0;
  for (int r = 0; r < 4; ++r) {
    c.n[r] = load(row.n[r] + w);
    c.n_next[r] = load_next(row.n[r], w);
    if constexpr (Zeros) {
      c.z[r] = row.z[r][w];
      c.z_next[r] = load_next(row.z[r], w);
      c.used[r] = c.n[r] & c.z[r];
      c.n[r] &= ~c.z[r];
      c.n_next[r] &= ~c.z_next[r];
      c.with_zero |= c.z[r] | c.z_next[r];
    }
    any_negative |= c.n[r] | c.n_next[r];
    any_positive |= ~(c.n[r] | c.z[r]) | ~(c.n_next[r] | c.z_next[r]);
  }
  c.active = any_negative & any_positive & in_row;
  if (row.valid != nullptr) c.active &= row.valid[w];
  return c;
}

/// Corner bits (see corner_bit) of cell b from words at x = i and at x = i + 1.
SHAPE3D_ZMC_INLINE unsigned gather_corners(const std::array<Word, 4>& at,
                                           const std::array<Word, 4>& next, int b) {
  unsigned mask = 0;
  for (int r = 0; r < 4; ++r) {
    mask |= static_cast<unsigned>((at[r] >> b) & 1u) << r;
    mask |= static_cast<unsigned>((next[r] >> b) & 1u) << (r + 4);
  }
  return mask;
}

}  // namespace shape3d::zmc::detail
