#include "triangles.hpp"

#include "cell_words.hpp"
#include "corner_bytes.hpp"
#include "crossings.hpp"
#include "isa.hpp"

#if SHAPE3D_ZMC_X86
#include <immintrin.h>
// GCC 12 takes the undefined pass-through operand inside its own intrinsics for a use (GCC bug
// 105593).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace shape3d::zmc::detail {
namespace {

SHAPE3D_ZMC_INLINE int popcount(Word word) { return __builtin_popcountll(word); }

CrossingWords masked_crossing_words(const Crossings& crossings, std::int64_t j, std::int64_t k,
                                    std::int64_t w) {
  CrossingWords words{};
  for (int r = 0; r < 4; ++r) words[r] = crossings.along_x(j + (r & 1), k + (r >> 1), w);
  words[4] = crossings.along_y(j, k, w);
  words[5] = crossings.along_y(j, k + 1, w);
  words[6] = crossings.along_z(j, k, w);
  words[7] = crossings.along_z(j + 1, k, w);
  return words;
}

/// One cell row of an extraction.
template <class Index>
struct RowJob {
  const LatticeCells& cells;
  const Plan& plan;
  const TriangleTables& tables;
  const CentroidSink& centroids;
  std::int64_t j, k;
  Index* out;
  const Index* end;  ///< Until where nothing is written yet.
  CornerBytes corner_bytes;
};

/// Ids of the next vertices round a cell row, by lane (crossings 0–7, zeros) and the next centroid.
template <class Index>
struct RunningIds {
  std::array<Index, 8> crossing{};
  std::array<Index, 4> zero{};
  Index centroid = 0;

