#include "generate.hpp"

#include "cell_words.hpp"
#include "generate_vertices.hpp"

namespace shape3d::zmc::detail {
namespace {

int popcount(Word word) { return __builtin_popcountll(word); }

/// Ids of the next vertex of each kind round a cell row, advanced word by word.
template <class Index>
struct RunningIds {
  std::array<Index, 4> x{}, zero{};
  std::array<Index, 2> y{}, z{};
  Index centroid = 0;
};

template <class Real, class Index>
class Generator {
 public:
  Generator(const VolumeView& view, double isovalue, const Options& options,
            const LatticeCells& cells, const Plan& plan, Surface<Real, Index>& surface)
      : cells_(cells),
        lattice_(cells.lattice()),
        crossings_(cells.lattice()),
        plan_(plan),
        geometry_(view, options.border == Border::capped),
        magnitude_(view, isovalue, options.border == Border::capped),
        options_(options),
        surface_(surface),
        slots_(cells.table().slots) {
    if (geometry_.mirrored()) {
      for (std::size_t t = 0; t < slots_.size(); t += 3) std::swap(slots_[t + 1], slots_[t + 2]);
    }
  }

  void cell_rows(std::int64_t first, std::int64_t last) {
    constexpr unsigned kBoth = kRowNegative | kRowPositive;
    for (std::int64_t k = first; k < last && k + 1 < lattice_.nz; ++k) {
      for (std::int64_t j = 0; j + 1 < lattice_.ny; ++j) {
        const CellRow row = cell_row(lattice_, j, k);
        if ((row.any_flags & kBoth) != kBoth) continue;
        if ((row.any_flags & kRowZero) != 0) {
          cell_row_triangles<true>(row, j, k);
        } else {
          cell_row_triangles<false>(row, j, k);
        }
      }
      inserted_faces(k);
    }
  }

 private:
  template <bool Zeros>
  void cell_row_triangles(const CellRow& row, std::int64_t j, std::int64_t k) {
    const CellTable& table = cells_.table();
    const auto triangulation = static_cast<std::size_t>(options_.triangulation);
    Index* out = surface_.indices.data() + 3 * plan_.first_triangle(row.row[0]);
    RunningIds<Index> next = first_ids(row);
    std::array<Index, kSlots + 4> id{};
    for (std::int64_t w = 0; w < lattice_.words; ++w) {
      const CellWords c = cell_words<Zeros>(row, w, below_mask(lattice_.nx - 1, w));
      // Crossings round the cells: along x on the four rows, along y on rows 0 and 2, along z on
      // rows 0 and 1.
      std::array<Word, 4> x{};
      for (int r = 0; r < 4; ++r) x[r] = crossings_.along_x(j + (r & 1), k + (r >> 1), w);
      const std::array<Word, 2> y{crossings_.along_y(j, k, w), crossings_.along_y(j, k + 1, w)};
      const std::array<Word, 2> z{crossings_.along_z(j, k, w), crossings_.along_z(j + 1, k, w)};
      for (Word left = c.active; left != 0; left &= left - 1) {
        const int b = __builtin_ctzll(left);
        const std::int64_t i = 64 * w + b;
        const Word below = (Word{1} << b) - 1;
        const auto rank = [&](Index base, Word word) {
          return static_cast<Index>(base + popcount(word & below));
        };
        const auto at = [&](Word word) { return static_cast<Index>((word >> b) & 1u); };
        id[0] = rank(next.x[0], x[0]);
        id[1] = rank(next.y[0], y[0]);
        id[2] = id[1] + at(y[0]);
        id[3] = rank(next.z[0], z[0]);
        id[4] = id[3] + at(z[0]);
        id[7] = rank(next.x[1], x[1]);
        id[8] = rank(next.z[1], z[1]);
        id[9] = id[8] + at(z[1]);
        id[12] = rank(next.x[2], x[2]);
        id[13] = rank(next.y[1], y[1]);
        id[14] = id[13] + at(y[1]);
        id[17] = rank(next.x[3], x[3]);
        const bool zero = Zeros && ((c.with_zero >> b) & 1u) != 0;
        unsigned mask = gather_corners(c.n, c.n_next, b);
        if (zero) {
          mask |= gather_corners(c.z, c.z_next, b) << 8;
          constexpr std::array<int, 4> kZeroSlot{5, 10, 15,
                                                 18};  // at x = i; the one at i + 1 follows
          for (int r = 0; r < 4; ++r) {
            id[kZeroSlot[r]] = rank(next.zero[r], c.used[r]);
            id[kZeroSlot[r] + 1] = id[kZeroSlot[r]] + at(c.used[r]);
          }
        }
        const CellConfig& config = cells_.config_of_mask(mask, i, j, k);
        const Triangulated& t = config.by_triangulation[triangulation];
        for (int n = 0; n < t.centroids; ++n) {
          const std::uint32_t members =
              table.centroids[static_cast<std::size_t>(t.first_centroid + n)];
          put_centroid(next.centroid, members, i, j, k);
          id[kSlots + n] = next.centroid++;
        }
        const std::uint8_t* slot = slots_.data() + t.first;
        for (int n = 0; n < 3 * t.triangles; ++n) out[n] = id[slot[n]];
        out += 3 * t.triangles;
      }
      for (int r = 0; r < 4; ++r) {
        next.x[r] += static_cast<Index>(popcount(x[r]));
        if constexpr (Zeros) next.zero[r] += static_cast<Index>(popcount(c.used[r]));
      }
      for (int r = 0; r < 2; ++r) {
        next.y[r] += static_cast<Index>(popcount(y[r]));
        next.z[r] += static_cast<Index>(popcount(z[r]));
      }
    }
  }

