#pragma once

// Bit rows of the crossings on lattice edges, derived word by word from the signs.

#include "sign_lattice.hpp"

namespace shape3d::zmc::detail {

/// Words of the surface vertices that belong to one lattice row: crossings on the edges that start
/// at its samples along x, y and z, and zero samples that are vertices.
class Crossings {
 public:
  explicit Crossings(const SignLattice& lattice) : lattice_(lattice) {}

  Word along_x(std::int64_t j, std::int64_t k, std::int64_t w) const {
    const std::int64_t r = lattice_.row(j, k);
    const Word n = load(lattice_.n_row(r) + w), m = load_next(lattice_.n_row(r), w);
    Word crossing = n ^ m;
    if (has_zero(r)) crossing &= ~(lattice_.z_row(r)[w] | load_next(lattice_.z_row(r), w));
    crossing &= below_mask(lattice_.nx - 1, w);
    return lattice_.masked ? crossing & near_x(j, k, w) : crossing;
  }
  Word along_y(std::int64_t j, std::int64_t k, std::int64_t w) const {
    if (j + 1 >= lattice_.ny) return 0;
    const Word crossing = between(lattice_.row(j, k), lattice_.row(j + 1, k), w);
    return lattice_.masked ? crossing & (near(j, k, w) | near(j, k - 1, w)) : crossing;
  }
  Word along_z(std::int64_t j, std::int64_t k, std::int64_t w) const {
    if (k + 1 >= lattice_.nz) return 0;
    const Word crossing = between(lattice_.row(j, k), lattice_.row(j, k + 1), w);
    return lattice_.masked ? crossing & (near(j, k, w) | near(j - 1, k, w)) : crossing;
  }
  Word used_zeros(std::int64_t j, std::int64_t k, std::int64_t w) const {
    const std::int64_t r = lattice_.row(j, k);
    return has_zero(r) ? load(lattice_.n_row(r) + w) & lattice_.z_row(r)[w] : 0;
  }

 private:
  bool has_zero(std::int64_t row) const {
    return (lattice_.flags[static_cast<std::size_t>(row)] & kRowZero) != 0;
  }

  Word between(std::int64_t a, std::int64_t b, std::int64_t w) const {
    Word crossing = load(lattice_.n_row(a) + w) ^ load(lattice_.n_row(b) + w);
    if (has_zero(a)) crossing &= ~lattice_.z_row(a)[w];
    if (has_zero(b)) crossing &= ~lattice_.z_row(b)[w];
    return crossing;
  }
  /// Valid cells of a cell row; none outside the lattice.
  Word cells(std::int64_t j, std::int64_t k, std::int64_t w) const {
    if (j < 0 || k < 0 || w < 0) return 0;
    return lattice_.cell_bits[static_cast<std::size_t>(lattice_.row(j, k) * lattice_.words + w)];
  }
  Word near_x(std::int64_t j, std::int64_t k, std::int64_t w) const {
    return cells(j, k, w) | cells(j - 1, k, w) | cells(j, k - 1, w) | cells(j - 1, k - 1, w);
  }
  /// Samples of a row with a valid cell before or behind them.
  Word near(std::int64_t j, std::int64_t k, std::int64_t w) const {
    const Word c = cells(j, k, w);
    return c | (c << 1) | (w > 0 ? cells(j, k, w - 1) >> 63 : 0);
  }

  const SignLattice& lattice_;
};

}  // namespace shape3d::zmc::detail
