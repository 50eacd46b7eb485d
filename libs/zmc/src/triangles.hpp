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

/// What a sign pattern gives, where that does not depend on comparisons.
struct PatternTriangles {
  std::uint32_t first = 0;  ///< In the lanes.
  std::uint8_t triangles = 0;
  std::uint8_t centroids = 0;
  std::uint8_t ambiguous = 0;
  std::uint8_t zero_vertices = 0;  ///< Corner bits.
  std::uint16_t zero_edges = 0;    ///< Bit e: cell edge e carries a patch edge.
  std::uint16_t patches = 0;
};

/// Ids round a cell by lane: crossings along x 0–3, along y 4–5, along z 6–7, the same one sample
/// further from 8 on (12–15); used zeros 16–19 and 20–23; centroids from 24 on.
inline constexpr int kZeroLane = 16;
inline constexpr int kCentroidLane = 24;
inline constexpr int kLanes = 32;
inline constexpr std::array<std::uint8_t, kSlots> kSlotLane{0,  4,  12, 6, 14, 16, 20, 1, 7,  15,
                                                            17, 21, 2,  5, 13, 18, 22, 3, 19, 23};

/// A sign pattern without zeros as the loop over cells reads it.
struct alignas(32) PlainCell {
  std::array<std::uint8_t, 16> lanes{};  ///< Of its triangles.
  std::array<std::uint8_t, 8> steps{};   ///< By lane 0 … 7: the cell has that crossing.
  std::uint8_t triangles = 0;
  /// It takes more than lanes: comparisons, centroids, or more than five triangles.
  std::uint8_t special = 0;
};

/// Crossings round a cell, bit by lane 0 … 7, from its corner bits.
inline unsigned crossing_lanes(unsigned negative, unsigned zero) {
  const auto along = [&](int step) {
    return (negative ^ (negative >> step)) & ~(zero | (zero >> step));
  };
  const unsigned x = along(4), y = along(1), z = along(2);
  return (x & 15u) | (y & 1u) << 4 | (y & 4u) << 3 | (z & 3u) << 6;
}

/// The cell table as the kernels read it.
struct TriangleTables {
  std::size_t triangulation = 0;
  std::array<PatternTriangles, 256> plain;  ///< By negative corner bits, for cells without zeros.
  std::array<PlainCell, 256> cells;         ///< The same.
  /// By negative corner bits: triangles | centroids << 16, or kAmbiguous.
  std::array<std::uint32_t, 256> counts;
  static constexpr std::uint32_t kAmbiguous = std::uint32_t{1} << 31;
  std::vector<PatternTriangles> by_case;  ///< By P.
  std::vector<std::uint8_t> lanes;  ///< CellTable::slots as lanes, turned over if mirrored; padded.
};

/// Generated at first use, once for each combination.
const TriangleTables& triangle_tables(Triangulation triangulation, bool mirrored);

/// Writes the triangles of the cells (·, j, k).
/// @param triangles  The surface's; the row's have their place in it.
/// @param end        What lies between them and here may be overwritten: it is written later.
template <class Index>
void generate_cell_row(const LatticeCells& cells, const Plan& plan, const TriangleTables& tables,
                       const CentroidSink& centroids, std::int64_t j, std::int64_t k,
                       Index* triangles, const Index* end);

}  // namespace shape3d::zmc::detail
