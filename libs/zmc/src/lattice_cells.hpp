#pragma once

// From a cell of the lattice to its configuration.

#include <array>
#include <cstdint>

#include "cell_table.hpp"
#include "samples.hpp"
#include "sign_lattice.hpp"

namespace shape3d::zmc::detail {

/// Looks configurations up; ambiguous cases are decided from the samples.
class LatticeCells {
 public:
  LatticeCells(const SignLattice& lattice, const AnyMagnitudeReader& magnitude, TieRule ties)
      : lattice_(lattice), magnitude_(magnitude), ties_(ties), table_(cell_table()) {}

  /// Configuration of the case with index p at cell (i, j, k).
  const CellConfig& config(const CellCase& cell_case, std::int64_t i, std::int64_t j,
                           std::int64_t k) const {
    if (cell_case.comparisons == 0) return table_.configs[cell_case.first_config];
    return table_.configs[cell_case.first_config + answers(cell_case, i, j, k)];
  }
  /// The same from a mask (negative bits | zero bits << 8).
  const CellConfig& config_of_mask(unsigned mask, std::int64_t i, std::int64_t j,
                                   std::int64_t k) const {
    return config(table_.cases[table_.case_of_mask[mask]], i, j, k);
  }
  [[nodiscard]] const SignLattice& lattice() const { return lattice_; }
  [[nodiscard]] const CellTable& table() const { return table_; }

  /// |sample − isovalue| at the corners of a cell, Lorensen's order; zero samples give 0.
  std::array<double, 8> magnitudes(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return magnitude_.corners(i, j, k);
  }

 private:
  unsigned answers(const CellCase& cell_case, std::int64_t i, std::int64_t j,
                   std::int64_t k) const {
    const std::array<double, 8> m = magnitudes(i, j, k);
    unsigned bits = 0;
    for (unsigned c = 0; c < cell_case.comparisons; ++c) {
      if (positive_prevails(table_.comparisons[cell_case.first_comparison + c], m, ties_))
        bits |= 1u << c;
    }
    return bits;
  }

  const SignLattice& lattice_;
  const AnyMagnitudeReader& magnitude_;
  TieRule ties_;
  const CellTable& table_;
};

}  // namespace shape3d::zmc::detail
