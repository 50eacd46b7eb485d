#pragma once

// Triangles of the patches of one cell row.

#include <array>
#include <cstdint>
#include <vector>

#include "lattice_cells.hpp"
#include "plan.hpp"

namespace shape3d::zmc::detail {

/// Places centroids, which are rare; the kernels only number them.
class CentroidSink {
 public:
  virtual ~CentroidSink() = default;
  /// Writes vertex `id` of cell (i, j, k): the average of the surface vertices in the slot set.
  virtual void put(std::int64_t id, std::uint32_t members, std::int64_t i, std::int64_t j,
                   std::int64_t k) const = 0;
};

/// How the triangles of a cell without zero samples are found; by its negative corner bits.
struct PlainCell {
  std::uint32_t first = 0;  ///< In the slots.
  std::uint8_t triangles = 0;
  std::uint8_t special = 1;  ///< Ambiguous or with centroids: look the configuration up.
};

/// Slots as places in two tables of 16 ids: crossings of the rows along x 0–3, along y 4–5, along z
/// 6–7 and the same one sample further from 8 on; used zeros 16–19 and 20–23; centroids from 24 on.
inline constexpr int kCentroidLane = 24;
constexpr std::array<std::uint8_t, kSlots> kSlotLane{0,  4,  12, 6, 14, 16, 20, 1, 7,  15,
                                                     17, 21, 2,  5, 13, 18, 22, 3, 19, 23};

/// All that the kernels share during one extraction.
struct TriangleTables {
  TriangleTables(const LatticeCells& cells, Triangulation triangulation, bool mirrored);

  std::size_t triangulation;
  std::array<PlainCell, 256> plain;
  std::vector<std::uint8_t>
      lanes;  ///< CellTable::slots as lanes, turned over in a left-handed frame; padded.
};

/// Writes the triangles of the cells (·, j, k).
template <class Index>
void generate_cell_row(const LatticeCells& cells, const Plan& plan, const TriangleTables& tables,
                       const CentroidSink& centroids, std::int64_t j, std::int64_t k,
                       Index* triangles);

}  // namespace shape3d::zmc::detail
