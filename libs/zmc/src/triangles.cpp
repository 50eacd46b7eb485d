#include "triangles.hpp"

#include "cell_words.hpp"
#include "crossings.hpp"
#include "isa.hpp"

namespace shape3d::zmc::detail {

TriangleTables::TriangleTables(const LatticeCells& cells, Triangulation how, bool mirrored)
    : triangulation(static_cast<std::size_t>(how)) {
  const CellTable& table = cells.table();
  for (unsigned mask = 0; mask < 256; ++mask) {
    const CellCase& cell_case = table.cases[table.case_of_mask[mask]];
    const Triangulated& t = table.configs[cell_case.first_config].by_triangulation[triangulation];
    plain[mask] = {t.first, t.triangles,
                   static_cast<std::uint8_t>(cell_case.comparisons != 0 || t.centroids != 0)};
  }
  constexpr std::size_t kPadding = 64;  // vector loads may read beyond the last triangle
  lanes.reserve(table.slots.size() + kPadding);
  for (std::size_t t = 0; t < table.slots.size(); ++t) {
    const std::size_t corner = t % 3;
    const std::size_t from = mirrored && corner != 0 ? t - corner + (3 - corner) : t;
    const std::uint8_t slot = table.slots[from];
    lanes.push_back(slot < kSlots ? kSlotLane[slot]
                                  : static_cast<std::uint8_t>(kCentroidLane + slot - kSlots));
  }
  lanes.resize(lanes.size() + kPadding, 0);
}

namespace {

SHAPE3D_ZMC_INLINE int popcount(Word word) { return __builtin_popcountll(word); }

/// The crossings round 64 cells: along x on the four rows, along y on rows 0 and 2, along z on rows
/// 0 and 1.
struct CrossingWords {
  std::array<Word, 4> x{};
  std::array<Word, 2> y{}, z{};
};

template <bool Zeros>
SHAPE3D_ZMC_INLINE CrossingWords crossing_words(const CellWords& c, Word in_cells) {
  CrossingWords words;
  const auto between = [](Word n, Word z, Word m, Word y) {
    return Zeros ? (n ^ m) & ~(z | y) : n ^ m;
  };
  for (int r = 0; r < 4; ++r)
    words.x[r] = between(c.n[r], c.z[r], c.n_next[r], c.z_next[r]) & in_cells;
  words.y[0] = between(c.n[0], c.z[0], c.n[1], c.z[1]);
  words.y[1] = between(c.n[2], c.z[2], c.n[3], c.z[3]);
  words.z[0] = between(c.n[0], c.z[0], c.n[2], c.z[2]);
  words.z[1] = between(c.n[1], c.z[1], c.n[3], c.z[3]);
  return words;
}

CrossingWords masked_crossing_words(const Crossings& crossings, std::int64_t j, std::int64_t k,
                                    std::int64_t w) {
  CrossingWords words;
  for (int r = 0; r < 4; ++r) words.x[r] = crossings.along_x(j + (r & 1), k + (r >> 1), w);
  words.y = {crossings.along_y(j, k, w), crossings.along_y(j, k + 1, w)};
  words.z = {crossings.along_z(j, k, w), crossings.along_z(j + 1, k, w)};
  return words;
}

/// Ids of the next vertex of each kind round a cell row.
template <class Index>
struct RunningIds {
  std::array<Index, 4> x{}, zero{};
  std::array<Index, 2> y{}, z{};
  Index centroid = 0;