  RunningIds(const SignLattice& lattice, const Plan& plan, const CellRow& row) {
    for (int r = 0; r < 4; ++r) {
      const RowPlan& p = plan.rows[static_cast<std::size_t>(row.row[r])];
      const auto first = static_cast<Index>(plan.first_row_id(row.row[r]));
      crossing[r] = first;
      if (r % 2 == 0) crossing[4 + r / 2] = first + static_cast<Index>(p.x);
      if (r < 2) crossing[6 + r] = first + static_cast<Index>(p.x) + static_cast<Index>(p.y);
      zero[r] = first + static_cast<Index>(p.x) + static_cast<Index>(p.y) + static_cast<Index>(p.z);
    }
    centroid = zero[0];
    if ((row.any_flags & kRowZero) == 0 || plan.counts.centroids == 0) return;
    for (std::int64_t w = 0; w < lattice.words; ++w) {
      centroid += static_cast<Index>(popcount(load(row.n[0] + w) & row.z[0][w]));
    }
  }
};

struct CellTriangles {
  const std::uint8_t* lane;
  int triangles;
};

/// Triangles of a cell that is ambiguous or has centroids, whose ids are appended to
/// `centroid_ids`.
template <class Index>
__attribute__((noinline)) CellTriangles special_cell(const RowJob<Index>& job, unsigned p,
                                                     std::int64_t i, Index& next_centroid,
                                                     Index* centroid_ids) {
  const CellTable& table = job.cells.table();
  const Triangulated& t =
      job.cells.config(table.cases[p], i, job.j, job.k).by_triangulation[job.tables.triangulation];
  for (int n = 0; n < t.centroids; ++n) {
    const std::uint32_t members = table.centroids[static_cast<std::size_t>(t.first_centroid + n)];
    job.centroids.put(static_cast<std::int64_t>(next_centroid), members, i, job.j, job.k);
    centroid_ids[n] = next_centroid++;
  }
  return {job.tables.lanes.data() + t.first, t.triangles};
}

/// Looks a cell up by its corner masks.
template <bool Zeros, class Index>
SHAPE3D_ZMC_INLINE CellTriangles look_up(const RowJob<Index>& job, unsigned negative, unsigned zero,
                                         std::int64_t i, Index& next_centroid,
                                         Index* centroid_ids) {
  const CellTable& table = job.cells.table();
  const bool plain = !Zeros || zero == 0;
  const unsigned p = plain ? 0 : table.case_of_mask[negative | zero << 8];
  const PatternTriangles& pattern = plain ? job.tables.plain[negative] : job.tables.by_case[p];
  if ((pattern.ambiguous | pattern.centroids) != 0) {
    return special_cell(job, plain ? table.case_of_mask[negative] : p, i, next_centroid,
                        centroid_ids);
  }
  return {job.tables.lanes.data() + pattern.first, pattern.triangles};
}

template <bool Zeros, class Index>
SHAPE3D_ZMC_INLINE void generate_body(const RowJob<Index>& job, const CellRow& row) {
  const SignLattice& lattice = job.cells.lattice();
  const Crossings crossings(lattice);
  Index* out = job.out;
  RunningIds<Index> next(lattice, job.plan, row);
  std::array<Index, kLanes> id{};
  alignas(64) std::array<std::uint8_t, 64> negative, zero{};
  for (std::int64_t w = 0; w < lattice.words; ++w) {
    const Word in_cells = below_mask(lattice.nx - 1, w);
    const CellWords c = cell_words<Zeros>(row, w, in_cells);
    if (!Zeros && c.active == 0 && row.valid == nullptr) continue;  // then nothing crosses here
    const CrossingWords cross = row.valid == nullptr
                                    ? crossing_words<Zeros>(c, in_cells)
                                    : masked_crossing_words(crossings, job.j, job.k, w);
    if (c.active != 0) {
      job.corner_bytes(c.n, negative.data());
      if (Zeros) job.corner_bytes(c.z, zero.data());
    }
    for (Word left = c.active; left != 0; left &= left - 1) {
      const int b = __builtin_ctzll(left);
      const Word below = (Word{1} << b) - 1;
      for (int lane = 0; lane < 8; ++lane) {
        id[lane] = static_cast<Index>(next.crossing[lane] + popcount(cross[lane] & below));
        if (lane >= 4) id[lane + 8] = id[lane] + static_cast<Index>((cross[lane] >> b) & 1u);
      }
      if (Zeros && zero[b] != 0) {
        for (int r = 0; r < 4; ++r) {
          id[kZeroLane + r] = static_cast<Index>(next.zero[r] + popcount(c.used[r] & below));
          id[kZeroLane + 4 + r] = id[kZeroLane + r] + static_cast<Index>((c.used[r] >> b) & 1u);
        }
      }
      auto [lane, triangles] = look_up<Zeros>(job, negative[b], zero[b], 64 * w + b, next.centroid,
                                              id.data() + kCentroidLane);
      for (; triangles > 0; --triangles) {
        out[0] = id[lane[0]];
        out[1] = id[lane[1]];
        out[2] = id[lane[2]];
        out += 3;
        lane += 3;
      }
    }
    for (int lane = 0; lane < 8; ++lane)
      next.crossing[lane] += static_cast<Index>(popcount(cross[lane]));
    if constexpr (Zeros) {
      for (int r = 0; r < 4; ++r) next.zero[r] += static_cast<Index>(popcount(c.used[r]));
    }
  }
}

template <bool Zeros, class Index>
void generate_portable(const RowJob<Index>& job, const CellRow& row) {
  generate_body<Zeros>(job, row);
}

#if SHAPE3D_ZMC_X86
template <bool Zeros, class Index>
SHAPE3D_ZMC_TARGET_AVX2 void generate_avx2(const RowJob<Index>& job, const CellRow& row) {
  generate_body<Zeros>(job, row);
}

/// What look_up() and the ids of a cell with zeros or special patterns need, of one word.
struct WordState {
  std::int64_t w;
  const std::array<Word, 4>* used;
  const std::uint8_t *negative, *zero;
};

/// Writes the triangles of a cell whatever it is, from the ids of the crossings at its low end in
/// `next` and those at its high end in `beyond`.
template <bool Zeros>
SHAPE3D_ZMC_TARGET_AVX2 __attribute__((noinline)) std::int32_t* put_any_cell(
    const RowJob<std::int32_t>& job, const WordState& word, int b, const std::int32_t* beyond,
    RunningIds<std::int32_t>& next, std::int32_t* out) {
  std::array<std::int32_t, kLanes> id;
  for (int lane = 0; lane < 8; ++lane) id[lane] = next.crossing[lane];
  for (int lane = 4; lane < 8; ++lane) id[lane + 8] = beyond[lane];
  const unsigned zero = Zeros ? word.zero[b] : 0;
  if (zero != 0) {
    const Word below = (Word{1} << b) - 1;
    for (int r = 0; r < 4; ++r) {
      const Word used = (*word.used)[r];
      id[kZeroLane + r] = next.zero[r] + popcount(used & below);
      id[kZeroLane + 4 + r] = id[kZeroLane + r] + static_cast<int>((used >> b) & 1u);
    }
  }
  auto [lane, triangles] = look_up<Zeros>(job, word.negative[b], zero, 64 * word.w + b,
                                          next.centroid, id.data() + kCentroidLane);
  for (; triangles > 0; --triangles, lane += 3, out += 3) {
    for (int corner = 0; corner < 3; ++corner) out[corner] = id[lane[corner]];
  }
  return out;
}

SHAPE3D_ZMC_TARGET_AVX2 __m256i load_bytes(const std::uint8_t* bytes) {
  return _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes)));
}