  RunningIds<Index> first_ids(const CellRow& row) const {
    RunningIds<Index> ids;
    for (int r = 0; r < 4; ++r) {
      const RowPlan& p = plan_.rows[static_cast<std::size_t>(row.row[r])];
      const auto first = static_cast<Index>(plan_.first_vertex(row.row[r]));
      ids.x[r] = first;
      if (r % 2 == 0) ids.y[r / 2] = first + static_cast<Index>(p.x);
      if (r < 2) ids.z[r] = first + static_cast<Index>(p.x) + static_cast<Index>(p.y);
      ids.zero[r] =
          first + static_cast<Index>(p.x) + static_cast<Index>(p.y) + static_cast<Index>(p.z);
    }
    ids.centroid = ids.zero[0];
    if ((row.any_flags & kRowZero) != 0) {
      for (std::int64_t w = 0; w < lattice_.words; ++w) {
        ids.centroid += static_cast<Index>(popcount(load(row.n[0] + w) & row.z[0][w]));
      }
    }
    return ids;
  }

  /// Average of surface vertices given as slots, summed in the order of their ids.
  void put_centroid(Index vertex, std::uint32_t members, std::int64_t i, std::int64_t j,
                    std::int64_t k) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (; members != 0; members &= members - 1, ++count) {
      sum += geometry_.surface_vertex(magnitude_, i, j, k, kSlotVertex[__builtin_ctz(members)]);
    }
    sum /= count;
    Real* out = surface_.positions.data() + 3 * static_cast<std::size_t>(vertex);
    for (int d = 0; d < 3; ++d) out[d] = static_cast<Real>(sum[d]);
  }

  /// Triangles of the zero faces of layer k, and their centres when they have one.
  void inserted_faces(std::int64_t k) {
    const LayerPlan& layer = plan_.layers[static_cast<std::size_t>(k)];
    const bool centred = options_.triangulation == Triangulation::centroid;
    const std::int64_t per_quad = centred ? 4 : 2;
    Index* out =
        surface_.indices.data() + 3 * (surface_.first_zero_face + per_quad * layer.first_quad);
    std::int64_t centre = plan_.row_vertices + layer.first_quad;
    for (const InsertedFace& face : layer.quads) {
      const FacePolygon polygon = face_polygon(lattice_, face, k);
      std::array<Index, 4> id{};
      std::uint32_t members = 0;
      for (int n = 0; n < 4; ++n) {
        id[n] = vertex_id(polygon.vertices[n], face.i, face.j, k);
        members |= std::uint32_t{1} << kVertexSlot[polygon.vertices[n]];
      }
      if (centred) {
        put_centroid(static_cast<Index>(centre), members, face.i, face.j, k);
        // In an order that does not depend on the direction of the polygon.
        const bool reversed = id[1] > id[3];
        for (int n = 0; n < 4; ++n) {
          const int a = reversed ? (4 - n) % 4 : n, b = reversed ? 3 - n : (n + 1) % 4;
          const Index low = std::min(id[a], id[b]), high = std::max(id[a], id[b]);
          const bool along = (id[a] < id[b]) != reversed;
          put_triangle(out, low, along ? high : static_cast<Index>(centre),
                       along ? static_cast<Index>(centre) : high);
        }
        ++centre;
      } else {
        // Along the diagonal from the lowest corner; the half with the lower second corner first.
        const bool reversed = id[1] > id[3];
        const int first = reversed ? 2 : 1, second = reversed ? 1 : 2;
        put_triangle(out, id[0], id[first], id[first + 1]);
        put_triangle(out, id[0], id[second], id[second + 1]);
      }
    }
    out = surface_.indices.data() + 3 * (surface_.first_closing + layer.first_closing);
    for (const InsertedFace& face : layer.closing) {
      const FacePolygon polygon = face_polygon(lattice_, face, k);
      std::array<Index, 3> id{};
      for (int n = 0; n < 3; ++n) id[n] = vertex_id(polygon.vertices[n], face.i, face.j, k);
      std::rotate(id.begin(), std::min_element(id.begin(), id.end()), id.end());
      put_triangle(out, id[0], id[1], id[2]);
    }
  }

