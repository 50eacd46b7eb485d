#include "count.hpp"

#include <algorithm>
#include <mutex>

#include "cell_words.hpp"
#include "crossings.hpp"

namespace shape3d::zmc::detail {
namespace {

/// How often each case occurred, and sums over configurations.
struct Tally {
  std::vector<std::int64_t> cases = std::vector<std::int64_t>(6561, 0);
  std::int64_t patches = 0;

  void add(const Tally& other) {
    for (std::size_t p = 0; p < cases.size(); ++p) cases[p] += other.cases[p];
    patches += other.patches;
  }
};

class Counter {
 public:
  Counter(SignLattice& lattice, const LatticeCells& cells, const ZeroRegions& regions,
          const Options& options, Plan& plan)
      : lattice_(lattice),
        cells_(cells),
        regions_(regions),
        options_(options),
        plan_(plan),
        crossings_(lattice) {
    for (unsigned mask = 0; mask < 256; ++mask)
      case_of_plain_[mask] = cells.table().case_of_mask[mask];
  }

  /// Crossings, patches and inserted faces of layers [first, last).
  void count_layers(std::int64_t first, std::int64_t last) {
    Tally tally;
    for (std::int64_t k = first; k < last; ++k) {
      LayerPlan& layer = plan_.layers[static_cast<std::size_t>(k)];
      layer = LayerPlan{};
      for (std::int64_t j = 0; j < lattice_.ny; ++j) count_row(j, k, layer, tally);
      find_inserted_faces(cells_, regions_, options_.zero_faces, k, layer.quads, layer.closing);
      for (const auto* faces : {&layer.quads, &layer.closing}) {
        for (const InsertedFace& face : *faces) use_vertices(face, k, layer);
      }
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    tally_.add(tally);
  }

  /// Adds the used zero samples of each row, which are known once every layer is counted.
  void count_zero_vertices(std::int64_t first, std::int64_t last) {
    std::int64_t total = 0;
    for (std::int64_t k = first; k < last; ++k) {
      for (std::int64_t j = 0; j < lattice_.ny; ++j) {
        std::uint32_t used = 0;
        for (std::int64_t w = 0; w < lattice_.words; ++w) {
          used += static_cast<std::uint32_t>(__builtin_popcountll(crossings_.used_zeros(j, k, w)));
        }
        plan_.rows[static_cast<std::size_t>(lattice_.row(j, k))].first_vertex += used;
        total += used;
      }
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    plan_.counts.zero_vertices += total;
  }

  /// Edges of more than two triangles that start in the lower planes of layers [first, last).
  void count_nonmanifold(std::int64_t first, std::int64_t last) {
    std::int64_t total = 0;
    std::vector<std::uint64_t> edges;
    for (std::int64_t k = first; k < last; ++k) {
      edges = plan_.layers[static_cast<std::size_t>(k)].lower_edges;
      if (k > 0) {
        const auto& below = plan_.layers[static_cast<std::size_t>(k - 1)].upper_edges;
        edges.insert(edges.end(), below.begin(), below.end());
      }
      std::sort(edges.begin(), edges.end());
      for (std::size_t at = 0; at < edges.size();) {
        std::size_t end = at + 1;
        while (end < edges.size() && edges[end] == edges[at]) ++end;
        if (end - at > 2) ++total;
        at = end;
      }
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    plan_.counts.nonmanifold_edges += total;
  }

  /// Prefix sums; turns counts into places.
  void finish() {
    const CellTable& table = cells_.table();
    Counts& counts = plan_.counts;
    counts.patches = tally_.patches;
    for (std::size_t p = 0; p < tally_.cases.size(); ++p) {
      if (tally_.cases[p] == 0) continue;
      counts.cells_with_patch += tally_.cases[p];
      for (const std::uint8_t c : table.cases[p].face_case)
        counts.faces_by_case[c - 1u] += tally_.cases[p];
    }
    counts.all_zero_cells = regions_.cell_count();

    std::int64_t vertices = 0, triangles = 0;
    for (std::size_t row = 0; row < plan_.rows.size(); ++row) {
      if ((row & ((std::size_t{1} << Plan::kGroupShift) - 1)) == 0) {
        plan_.group_vertex.push_back(vertices);
        plan_.group_triangle.push_back(triangles);
      }
      RowPlan& r = plan_.rows[row];
      const std::int64_t others = r.first_vertex, own_triangles = r.first_triangle;
      r.first_vertex = static_cast<std::uint32_t>(vertices - plan_.group_vertex.back());
      r.first_triangle = static_cast<std::uint32_t>(triangles - plan_.group_triangle.back());
      counts.centroids += others;
      vertices += others + r.x + r.y + r.z;
      triangles += own_triangles;
    }
    counts.centroids -= counts.zero_vertices;
    plan_.row_vertices = vertices;
    plan_.patch_triangles = triangles;
    for (LayerPlan& layer : plan_.layers) {
      layer.first_quad = counts.zero_faces;
      layer.first_closing = counts.closing_triangles;
      counts.zero_faces += static_cast<std::int64_t>(layer.quads.size());
      counts.closing_triangles += static_cast<std::int64_t>(layer.closing.size());
    }
    if (options_.triangulation == Triangulation::centroid) counts.centroids += counts.zero_faces;
    if (lattice_.masked) {
      const std::int64_t all = (lattice_.nx - 1) * (lattice_.ny - 1) * (lattice_.nz - 1);
      std::int64_t valid = 0;
      for (const Word word : lattice_.cell_bits) valid += __builtin_popcountll(word);
      counts.masked_cells = all - valid;
    }
  }

 private:
  void count_row(std::int64_t j, std::int64_t k, LayerPlan& layer, Tally& tally) {
    RowPlan plan;
    const auto flags = [&](std::int64_t a, std::int64_t b) {
      return a < lattice_.ny && b < lattice_.nz
                 ? lattice_.flags[static_cast<std::size_t>(lattice_.row(a, b))]
                 : 0;
    };
    constexpr unsigned kBoth = kRowNegative | kRowPositive;
    const unsigned here = flags(j, k);
    if ((here & kBoth) == kBoth)
      plan.x = count_words([&](std::int64_t w) { return crossings_.along_x(j, k, w); });
    if (((here | flags(j + 1, k)) & kBoth) == kBoth) {
      plan.y = count_words([&](std::int64_t w) { return crossings_.along_y(j, k, w); });
    }
    if (((here | flags(j, k + 1)) & kBoth) == kBoth) {
      plan.z = count_words([&](std::int64_t w) { return crossings_.along_z(j, k, w); });
    }
    if (j + 1 < lattice_.ny && k + 1 < lattice_.nz) {
      const CellRow row = cell_row(lattice_, j, k);
      if ((row.any_flags & kBoth) == kBoth) {
        if ((row.any_flags & kRowZero) != 0) {
          count_cells<true>(row, j, k, plan, layer, tally);
        } else {
          count_cells<false>(row, j, k, plan, layer, tally);
        }
      }
    }
    plan_.rows[static_cast<std::size_t>(lattice_.row(j, k))] = plan;
  }

  template <class Words>
  std::uint32_t count_words(Words&& words) const {
    std::uint32_t count = 0;
    for (std::int64_t w = 0; w < lattice_.words; ++w)
      count += static_cast<std::uint32_t>(__builtin_popcountll(words(w)));
    return count;
  }

  /// Triangles and centroids of a cell row; the latter are kept in first_vertex until finish().
  template <bool Zeros>
  void count_cells(const CellRow& row, std::int64_t j, std::int64_t k, RowPlan& plan,
                   LayerPlan& layer, Tally& tally) {
    const auto triangulation = static_cast<std::size_t>(options_.triangulation);
    const CellTable& table = cells_.table();
    for (std::int64_t w = 0; w < lattice_.words; ++w) {
      const CellWords c = cell_words<Zeros>(row, w, below_mask(lattice_.nx - 1, w));
      for (Word left = c.active; left != 0; left &= left - 1) {
        const int b = __builtin_ctzll(left);
        const std::int64_t i = 64 * w + b;
        const bool zero = Zeros && ((c.with_zero >> b) & 1u) != 0;
        const unsigned negative = gather_corners(c.n, c.n_next, b);
        const unsigned p =
            zero ? table.case_of_mask[negative | gather_corners(c.z, c.z_next, b) << 8]
                 : case_of_plain_[negative];
        const CellConfig& config = cells_.config(table.cases[p], i, j, k);
        plan.first_triangle += config.by_triangulation[triangulation].triangles;
        plan.first_vertex += config.by_triangulation[triangulation].centroids;
        ++tally.cases[p];
        tally.patches += config.patches;
        if (zero && config.zero_vertices != 0) use_zero_vertices(config, row, i, j, layer);
      }
    }
  }

  void use_zero_vertices(const CellConfig& config, const CellRow& row, std::int64_t i,
                         std::int64_t j, LayerPlan& layer) {
    for (int corner = 0; corner < 8; ++corner) {
      if (((config.zero_vertices >> corner) & 1) != 0)
        mark_used(lattice_, i + (corner >> 2), row.row[corner & 3]);
    }
    for (unsigned edges = config.zero_edges; edges != 0; edges &= edges - 1) {
      const int e = __builtin_ctz(edges);
      use_edge(kCellEdges[e][0], kCellEdges[e][1], i, j, layer);
    }
  }

  /// Notes a side along the lattice edge between two corners of cell (i, j).
  void use_edge(int v, int w, std::int64_t i, std::int64_t j, LayerPlan& layer) const {
    const auto &p = kCellVertices[v], &q = kCellVertices[w];
    const int axis = p[0] != q[0] ? 0 : p[1] != q[1] ? 1 : 2;
    const std::int64_t x = i + std::min(p[0], q[0]), y = j + std::min(p[1], q[1]);
    auto& edges = std::min(p[2], q[2]) == 0 ? layer.lower_edges : layer.upper_edges;
    edges.push_back(3 * static_cast<std::uint64_t>(x + lattice_.nx * y) +
                    static_cast<std::uint64_t>(axis));
  }

  void use_vertices(const InsertedFace& face, std::int64_t k, LayerPlan& layer) {
    const FacePolygon polygon = face_polygon(lattice_, face, k);
    for (int n = 0; n < polygon.size; ++n) {
      const int a = polygon.vertices[n] - 12, b = polygon.vertices[(n + 1) % polygon.size] - 12;
      if (a < 0) continue;
      mark_used(lattice_, face.i + kCellVertices[a][0],
                lattice_.row(face.j + kCellVertices[a][1], k + kCellVertices[a][2]));
      if (b >= 0) use_edge(a, b, face.i, face.j, layer);
    }
  }

  SignLattice& lattice_;
  const LatticeCells& cells_;
  const ZeroRegions& regions_;
  const Options& options_;
  Plan& plan_;
  Crossings crossings_;
  std::array<std::uint16_t, 256> case_of_plain_{};
  std::mutex mutex_;
  Tally tally_;
};

}  // namespace

bool make_plan(SignLattice& lattice, const LatticeCells& cells, const ZeroRegions& regions,
               const Options& options, const LayerLoop& for_layers, Plan& plan) {
  plan.rows.resize(static_cast<std::size_t>(lattice.rows()));
  plan.layers.resize(static_cast<std::size_t>(lattice.nz));
  plan.group_vertex.clear();
  plan.group_triangle.clear();
  plan.counts = Counts{};
  Counter counter(lattice, cells, regions, options, plan);
  const auto run = [&](void (Counter::*stage)(std::int64_t, std::int64_t)) {
    return for_layers(
        lattice.nz, [&](std::int64_t first, std::int64_t last) { (counter.*stage)(first, last); });
  };
  if (!run(&Counter::count_layers)) return false;
  if (!run(&Counter::count_zero_vertices)) return false;
  if (!run(&Counter::count_nonmanifold)) return false;
  counter.finish();
  return true;
}

}  // namespace shape3d::zmc::detail