SHAPE3D_ZMC_TARGET_AVX2 __m256i choose(__m256i a, __m256i b, __m256i sign) {
  return _mm256_castps_si256(
      _mm256_blendv_ps(_mm256_castsi256_ps(a), _mm256_castsi256_ps(b), _mm256_castsi256_ps(sign)));
}

/// Writes the ids of eight lanes: 0 … 7 of the low end, 8 … 15 of the high end.
SHAPE3D_ZMC_TARGET_AVX2 void put_ids(const std::uint8_t* lane, __m256i low, __m256i high,
                                     std::int32_t* out) {
  const __m256i lanes = load_bytes(lane);
  const __m256i ids =
      choose(_mm256_permutevar8x32_epi32(low, lanes), _mm256_permutevar8x32_epi32(high, lanes),
             _mm256_slli_epi32(lanes, 28));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), ids);
}

/// The same, and 16 … 23 of the zeros.
SHAPE3D_ZMC_TARGET_AVX2 void put_ids(const std::uint8_t* lane, __m256i low, __m256i high,
                                     __m256i zeros, std::int32_t* out) {
  const __m256i lanes = load_bytes(lane);
  const __m256i crossings =
      choose(_mm256_permutevar8x32_epi32(low, lanes), _mm256_permutevar8x32_epi32(high, lanes),
             _mm256_slli_epi32(lanes, 28));
  const __m256i ids =
      choose(crossings, _mm256_permutevar8x32_epi32(zeros, lanes), _mm256_slli_epi32(lanes, 27));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), ids);
}

/// Ids of the used zeros round cell b of a word, at its low end and at its high end.
SHAPE3D_ZMC_TARGET_AVX2 __m256i zero_ids(const std::array<std::int32_t, 4>& next,
                                         const std::array<Word, 4>& used, int b) {
  static_assert(kZeroLane == 16);
  alignas(32) std::array<std::int32_t, 8> ids;
  const Word below = (Word{1} << b) - 1;
  for (std::size_t r = 0; r < 4; ++r) {
    ids[r] = next[r] + popcount(used[r] & below);
    ids[r + 4] = ids[r] + static_cast<int>((used[r] >> b) & 1u);
  }
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(ids.data()));
}

