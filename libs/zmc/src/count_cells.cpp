#include "count_cells.hpp"

#include <algorithm>

#include "cell_words.hpp"
#include "corner_bytes.hpp"
#include "crossings.hpp"
#include "isa.hpp"

namespace shape3d::zmc::detail {

void Tally::add(const Tally& other) {
  for (std::size_t m = 0; m < plain[0].size(); ++m) {
    for (std::size_t turn = 0; turn < 2; ++turn) plain[turn][m] += other.plain[turn][m];
  }
  for (std::size_t p = 0; p < by_case.size(); ++p) by_case[p] += other.by_case[p];
  patches += other.patches;
}

void use_lattice_edge(const SignLattice& lattice, int v, int w, std::int64_t i, std::int64_t j,
                      LayerPlan& layer) {
  const auto &p = kCellVertices[v], &q = kCellVertices[w];
  const int axis = p[0] != q[0] ? 0 : p[1] != q[1] ? 1 : 2;
  const std::int64_t x = i + std::min(p[0], q[0]), y = j + std::min(p[1], q[1]);
  auto& edges = std::min(p[2], q[2]) == 0 ? layer.lower_edges : layer.upper_edges;
  edges.push_back(3 * static_cast<std::uint64_t>(x + lattice.nx * y) +
                  static_cast<std::uint64_t>(axis));
}

namespace {

struct CountJob {
  SignLattice& lattice;
  const LatticeCells& cells;
  const TriangleTables& tables;
  std::int64_t j, k;
  LayerPlan& layer;
  bool note_edges;
  Tally& tally;
  CornerBytes corner_bytes;
};

SHAPE3D_ZMC_INLINE std::uint32_t popcount(Word word) {
  return static_cast<std::uint32_t>(__builtin_popcountll(word));
}

/// The pattern of an ambiguous cell once its comparisons are made.
__attribute__((noinline)) PatternTriangles resolve(const CountJob& job, unsigned p,
                                                   std::int64_t i) {
  const CellConfig& config = job.cells.config(job.cells.table().cases[p], i, job.j, job.k);
  const Triangulated& t = config.by_triangulation[job.tables.triangulation];
  return {t.first,           t.triangles,   t.centroids, 1, config.zero_vertices,
          config.zero_edges, config.patches};
}

__attribute__((noinline)) void use_zero_vertices(const CountJob& job, const CellRow& row,
                                                 const PatternTriangles& pattern, std::int64_t i) {
  for (unsigned corners = pattern.zero_vertices; corners != 0; corners &= corners - 1) {
    const int corner = __builtin_ctz(corners);
    mark_used(job.lattice, i + (corner >> 2), row.row[corner & 3]);
  }
  if (!job.note_edges) return;
  for (unsigned edges = pattern.zero_edges; edges != 0; edges &= edges - 1) {
    const int e = __builtin_ctz(edges);
    use_lattice_edge(job.lattice, kCellEdges[e][0], kCellEdges[e][1], i, job.j, job.layer);
  }
}

template <bool Zeros>
SHAPE3D_ZMC_INLINE RowPlan count_body(const CountJob& job, const CellRow& row) {
  RowPlan plan;
  const SignLattice& lattice = job.lattice;
  const Crossings crossings(lattice);
  const CellTable& table = job.cells.table();
  alignas(64) std::array<std::uint8_t, 64> negative, zero{};
  ActiveCells<Zeros> cells_at(row);
  CellWords c;
  for (std::int64_t w = 0; w < lattice.words; ++w) {
    const Word in_cells = below_mask(lattice.nx - 1, w);
    cells_at.next(w, in_cells);
    const Word active = cells_at.active;
    if (row.valid == nullptr) {
      // Where no cell is active nothing crosses, unless it be at the last sample, which begins
      // none.
      if (active == 0 && w + 1 < lattice.words) continue;
      const auto add_crossings = [&](const CrossingWords& cross) {
        plan.x += popcount(cross[0]);
        plan.y += popcount(cross[4]);
        plan.z += popcount(cross[6]);
      };
      if (cells_at.any_zero) {
        load_corners<Zeros>(row, w, c);
        add_crossings(crossing_words<Zeros>(c, in_cells));
      } else {
        load_corners<false>(row, w, c);
        add_crossings(crossing_words<false>(c, in_cells));
      }
    } else {
      plan.x += popcount(crossings.along_x(job.j, job.k, w));
      plan.y += popcount(crossings.along_y(job.j, job.k, w));
      plan.z += popcount(crossings.along_z(job.j, job.k, w));
      if (active != 0) load_corners<Zeros>(row, w, c);
    }
    if (active == 0) continue;
    job.corner_bytes(c.n, negative.data());
    const Word with_zero = cells_at.with_zero;
    if (with_zero != 0) {
      job.corner_bytes(c.z, zero.data());
      for (Word left = with_zero; left != 0; left &= left - 1) {
        const int b = __builtin_ctzll(left);
        const unsigned p = table.case_of_mask[negative[b] | zero[b] << 8];
        ++job.tally.by_case[p];
        const PatternTriangles* pattern = &job.tables.by_case[p];
        PatternTriangles resolved;
        if (pattern->ambiguous != 0) pattern = &(resolved = resolve(job, p, 64 * w + b));
        plan.first_triangle += pattern->triangles;
        plan.first_vertex += pattern->centroids;
        job.tally.patches += pattern->patches;
        if (pattern->zero_vertices != 0) use_zero_vertices(job, row, *pattern, 64 * w + b);
      }
    }
    std::uint32_t counts = 0;
    std::size_t turn = 0;
    for (Word left = active & ~with_zero; left != 0; left &= left - 1) {
      const unsigned mask = negative[__builtin_ctzll(left)];
      ++job.tally.plain[turn ^= 1][mask];
      const std::uint32_t count = job.tables.counts[mask];
      counts += count;
      if (count == TriangleTables::kAmbiguous) {
        counts -= count;
        const PatternTriangles resolved =
            resolve(job, table.case_of_mask[mask], 64 * w + __builtin_ctzll(left));
        counts += resolved.triangles | static_cast<std::uint32_t>(resolved.centroids) << 16;
        job.tally.patches += resolved.patches;
      }
    }
    plan.first_triangle += counts & 0xFFFFu;
    plan.first_vertex += counts >> 16;
  }
  return plan;
}

template <bool Zeros>
RowPlan count_portable(const CountJob& job, const CellRow& row) {
  return count_body<Zeros>(job, row);
}
template <bool Zeros>
SHAPE3D_ZMC_TARGET_AVX2 RowPlan count_avx2(const CountJob& job, const CellRow& row) {
  return count_body<Zeros>(job, row);
}

}  // namespace

RowPlan count_cell_row(SignLattice& lattice, const LatticeCells& cells,
                       const TriangleTables& tables, std::int64_t j, std::int64_t k,
                       LayerPlan& layer, bool note_edges, Tally& tally) {
  constexpr unsigned kBoth = kRowNegative | kRowPositive;
  const CellRow row = cell_row(lattice, j, k);
  if ((row.any_flags & kBoth) != kBoth) return {};
  const Isa isa = active_isa();
  const CountJob job{lattice, cells, tables, j, k, layer, note_edges, tally, corner_bytes(isa)};
  if ((row.any_flags & kRowZero) != 0) {
    return isa == Isa::portable ? count_portable<true>(job, row) : count_avx2<true>(job, row);
  }
  return isa == Isa::portable ? count_portable<false>(job, row) : count_avx2<false>(job, row);
}

}  // namespace shape3d::zmc::detail