  void put_triangle(Index*& out, Index a, Index b, Index c) const {
    out[0] = a;
    out[1] = geometry_.mirrored() ? c : b;
    out[2] = geometry_.mirrored() ? b : c;
    out += 3;
  }

  /// Id of a surface vertex (as in CellPatches) of cell (i, j, k).
  Index vertex_id(int vertex, std::int64_t i, std::int64_t j, std::int64_t k) const {
    const auto& low = kCellVertices[vertex >= 12 ? vertex - 12 : Geometry::lower_end(vertex)];
    i += low[0], j += low[1], k += low[2];
    const std::int64_t row = lattice_.row(j, k);
    const RowPlan& p = plan_.rows[static_cast<std::size_t>(row)];
    std::int64_t id = plan_.first_vertex(row);
    const int kind = vertex >= 12 ? 3 : Geometry::edge_axis(vertex);
    if (kind > 0) id += p.x;
    if (kind > 1) id += p.y;
    if (kind > 2) id += p.z;
    for (std::int64_t w = 0; w <= i >> 6; ++w) {
      const Word word = kind == 0   ? crossings_.along_x(j, k, w)
                        : kind == 1 ? crossings_.along_y(j, k, w)
                        : kind == 2 ? crossings_.along_z(j, k, w)
                                    : crossings_.used_zeros(j, k, w);
      id += popcount(word & below_mask(i, w));
    }
    return static_cast<Index>(id);
  }

  const LatticeCells& cells_;
  const SignLattice& lattice_;
  Crossings crossings_;
  const Plan& plan_;
  Geometry geometry_;
  AnyMagnitudeReader magnitude_;
  const Options& options_;
  Surface<Real, Index>& surface_;
  std::vector<std::uint8_t> slots_;
};

}  // namespace

template <class Real, class Index>
bool generate(const VolumeView& view, double isovalue, const Options& options,
              const LatticeCells& cells, const Plan& plan, const LayerLoop& for_layers,
              Surface<Real, Index>& surface) {
  const SignLattice& lattice = cells.lattice();
  Generator<Real, Index> generator(view, isovalue, options, cells, plan, surface);
  const bool capped = options.border == Border::capped;
  const Geometry geometry(view, capped);
  return visit_sample_type(view.type, [&](auto sample) {
    using T = decltype(sample);
    const auto layers = [&](const auto& magnitude) {
      return for_layers(lattice.nz, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t k = first; k < last; ++k) {
          for (std::int64_t j = 0; j < lattice.ny; ++j) {
            generate_row_vertices(lattice, plan, geometry, magnitude, j, k,
                                  surface.positions.data());
          }
        }
        generator.cell_rows(first, last);
      });
    };
    return capped ? layers(MagnitudeReader<T, true>(view, isovalue))
                  : layers(MagnitudeReader<T, false>(view, isovalue));
  });
}

template bool generate(const VolumeView&, double, const Options&, const LatticeCells&, const Plan&,
                       const LayerLoop&, Surface<float, std::int32_t>&);
template bool generate(const VolumeView&, double, const Options&, const LatticeCells&, const Plan&,
                       const LayerLoop&, Surface<float, std::int64_t>&);
template bool generate(const VolumeView&, double, const Options&, const LatticeCells&, const Plan&,
                       const LayerLoop&, Surface<double, std::int32_t>&);
template bool generate(const VolumeView&, double, const Options&, const LatticeCells&, const Plan&,
                       const LayerLoop&, Surface<double, std::int64_t>&);

}  // namespace shape3d::zmc::detail