/// The same for 32-bit ids in rows without masked samples: a cell that is not active has no
/// crossings there, so that ids advance from active cell to active cell.
template <bool Zeros>
SHAPE3D_ZMC_TARGET_AVX2 void generate_steps_avx2(const RowJob<std::int32_t>& job,
                                                 const CellRow& row) {
  const SignLattice& lattice = job.cells.lattice();
  const PlainCell* cells = job.tables.cells.data();
  std::int32_t* out = job.out;
  // Two whole vectors are written as long as what they overrun is still to be written.
  constexpr std::ptrdiff_t kWhole = 16;
  RunningIds<std::int32_t> next(lattice, job.plan, row);
  __m256i low = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(next.crossing.data()));
  alignas(64) std::array<std::uint8_t, 64> negative, zero;
  ActiveCells<Zeros> cells_at(row);
  CellWords c;
  for (std::int64_t w = 0; w < lattice.words; ++w) {
    cells_at.next(w, below_mask(lattice.nx - 1, w));
    const Word with_zero = Zeros ? cells_at.with_zero : 0;
    if (with_zero != 0) {
      load_corners<Zeros>(row, w, c);
      put_corner_bytes_avx2(c.z, zero.data());
    } else if (cells_at.active != 0) {
      load_corners<false>(row, w, c);
    }
    if (cells_at.active != 0) put_corner_bytes_avx2(c.n, negative.data());
    for (Word left = cells_at.active; left != 0; left &= left - 1) {
      const int b = __builtin_ctzll(left);
      const PlainCell& cell = cells[negative[b]];
      const bool any = ((with_zero >> b) & 1u) != 0;
      if (!any && cell.special == 0 && job.end - out >= kWhole) {
        const __m256i high = _mm256_add_epi32(low, load_bytes(cell.steps.data()));
        put_ids(cell.lanes.data(), low, high, out);
        if (cell.triangles > 2) put_ids(cell.lanes.data() + 8, low, high, out + 8);
        out += 3 * cell.triangles;
        low = high;
        continue;
      }
      if (Zeros && with_zero == 0) zero[b] = 0;
      const unsigned crossing = crossing_lanes(negative[b], Zeros ? zero[b] : 0);
      const __m256i bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
      const __m256i here = _mm256_cmpeq_epi32(
          _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(crossing)), bits), bits);
      const __m256i high = _mm256_sub_epi32(low, here);
      if (Zeros && any && job.end - out >= kWhole) {
        const PatternTriangles& pattern =
            job.tables.by_case[job.cells.table().case_of_mask[negative[b] | zero[b] << 8]];
        if ((pattern.ambiguous | pattern.centroids) == 0 && pattern.triangles <= 5) {
          const std::uint8_t* lanes = job.tables.lanes.data() + pattern.first;
          const __m256i zeros = zero_ids(next.zero, c.used, b);
          put_ids(lanes, low, high, zeros, out);
          if (pattern.triangles > 2) put_ids(lanes + 8, low, high, zeros, out + 8);
          out += 3 * pattern.triangles;
          low = high;
          continue;
        }
      }
      alignas(32) std::array<std::int32_t, 8> beyond;
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(next.crossing.data()), low);
      _mm256_store_si256(reinterpret_cast<__m256i*>(beyond.data()), high);
      out = put_any_cell<Zeros>(job, {w, &c.used, negative.data(), zero.data()}, b, beyond.data(),
                                next, out);
      low = high;
    }
    if (Zeros && cells_at.zeros != 0) {
      for (int r = 0; r < 4; ++r) next.zero[r] += popcount(load(row.n[r] + w) & row.z[r][w]);
    }
  }
}

