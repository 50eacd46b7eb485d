#pragma once

// What the cells of one cell row will give.

#include <array>
#include <cstdint>
#include <vector>

#include "plan.hpp"
#include "triangles.hpp"

namespace shape3d::zmc::detail {

/// How often sign patterns occurred in cells with patches, and sums over their configurations.
struct Tally {
  /// By negative corner bits, cells without zeros. In two parts taken in turn: neighbours are often
  /// of one pattern, and a sum in memory can only grow by one every few cycles.
  std::array<std::array<std::int64_t, 256>, 2> plain{};
  std::vector<std::int64_t> by_case =
      std::vector<std::int64_t>(6561, 0);  ///< By P, cells with zeros.
  std::int64_t patches = 0;                ///< Of ambiguous cells and of cells with zeros.

  void add(const Tally& other);
};

/// Counts row (j, k), j + 1 < ny, k + 1 < nz: the crossings of the lattice row, triangles and
/// centroids of the cell row (in first_triangle and first_vertex, until places are known). Marks
/// the zero samples that patches use and, with note_edges, notes the zero edges they run along.
RowPlan count_cell_row(SignLattice& lattice, const LatticeCells& cells,
                       const TriangleTables& tables, std::int64_t j, std::int64_t k,
                       LayerPlan& layer, bool note_edges, Tally& tally);

/// Notes a side of a polygon along the lattice edge between corners v and w of cell (i, j) of a
/// layer.
void use_lattice_edge(const SignLattice& lattice, int v, int w, std::int64_t i, std::int64_t j,
                      LayerPlan& layer);

}  // namespace shape3d::zmc::detail
