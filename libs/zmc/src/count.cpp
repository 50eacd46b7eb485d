#include "count.hpp"

#include <algorithm>
#include <memory>
#include <mutex>

#include "count_cells.hpp"
#include "crossings.hpp"

namespace shape3d::zmc::detail {
namespace {

class Counter {
 public:
  Counter(SignLattice& lattice, const LatticeCells& cells, const ZeroRegions& regions,
          const Options& options, Plan& plan)
      : lattice_(lattice),
        cells_(cells),
        regions_(regions),
        options_(options),
        plan_(plan),
        crossings_(lattice),
        tables_(triangle_tables(options.triangulation, false)) {}

  /// Crossings, patches and inserted faces of layers [first, last).
  void count_layers(std::int64_t first, std::int64_t last) {
    std::unique_ptr<Tallies> tallies = take_tallies();
    for (std::int64_t k = first; k < last; ++k) {
      LayerPlan& layer = plan_.layers[static_cast<std::size_t>(k)];
      layer = LayerPlan{};
      Tally& counted = in_part(k) ? tallies->part : tallies->elsewhere;
      for (std::int64_t j = 0; j < lattice_.ny; ++j) count_row(j, k, layer, counted);
      find_inserted_faces(cells_, regions_, options_.zero_faces, k, layer.quads, layer.closing);
      for (const auto* faces : {&layer.quads, &layer.closing}) {
        for (const InsertedFace& face : *faces) use_vertices(face, k, layer);
      }
      if (options_.triangulation == Triangulation::centroid) {
        for (const InsertedFace& face : layer.quads) {
          ++plan_.rows[static_cast<std::size_t>(lattice_.row(face.j, k))].first_vertex;
        }
      }
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    idle_.push_back(std::move(tallies));
  }

  /// Adds the used zero samples of each row, which are known once every layer is counted.
  void count_zero_vertices(std::int64_t first, std::int64_t last) {
    std::int64_t total = 0;
    for (std::int64_t k = first; k < last; ++k) {
      for (std::int64_t j = 0; j < lattice_.ny; ++j) {
        const std::int64_t row = lattice_.row(j, k);
        if ((lattice_.flags[static_cast<std::size_t>(row)] & kRowZero) == 0) continue;
        std::uint32_t used = 0;
        for (std::int64_t w = 0; w < lattice_.words; ++w) {
          used += static_cast<std::uint32_t>(__builtin_popcountll(crossings_.used_zeros(j, k, w)));
        }
        plan_.rows[static_cast<std::size_t>(row)].first_vertex += used;
        if (in_part(k)) total += used;
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
      if (!in_part(k)) continue;
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
    Tally tally;
    for (const auto& tallies : idle_) tally.add(tallies->part);
    counts.patches = tally.patches;
    const auto add_cells = [&](std::size_t p, std::int64_t cells) {
      counts.cells_with_patch += cells;
      for (const std::uint8_t c : table.cases[p].face_case) counts.faces_by_case[c - 1u] += cells;
    };
    for (std::size_t mask = 0; mask < tables_.plain.size(); ++mask) {
      const std::int64_t plain_cells = tally.plain[0][mask] + tally.plain[1][mask];
      if (plain_cells == 0) continue;
      add_cells(table.case_of_mask[mask], plain_cells);
      if (tables_.plain[mask].ambiguous == 0)
        counts.patches += tables_.plain[mask].patches * plain_cells;
    }
    for (std::size_t p = 0; p < tally.by_case.size(); ++p) {
      if (tally.by_case[p] != 0) add_cells(p, tally.by_case[p]);
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
      if (in_part(static_cast<std::int64_t>(row) / lattice_.ny)) counts.centroids += others;
      vertices += others + r.x + r.y + r.z;
      triangles += own_triangles;
    }
    counts.centroids -= counts.zero_vertices;
    const auto before = [&](std::int64_t plane, auto first_of, std::int64_t all) {
      return plane < lattice_.nz ? (plan_.*first_of)(lattice_.row(0, plane)) : all;
    };
    plan_.part_vertex = before(plan_.part.first, &Plan::first_vertex, vertices);
    plan_.part_triangle = before(plan_.part.first, &Plan::first_triangle, triangles);
    plan_.vertices = before(plan_.part.last, &Plan::first_vertex, vertices) - plan_.part_vertex;
    plan_.patch_triangles =
        before(plan_.part.last, &Plan::first_triangle, triangles) - plan_.part_triangle;
    for (std::int64_t k = plan_.part.first; k < plan_.part.last; ++k) {
      LayerPlan& layer = plan_.layers[static_cast<std::size_t>(k)];
      layer.first_quad = counts.zero_faces;
      layer.first_closing = counts.closing_triangles;
      counts.zero_faces += static_cast<std::int64_t>(layer.quads.size());
      counts.closing_triangles += static_cast<std::int64_t>(layer.closing.size());
    }
    if (lattice_.masked) {
      const std::int64_t layers = std::min(plan_.part.last, lattice_.nz - 1) - plan_.part.first;
      const std::int64_t all = (lattice_.nx - 1) * (lattice_.ny - 1) * layers;
      std::int64_t valid = 0;
      for (std::int64_t w = lattice_.row(0, plan_.part.first) * lattice_.words;
           w < lattice_.row(0, plan_.part.first + layers) * lattice_.words; ++w) {
        valid += __builtin_popcountll(lattice_.cell_bits[static_cast<std::size_t>(w)]);
      }
      counts.masked_cells = all - valid;
    }
  }

 private:
  /// What threads count; kept from range to range, since they are large.
  struct Tallies {
    Tally part, elsewhere;
  };
  std::unique_ptr<Tallies> take_tallies() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (idle_.empty()) return std::make_unique<Tallies>();
    std::unique_ptr<Tallies> taken = std::move(idle_.back());
    idle_.pop_back();
    return taken;
  }

  bool in_part(std::int64_t k) const { return k >= plan_.part.first && k < plan_.part.last; }

  void count_row(std::int64_t j, std::int64_t k, LayerPlan& layer, Tally& tally) {
    RowPlan& plan = plan_.rows[static_cast<std::size_t>(lattice_.row(j, k))];
    if (j + 1 < lattice_.ny && k + 1 < lattice_.nz) {
      plan =
          count_cell_row(lattice_, cells_, tables_, j, k, layer, options_.count_nonmanifold, tally);
      return;
    }
    plan = RowPlan{};  // the last row or layer has no cells of its own
    for (std::int64_t w = 0; w < lattice_.words; ++w) {
      plan.x += static_cast<std::uint32_t>(__builtin_popcountll(crossings_.along_x(j, k, w)));
      plan.y += static_cast<std::uint32_t>(__builtin_popcountll(crossings_.along_y(j, k, w)));
      plan.z += static_cast<std::uint32_t>(__builtin_popcountll(crossings_.along_z(j, k, w)));
    }
  }

  void use_vertices(const InsertedFace& face, std::int64_t k, LayerPlan& layer) {
    const FacePolygon polygon = face_polygon(lattice_, face, k);
    for (int n = 0; n < polygon.size; ++n) {
      const int a = polygon.vertices[n] - 12, b = polygon.vertices[(n + 1) % polygon.size] - 12;
      if (a < 0) continue;
      mark_used(lattice_, face.i + kCellVertices[a][0],
                lattice_.row(face.j + kCellVertices[a][1], k + kCellVertices[a][2]));
      if (b >= 0 && options_.count_nonmanifold)
        use_lattice_edge(lattice_, a, b, face.i, face.j, layer);
    }
  }

  SignLattice& lattice_;
  const LatticeCells& cells_;
  const ZeroRegions& regions_;
  const Options& options_;
  Plan& plan_;
  Crossings crossings_;
  const TriangleTables& tables_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Tallies>> idle_;
};

}  // namespace

bool make_plan(SignLattice& lattice, const LatticeCells& cells, const ZeroRegions& regions,
               const Options& options, const Plan::Part& part, const LayerLoop& for_layers,
               Plan& plan) {
  plan.part = part;
  plan.rows.resize(static_cast<std::size_t>(lattice.rows()));
  plan.layers.resize(static_cast<std::size_t>(lattice.nz));
  plan.group_vertex.clear();
  plan.group_triangle.clear();
  plan.counts = Counts{};
  plan.counts.nonmanifold_edges = options.count_nonmanifold ? 0 : -1;
  Counter counter(lattice, cells, regions, options, plan);
  const auto run = [&](void (Counter::*stage)(std::int64_t, std::int64_t)) {
    return for_layers(
        lattice.nz, [&](std::int64_t first, std::int64_t last) { (counter.*stage)(first, last); });
  };
  if (!run(&Counter::count_layers)) return false;
  if (!run(&Counter::count_zero_vertices)) return false;
  if (options.count_nonmanifold && !run(&Counter::count_nonmanifold)) return false;
  counter.finish();
  return true;
}

}  // namespace shape3d::zmc::detail