/// The same for 32-bit ids: the ids round a cell are one vector of ranks, and its triangles one
/// permutation of them.
template <bool Zeros>
SHAPE3D_ZMC_TARGET_AVX512 void generate_avx512(const RowJob<std::int32_t>& job,
                                               const CellRow& row) {
  const SignLattice& lattice = job.cells.lattice();
  const Crossings crossings(lattice);
  std::int32_t* out = job.out;
  RunningIds<std::int32_t> next(lattice, job.plan, row);
  __m512i next_crossing = _mm512_cvtepi32_epi64(
      _mm256_loadu_si256(reinterpret_cast<const __m256i*>(next.crossing.data())));
  __m256i next_zero =
      _mm256_cvtepi32_epi64(_mm_loadu_si128(reinterpret_cast<const __m128i*>(next.zero.data())));
  alignas(64) std::array<std::uint8_t, 64> negative, zero{};
  alignas(32) std::array<std::int32_t, 8> centroid_ids{};
  for (std::int64_t w = 0; w < lattice.words; ++w) {
    const Word in_cells = below_mask(lattice.nx - 1, w);
    const CellWords c = cell_words<Zeros>(row, w, in_cells);
    if (!Zeros && c.active == 0 && row.valid == nullptr) continue;
    const CrossingWords cross_words = row.valid == nullptr
                                          ? crossing_words<Zeros>(c, in_cells)
                                          : masked_crossing_words(crossings, job.j, job.k, w);
    const __m512i cross = _mm512_loadu_si512(cross_words.data());
    const __m256i used = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(c.used.data()));
    if (c.active != 0) {
      job.corner_bytes(c.n, negative.data());
      if (Zeros) job.corner_bytes(c.z, zero.data());
    }
    for (Word left = c.active; left != 0; left &= left - 1) {
      const int b = __builtin_ctzll(left);
      const auto below = static_cast<long long>((Word{1} << b) - 1);
      const __m512i rank = _mm512_add_epi64(
          next_crossing, _mm512_popcnt_epi64(_mm512_and_si512(cross, _mm512_set1_epi64(below))));
      const __m512i here =
          _mm512_and_si512(_mm512_srl_epi64(cross, _mm_cvtsi32_si128(b)), _mm512_set1_epi64(1));
      const __m512i ids =
          _mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvtepi64_epi32(rank)),
                             _mm512_cvtepi64_epi32(_mm512_add_epi64(rank, here)), 1);
      __m512i more_ids = _mm512_setzero_si512();
      if (Zeros && zero[b] != 0) {
        const __m256i zero_rank = _mm256_add_epi64(
            next_zero, _mm256_popcnt_epi64(_mm256_and_si256(used, _mm256_set1_epi64x(below))));
        const __m256i zero_here =
            _mm256_and_si256(_mm256_srl_epi64(used, _mm_cvtsi32_si128(b)), _mm256_set1_epi64x(1));
        const __m256i zero_ids = _mm256_inserti128_si256(
            _mm256_castsi128_si256(_mm256_cvtepi64_epi32(zero_rank)),
            _mm256_cvtepi64_epi32(_mm256_add_epi64(zero_rank, zero_here)), 1);
        more_ids = _mm512_castsi256_si512(zero_ids);
      }
      const std::int32_t before = next.centroid;
      auto [lane, triangles] =
          look_up<Zeros>(job, negative[b], zero[b], 64 * w + b, next.centroid, centroid_ids.data());
      if (next.centroid != before) {
        more_ids = _mm512_inserti64x4(
            more_ids, _mm256_load_si256(reinterpret_cast<const __m256i*>(centroid_ids.data())), 1);
      }
      int left_ids = 3 * triangles;
      do {
        const __m512i lanes =
            _mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(lane)));
        const int now = left_ids < 16 ? left_ids : 16;
        _mm512_mask_storeu_epi32(out, static_cast<__mmask16>((1u << now) - 1u),
                                 _mm512_permutex2var_epi32(ids, lanes, more_ids));
        out += now;
        lane += now;
        left_ids -= now;
      } while (left_ids > 0);
    }
    next_crossing = _mm512_add_epi64(next_crossing, _mm512_popcnt_epi64(cross));
    if constexpr (Zeros) next_zero = _mm256_add_epi64(next_zero, _mm256_popcnt_epi64(used));
  }
}
#endif

template <bool Zeros, class Index>
void dispatch(Isa isa, const RowJob<Index>& job, const CellRow& row) {
#if SHAPE3D_ZMC_X86
  if constexpr (sizeof(Index) == 4) {
    if (isa == Isa::avx512) return generate_avx512<Zeros>(job, row);
    if (isa == Isa::avx2 && row.valid == nullptr) return generate_steps_avx2<Zeros>(job, row);
  }
  if (isa != Isa::portable) return generate_avx2<Zeros>(job, row);
#endif
  static_cast<void>(isa);
  generate_portable<Zeros>(job, row);
}

}  // namespace

template <class Index>
void generate_cell_row(const LatticeCells& cells, const Plan& plan, const TriangleTables& tables,
                       const CentroidSink& centroids, std::int64_t j, std::int64_t k,
                       Index* triangles, const Index* end) {
  constexpr unsigned kBoth = kRowNegative | kRowPositive;
  const CellRow row = cell_row(cells.lattice(), j, k);
  if ((row.any_flags & kBoth) != kBoth) return;
  const Isa isa = active_isa();
  const RowJob<Index> job{cells,
                          plan,
                          tables,
                          centroids,
                          j,
                          k,
                          triangles + 3 * (plan.first_triangle(row.row[0]) - plan.part_triangle),
                          end,
                          corner_bytes(isa)};
  if ((row.any_flags & kRowZero) != 0) {
    dispatch<true>(isa, job, row);
  } else {
    dispatch<false>(isa, job, row);
  }
}

template void generate_cell_row(const LatticeCells&, const Plan&, const TriangleTables&,
                                const CentroidSink&, std::int64_t, std::int64_t, std::int32_t*,
                                const std::int32_t*);
template void generate_cell_row(const LatticeCells&, const Plan&, const TriangleTables&,
                                const CentroidSink&, std::int64_t, std::int64_t, std::int64_t*,
                                const std::int64_t*);

}  // namespace shape3d::zmc::detail
