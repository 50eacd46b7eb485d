#include "generate.hpp"

#include <algorithm>

#include "crossings.hpp"
#include "geometry.hpp"
#include "triangles.hpp"
#include "vertices.hpp"

namespace shape3d::zmc::detail {
namespace {

template <class Real, class Index>
VertexArrays<Real> arrays_of(Surface<Real, Index>& surface) {
  const auto array = [](detail::Buffer<Real>& buffer) {
    return buffer.empty() ? nullptr : buffer.data();
  };
  return {array(surface.positions), array(surface.gradients), array(surface.normals),
          surface.edges.empty() ? nullptr : surface.edges.data(), array(surface.edge_parameters)};
}

template <class Real, class Index>
class Generator final : public CentroidSink {
 public:
  Generator(const VolumeView& view, double isovalue, const Options& options,
            const Geometry& geometry, const LatticeCells& cells, const Plan& plan,
            Surface<Real, Index>& surface)
      : cells_(cells),
        lattice_(cells.lattice()),
        crossings_(cells.lattice()),
        plan_(plan),
        geometry_(geometry),
        magnitude_(view, isovalue, options.border == Border::capped),
        options_(options),
        surface_(surface),
        tables_(triangle_tables(options.triangulation, geometry_.mirrored())),
        arrays_(arrays_of(surface)),
        attributes_(view, options) {}

  /// Triangles and centroids of layers [first, last).
  void layers(std::int64_t first, std::int64_t last) const {
    Index* const triangles = surface_.indices.data();
    const Index* const end =
        triangles + 3 * (last < plan_.part.last
                             ? plan_.first_triangle(lattice_.row(0, last)) - plan_.part_triangle
                             : plan_.patch_triangles);
    for (std::int64_t k = first; k < last && k + 1 < lattice_.nz; ++k) {
      for (std::int64_t j = 0; j + 1 < lattice_.ny; ++j) {
        generate_cell_row(cells_, plan_, tables_, *this, j, k, triangles, end);
      }
      inserted_faces(k);
    }
  }

  /// Sums in the order of the vertices' ids.
  void put(std::int64_t id, std::uint32_t members, std::int64_t i, std::int64_t j,
           std::int64_t k) const override {
    const std::int64_t place_in_part = id - plan_.first_id;
    Eigen::Vector3d place = Eigen::Vector3d::Zero(), gradient = place, normal = place;
    int count = 0;
    for (; members != 0; members &= members - 1, ++count) {
      const int vertex = kSlotVertex[__builtin_ctz(members)];
      place += geometry_.surface_vertex(magnitude_, i, j, k, vertex);
      if (!arrays_.with_attributes()) continue;
      const VertexAttributes a = attributes_.at_surface_vertex(magnitude_, i, j, k, vertex);
      gradient += a.gradient;
      normal += a.normal;
    }
    for (int d = 0; d < 3; ++d) {
      arrays_.positions[3 * place_in_part + d] = static_cast<Real>(place[d] / count);
    }
    if (arrays_.edges != nullptr) {
      arrays_.edges[place_in_part] = -1;
      arrays_.edge_parameters[place_in_part] = Real{0};
    }
    if (arrays_.with_attributes()) {
      const double length = normal.norm();
      if (length > 0.0) normal /= length;
      arrays_.put(place_in_part, {gradient / count, normal});
    }
  }

