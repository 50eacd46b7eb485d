#pragma once

// The signs of all samples as two bit rows each: what every later stage works on.

#include <cstdint>

#include "shape3d/zmc/surface.hpp"

namespace shape3d::zmc::detail {

using Word = std::uint64_t;

/// Bits in a row's flags.
enum RowFlag : std::uint8_t { kRowNegative = 1, kRowPositive = 2, kRowZero = 4, kRowMasked = 8 };

/// Signs of the samples of a lattice, 2 bits each.
///
/// Row r = j + ny·k holds the samples along x in `words` words; bit i % 64 of word i / 64 is sample
/// i. A zero sample that is a vertex of the surface gets its negative bit set too, so that
///   negative = N & ~Z,  positive = ~(N | Z),  used zero = N & Z,
/// and marking one never changes what a concurrent reader sees of signs. Bits beyond the row are 0.
struct SignLattice {
  std::int64_t nx = 0, ny = 0, nz = 0;
  std::int64_t words = 0;               ///< Per row.
  detail::Buffer<Word> n_bits, z_bits;  ///< One spare word at the end of each.
  detail::Buffer<Word>
      cell_bits;  ///< Only with masked samples: bit i: cell (i, j, k) has eight finite samples.
  detail::Buffer<std::uint8_t> flags;  ///< Per row.
  bool masked = false;

  [[nodiscard]] std::int64_t rows() const { return ny * nz; }
  [[nodiscard]] std::int64_t row(std::int64_t j, std::int64_t k) const { return j + ny * k; }
  [[nodiscard]] const Word* n_row(std::int64_t row) const { return n_bits.data() + row * words; }
  [[nodiscard]] const Word* z_row(std::int64_t row) const { return z_bits.data() + row * words; }

  [[nodiscard]] bool is_zero(std::int64_t i, std::int64_t row) const {
    return ((z_row(row)[i >> 6] >> (i & 63)) & 1u) != 0;
  }
  /// Zero bits of the cell's corners (see corner_bit) in the high byte, negative bits in the low
  /// one.
  [[nodiscard]] unsigned cell_mask(std::int64_t i, std::int64_t j, std::int64_t k) const;
  [[nodiscard]] bool cell_valid(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return !masked ||
           ((cell_bits[static_cast<std::size_t>(row(j, k) * words + (i >> 6))] >> (i & 63)) & 1u) !=
               0;
  }
};

/// Reads a word that other threads may be marking.
inline Word load(const Word* word) { return __atomic_load_n(word, __ATOMIC_RELAXED); }

/// Marks the zero sample (i, row) as a vertex of the surface.
inline void mark_used(SignLattice& lattice, std::int64_t i, std::int64_t row) {
  Word* word = lattice.n_bits.data() + row * lattice.words + (i >> 6);
  const Word bit = Word{1} << (i & 63);
  if ((load(word) & bit) == 0) __atomic_fetch_or(word, bit, __ATOMIC_RELAXED);
}

/// Word w of a row moved down by one sample: bit i is sample i + 1. The last bit of the last word
/// is not meaningful. `row` must be followed by a readable word.
inline Word load_next(const Word* row, std::int64_t w) {
  return (load(row + w) >> 1) | (load(row + w + 1) << 63);
}

/// Bits of word w that are samples with index below `count`.
inline Word below_mask(std::int64_t count, std::int64_t w) {
  const std::int64_t left = count - 64 * w;
  if (left >= 64) return ~Word{0};
  return left <= 0 ? 0 : (Word{1} << left) - 1;
}

inline unsigned SignLattice::cell_mask(std::int64_t i, std::int64_t j, std::int64_t k) const {
  // Two neighbouring bits of rows (j, k), (j+1, k), (j, k+1), (j+1, k+1): one to each nibble.
  const std::int64_t r[4] = {row(j, k), row(j + 1, k), row(j, k + 1), row(j + 1, k + 1)};
  const int shift = static_cast<int>(i & 63);
  const auto pair = [&](const Word* bits) {
    const Word* word = bits + (i >> 6);
    Word two = load(word) >> shift;
    if (shift == 63) two |= load(word + 1) << 1;
    return static_cast<unsigned>((two & 1u) | (two & 2u) << 3);
  };
  unsigned n = 0, z = 0;
  for (int c = 0; c < 4; ++c) {
    z |= pair(z_row(r[c])) << c;
    n |= pair(n_row(r[c])) << c;
  }
  return (n & ~z) | (z << 8);
}

}  // namespace shape3d::zmc::detail