  RunningIds(const SignLattice& lattice, const Plan& plan, const CellRow& row) {
    for (int r = 0; r < 4; ++r) {
      const RowPlan& p = plan.rows[static_cast<std::size_t>(row.row[r])];
      const auto first = static_cast<Index>(plan.first_vertex(row.row[r]));
      x[r] = first;
      if (r % 2 == 0) y[r / 2] = first + static_cast<Index>(p.x);
      if (r < 2) z[r] = first + static_cast<Index>(p.x) + static_cast<Index>(p.y);
      zero[r] = first + static_cast<Index>(p.x) + static_cast<Index>(p.y) + static_cast<Index>(p.z);
    }
    centroid = zero[0];
    if ((row.any_flags & kRowZero) == 0) return;
    for (std::int64_t w = 0; w < lattice.words; ++w) {
      centroid += static_cast<Index>(popcount(load(row.n[0] + w) & row.z[0][w]));
    }
  }
};

template <class Index>
struct RowJob {
  const LatticeCells& cells;
  const Plan& plan;
  const TriangleTables& tables;
  const CentroidSink& centroids;
  std::int64_t j, k;
  Index* out;
};

/// The triangles of a configuration that is ambiguous, has zeros or centroids. `id` is indexed by
/// lane.
template <class Index>
inline const Triangulated& special_cell(const RowJob<Index>& job, unsigned mask, std::int64_t i,
                                        Index& next_centroid, Index* centroid_ids) {
  const CellConfig& config = job.cells.config_of_mask(mask, i, job.j, job.k);
  const Triangulated& t = config.by_triangulation[job.tables.triangulation];
  for (int n = 0; n < t.centroids; ++n) {
    const std::uint32_t members =
        job.cells.table().centroids[static_cast<std::size_t>(t.first_centroid + n)];
    job.centroids.put(static_cast<std::int64_t>(next_centroid), members, i, job.j, job.k);
    centroid_ids[n] = next_centroid++;
  }
  return t;
}

template <bool Zeros, class Index>
SHAPE3D_ZMC_INLINE void generate_body(const RowJob<Index>& job, const CellRow& row) {
  const SignLattice& lattice = job.cells.lattice();
  const Crossings crossings(lattice);
  Index* out = job.out;
  RunningIds<Index> next(lattice, job.plan, row);
  std::array<Index, 32> id{};  // by lane
  for (std::int64_t w = 0; w < lattice.words; ++w) {
    const Word in_cells = below_mask(lattice.nx - 1, w);
    const CellWords c = cell_words<Zeros>(row, w, in_cells);
    if (!Zeros && c.active == 0 && row.valid == nullptr) continue;  // then nothing crosses here
    const CrossingWords cross = row.valid == nullptr
                                    ? crossing_words<Zeros>(c, in_cells)
                                    : masked_crossing_words(crossings, job.j, job.k, w);
    for (Word left = c.active; left != 0; left &= left - 1) {
      const int b = __builtin_ctzll(left);
      const Word below = (Word{1} << b) - 1;
      for (int r = 0; r < 4; ++r)
        id[r] = static_cast<Index>(next.x[r] + popcount(cross.x[r] & below));
      for (int r = 0; r < 2; ++r) {
        id[4 + r] = static_cast<Index>(next.y[r] + popcount(cross.y[r] & below));
        id[6 + r] = static_cast<Index>(next.z[r] + popcount(cross.z[r] & below));
        id[12 + r] = id[4 + r] + static_cast<Index>((cross.y[r] >> b) & 1u);
        id[14 + r] = id[6 + r] + static_cast<Index>((cross.z[r] >> b) & 1u);
      }
      unsigned mask = gather_corners(c.n, c.n_next, b);
      std::uint32_t first = 0;
      int triangles = 0;
      const bool zero = Zeros && ((c.with_zero >> b) & 1u) != 0;
      if (!zero && job.tables.plain[mask].special == 0) {
        first = job.tables.plain[mask].first;
        triangles = job.tables.plain[mask].triangles;
      } else {
        if (zero) {
          mask |= gather_corners(c.z, c.z_next, b) << 8;
          for (int r = 0; r < 4; ++r) {
            id[16 + r] = static_cast<Index>(next.zero[r] + popcount(c.used[r] & below));
            id[20 + r] = id[16 + r] + static_cast<Index>((c.used[r] >> b) & 1u);
          }
        }
        const Triangulated& t =
            special_cell(job, mask, 64 * w + b, next.centroid, id.data() + kCentroidLane);
        first = t.first;
        triangles = t.triangles;
      }
      const std::uint8_t* lane = job.tables.lanes.data() + first;
      for (int t = 0; t < triangles; ++t) {
        out[0] = id[lane[0]];
        out[1] = id[lane[1]];
        out[2] = id[lane[2]];
        out += 3;
        lane += 3;
      }
    }
    for (int r = 0; r < 4; ++r) {
      next.x[r] += static_cast<Index>(popcount(cross.x[r]));
      if constexpr (Zeros) next.zero[r] += static_cast<Index>(popcount(c.used[r]));
    }
    for (int r = 0; r < 2; ++r) {
      next.y[r] += static_cast<Index>(popcount(cross.y[r]));
      next.z[r] += static_cast<Index>(popcount(cross.z[r]));
    }
  }
}

template <bool Zeros, class Index>
void generate_portable(const RowJob<Index>& job, const CellRow& row) {
  generate_body<Zeros>(job, row);
}
template <bool Zeros, class Index>
SHAPE3D_ZMC_TARGET_AVX2 void generate_avx2(const RowJob<Index>& job, const CellRow& row) {
  generate_body<Zeros>(job, row);
}

}  // namespace

template <class Index>
void generate_cell_row(const LatticeCells& cells, const Plan& plan, const TriangleTables& tables,
                       const CentroidSink& centroids, std::int64_t j, std::int64_t k,
                       Index* triangles) {
  constexpr unsigned kBoth = kRowNegative | kRowPositive;
  const CellRow row = cell_row(cells.lattice(), j, k);
  if ((row.any_flags & kBoth) != kBoth) return;
  const RowJob<Index> job{
      cells, plan, tables, centroids, j, k, triangles + 3 * plan.first_triangle(row.row[0])};
  const bool zeros = (row.any_flags & kRowZero) != 0;
  if (active_isa() == Isa::portable) {
    zeros ? generate_portable<true>(job, row) : generate_portable<false>(job, row);
  } else {
    zeros ? generate_avx2<true>(job, row) : generate_avx2<false>(job, row);
  }
}

template void generate_cell_row(const LatticeCells&, const Plan&, const TriangleTables&,
                                const CentroidSink&, std::int64_t, std::int64_t, std::int32_t*);
template void generate_cell_row(const LatticeCells&, const Plan&, const TriangleTables&,
                                const CentroidSink&, std::int64_t, std::int64_t, std::int64_t*);

}  // namespace shape3d::zmc::detail
