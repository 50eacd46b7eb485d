#include "triangles.hpp"

#include <algorithm>

namespace shape3d::zmc::detail {
namespace {

TriangleTables make_tables(Triangulation triangulation, bool mirrored) {
  const CellTable& table = cell_table();
  TriangleTables tables;
  tables.triangulation = static_cast<std::size_t>(triangulation);
  for (const CellCase& cell_case : table.cases) {
    const CellConfig& config = table.configs[cell_case.first_config];
    const Triangulated& t = config.by_triangulation[tables.triangulation];
    tables.by_case.push_back({t.first, t.triangles, t.centroids,
                              static_cast<std::uint8_t>(cell_case.comparisons != 0),
                              config.zero_vertices, config.zero_edges, config.patches});
  }
  for (unsigned mask = 0; mask < 256; ++mask) {
    const PatternTriangles& pattern = tables.plain[mask] = tables.by_case[table.case_of_mask[mask]];
    tables.counts[mask] = pattern.ambiguous != 0
                              ? TriangleTables::kAmbiguous
                              : pattern.triangles | static_cast<std::uint32_t>(pattern.centroids)
                                                        << 16;
  }
  constexpr std::size_t kPadding = 64;  // vector loads may read beyond the last triangle
  tables.lanes.reserve(table.slots.size() + kPadding);
  for (std::size_t t = 0; t < table.slots.size(); ++t) {
    const std::size_t corner = t % 3;
    const std::uint8_t slot = table.slots[mirrored && corner != 0 ? t - corner + (3 - corner) : t];
    tables.lanes.push_back(
        slot < kSlots ? kSlotLane[slot] : static_cast<std::uint8_t>(kCentroidLane + slot - kSlots));
  }
  tables.lanes.resize(tables.lanes.size() + kPadding, 0);
  for (unsigned mask = 0; mask < 256; ++mask) {
    const PatternTriangles& pattern = tables.plain[mask];
    PlainCell& cell = tables.cells[mask];
    cell.triangles = pattern.triangles;
    const bool simple = pattern.ambiguous == 0 && pattern.centroids == 0 &&
                        3u * pattern.triangles <= cell.lanes.size();
    cell.special = simple ? 0 : 1;
    if (simple)
      std::copy_n(&tables.lanes[pattern.first], 3 * pattern.triangles, cell.lanes.begin());
    for (unsigned lane = 0; lane < 8; ++lane)
      cell.steps[lane] = (crossing_lanes(mask, 0) >> lane) & 1u;
  }
  return tables;
}

}  // namespace

const TriangleTables& triangle_tables(Triangulation triangulation, bool mirrored) {
  static const std::array<TriangleTables, 4> all{
      make_tables(Triangulation::compact, false), make_tables(Triangulation::compact, true),
      make_tables(Triangulation::centroid, false), make_tables(Triangulation::centroid, true)};
  return all[2 * static_cast<std::size_t>(triangulation) + (mirrored ? 1 : 0)];
}

}  // namespace shape3d::zmc::detail