 private:
  /// Triangles of the zero faces of layer k, and their centres when they have one.
  void inserted_faces(std::int64_t k) const {
    const LayerPlan& layer = plan_.layers[static_cast<std::size_t>(k)];
    const bool centred = options_.triangulation == Triangulation::centroid;
    const std::int64_t per_quad = centred ? 4 : 2;
    Index* out =
        surface_.indices.data() + 3 * (surface_.first_zero_face + per_quad * layer.first_quad);
    for (std::size_t q = 0; q < layer.quads.size(); ++q) {
      const InsertedFace& face = layer.quads[q];
      const FacePolygon polygon = face_polygon(lattice_, face, k);
      std::array<Index, 4> id{};
      std::uint32_t members = 0;
      for (int n = 0; n < 4; ++n) {
        id[n] = vertex_id(polygon.vertices[n], face.i, face.j, k);
        members |= std::uint32_t{1} << kVertexSlot[polygon.vertices[n]];
      }
      if (centred) {
        const auto centre = static_cast<Index>(centre_id(layer, q, k));
        put(static_cast<std::int64_t>(centre), members, face.i, face.j, k);
        // In an order that does not depend on the direction of the polygon.
        const bool reversed = id[1] > id[3];
        for (int n = 0; n < 4; ++n) {
          const int a = reversed ? (4 - n) % 4 : n, b = reversed ? 3 - n : (n + 1) % 4;
          const Index low = std::min(id[a], id[b]), high = std::max(id[a], id[b]);
          const bool along = (id[a] < id[b]) != reversed;
          put_triangle(out, low, along ? high : centre, along ? centre : high);
        }
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

  /// Id of the centre of a layer's quad: they end the vertices of the row of their cell.
  std::int64_t centre_id(const LayerPlan& layer, std::size_t quad, std::int64_t k) const {
    const std::int32_t j = layer.quads[quad].j;
    std::size_t end = quad;
    while (end < layer.quads.size() && layer.quads[end].j == j) ++end;
    const std::int64_t next_row = lattice_.row(j, k) + 1;  // there is one: cells end before rows do
    return plan_.first_row_id(next_row) - static_cast<std::int64_t>(end - quad);
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
    std::int64_t id = plan_.first_row_id(row);
    const int kind = vertex >= 12 ? 3 : Geometry::edge_axis(vertex);
    if (kind > 0) id += p.x;
    if (kind > 1) id += p.y;
    if (kind > 2) id += p.z;
    for (std::int64_t w = 0; w <= i >> 6; ++w) {
      const Word word = kind == 0   ? crossings_.along_x(j, k, w)
                        : kind == 1 ? crossings_.along_y(j, k, w)
                        : kind == 2 ? crossings_.along_z(j, k, w)
                                    : crossings_.used_zeros(j, k, w);
      id += __builtin_popcountll(word & below_mask(i, w));
    }
    return static_cast<Index>(id);
  }

  const LatticeCells& cells_;
  const SignLattice& lattice_;
  Crossings crossings_;
  const Plan& plan_;
  const Geometry& geometry_;
  AnyMagnitudeReader magnitude_;
  const Options& options_;
  Surface<Real, Index>& surface_;
  const TriangleTables& tables_;
  VertexArrays<Real> arrays_;
  AttributeSampler attributes_;
};

}  // namespace

template <class Real, class Index>
bool generate(const VolumeView& view, double isovalue, const Options& options,
              const Geometry& geometry, const LatticeCells& cells, const Plan& plan,
              const LayerLoop& for_layers, Surface<Real, Index>& surface) {
  const SignLattice& lattice = cells.lattice();
  Generator<Real, Index> generator(view, isovalue, options, geometry, cells, plan, surface);
  const Plan::Part part = plan.part;
  return for_layers(part.last - part.first, [&](std::int64_t first, std::int64_t last) {
    VertexWriter<Real> vertices(view, isovalue, options, geometry, lattice, plan,
                                arrays_of(surface));
    for (std::int64_t k = part.first + first; k < part.first + last; ++k) {
      for (std::int64_t j = 0; j < lattice.ny; ++j) vertices.write_row(j, k);
    }
    generator.layers(part.first + first, part.first + last);
  });
}

template bool generate(const VolumeView&, double, const Options&, const Geometry&,
                       const LatticeCells&, const Plan&, const LayerLoop&,
                       Surface<float, std::int32_t>&);
template bool generate(const VolumeView&, double, const Options&, const Geometry&,
                       const LatticeCells&, const Plan&, const LayerLoop&,
                       Surface<float, std::int64_t>&);
template bool generate(const VolumeView&, double, const Options&, const Geometry&,
                       const LatticeCells&, const Plan&, const LayerLoop&,
                       Surface<double, std::int32_t>&);
template bool generate(const VolumeView&, double, const Options&, const Geometry&,
                       const LatticeCells&, const Plan&, const LayerLoop&,
                       Surface<double, std::int64_t>&);

}  // namespace shape3d::zmc::detail
