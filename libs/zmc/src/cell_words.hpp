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
  std::array<Word, 8> n, z;
  std::array<Word, 4> used{};
  Word active = 0;     ///< Cells with both signs: they contain patches.
  Word with_zero = 0;  ///< Cells with a zero sample.
};

template <bool Zeros>
SHAPE3D_ZMC_INLINE void load_corners(const CellRow& row, std::int64_t w, CellWords& c) {
  for (int r = 0; r < 4; ++r) {
    c.n[r] = load(row.n[r] + w);
    c.n[r + 4] = load_next(row.n[r], w);
    if constexpr (Zeros) {
      c.z[r] = row.z[r][w];
      c.z[r + 4] = load_next(row.z[r], w);
      c.used[r] = c.n[r] & c.z[r];
      c.n[r] &= ~c.z[r];
      c.n[r + 4] &= ~c.z[r + 4];
    }
  }
}

template <bool Zeros>
SHAPE3D_ZMC_INLINE CellWords cell_words(const CellRow& row, std::int64_t w, Word in_cells) {
  CellWords c;
  load_corners<Zeros>(row, w, c);
  Word any_negative = 0, any_positive = 0;
  for (int corner = 0; corner < 8; ++corner) {
    any_negative |= c.n[corner];
    any_positive |= Zeros ? ~(c.n[corner] | c.z[corner]) : ~c.n[corner];
    if constexpr (Zeros) c.with_zero |= c.z[corner];
  }
  c.active = any_negative & any_positive & in_cells;
  if (row.valid != nullptr) c.active &= row.valid[w];
  return c;
}

/// The active cells of a cell row, word by word: most words have none and need no more than this.
/// Signs are joined over the four rows before they are moved by one sample.
template <bool Zeros>
class ActiveCells {
 public:
  explicit ActiveCells(const CellRow& row) : row_(row), ahead_(any(0)) {}

  /// Takes in word w; w = 0, 1, … in turn.
  SHAPE3D_ZMC_INLINE void next(std::int64_t w, Word in_cells) {
    const Any here = ahead_;
    ahead_ = any(w + 1);
    const auto beside = [](Word word, Word following) {
      return word | (word >> 1) | (following << 63);
    };
    active =
        beside(here.negative, ahead_.negative) & beside(here.positive, ahead_.positive) & in_cells;
    if (row_.valid != nullptr) active &= row_.valid[w];
    if constexpr (Zeros) {
      zeros = here.zero;
      any_zero = (here.zero | (ahead_.zero & 1u)) != 0;
      with_zero = beside(here.zero, ahead_.zero) & active;
    }
  }

  Word active = 0;        ///< Cells with both signs: they contain patches.
  Word with_zero = 0;     ///< Those of them with a zero sample.
  Word zeros = 0;         ///< Places with a zero sample in one of the four rows.
  bool any_zero = false;  ///< One of the 64 cells, active or not, has a zero sample.

 private:
  struct Any {
    Word negative, positive, zero;
  };
  SHAPE3D_ZMC_INLINE Any any(std::int64_t w) const {
    Any a{0, 0, 0};
    for (int r = 0; r < 4; ++r) {
      const Word n = load(row_.n[r] + w);
      if constexpr (Zeros) {
        const Word z = row_.z[r][w];
        a.negative |= n & ~z;
        a.positive |= ~(n | z);
        a.zero |= z;
      } else {
        a.negative |= n;
        a.positive |= ~n;
      }
    }
    return a;
  }

  const CellRow& row_;
  Any ahead_;
};

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
