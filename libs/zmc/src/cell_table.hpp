#pragma once

// Every cell configuration, generated once from the rules.

#include <array>
#include <cstdint>
#include <vector>

#include "cell_rules.hpp"
#include "shape3d/zmc/cell.hpp"

namespace shape3d::zmc::detail {

/// Cell vertices as bits of a cell mask: bit 4x + 2z + y, so that the corners at x = 0 are the low
/// nibble and those at x = 1 the high one.
constexpr int corner_bit(int vertex) {
  return 4 * kCellVertices[vertex][0] + 2 * kCellVertices[vertex][2] + kCellVertices[vertex][1];
}

/// Surface vertices of a cell in ascending order of their global ids (rows by y, then z; within a
/// row crossings along x, y, z, then zero vertices): 12 crossings and 8 cell vertices.
inline constexpr int kSlots = 20;
inline constexpr std::array<int, kSlots> kSlotVertex{0,  3,  1, 8, 9, 12, 13, 2, 11, 10,
                                                     15, 14, 4, 7, 5, 16, 17, 6, 19, 18};
constexpr std::array<int, kSlots> invert_slots() {
  std::array<int, kSlots> slot{};
  for (int s = 0; s < kSlots; ++s) slot[kSlotVertex[s]] = s;
  return slot;
}
inline constexpr std::array<int, kSlots> kVertexSlot = invert_slots();

/// Triangles of one configuration: `triangles` triples of slots from `first` in CellTable::slots.
/// Slots from kSlots on are centroids; their members stand in CellTable::centroids from
/// `first_centroid`.
struct Triangulated {
  std::uint32_t first = 0;
  std::uint16_t first_centroid = 0;
  std::uint8_t triangles = 0;
  std::uint8_t centroids = 0;
};

/// One sign pattern with one set of answers.
struct CellConfig {
  std::array<Triangulated, 2> by_triangulation;  ///< Indexed by Triangulation.
  std::uint16_t zero_edges = 0;                  ///< Bit e: cell edge e carries a patch edge.
  std::uint8_t zero_vertices = 0;                ///< Corner bits of the zero vertices in patches.
  std::uint8_t face_positive = 0;                ///< Bit f: zero_face_sign of face f is +1.
  std::uint8_t face_negative = 0;                ///< Bit f: it is −1.
  std::uint8_t patches = 0;
};

/// One sign pattern: its configurations start at `first_config`; bit c of the offset is the answer
/// to comparison `first_comparison + c`.
struct CellCase {
  std::uint16_t first_config = 0;
  std::uint16_t first_comparison = 0;
  std::uint8_t comparisons = 0;
  std::array<std::uint8_t, 6> face_case{};
};

struct CellTable {
  static constexpr std::uint16_t kNoCase = 0xFFFF;

  std::vector<CellCase> cases;  ///< 6561, by P.
  /// By P: face_positive | face_negative << 6 of its only configuration, or kAmbiguousFaces. Small,
  /// since the signs of faces are asked for at places far apart.
  std::vector<std::uint16_t> face_signs;
  static constexpr std::uint16_t kAmbiguousFaces = 0xFFFF;
  std::vector<CellConfig> configs;
  std::vector<Comparison> comparisons;
  std::vector<std::uint8_t> slots;       ///< Triples.
  std::vector<std::uint32_t> centroids;  ///< Slot sets.
  std::vector<std::uint16_t>
      case_of_mask;  ///< 65536: negative bits | zero bits << 8 → P; both set: kNoCase.
};

/// The table, generated at first use (thread-safe).
const CellTable& cell_table();

/// The polygon's triangles in slots; appends a centroid to `centroids` when one is needed.
/// The choice depends on the set of vertices and their cyclic order up to reversal, never on signs;
/// each triangle starts with its lowest slot, so that reversing the polygon swaps entries 1 and 2.
void triangulate(const std::vector<int>& polygon_slots, Triangulation triangulation,
                 int centroid_base, std::vector<std::array<int, 3>>& triangles,
                 std::vector<std::uint32_t>& centroids);

/// The cycles of a graph in slots, each starting at its lowest, ordered by it.
std::vector<std::vector<int>> cycles_in_slots(const CellGraph& graph);

}  // namespace shape3d::zmc::detail
