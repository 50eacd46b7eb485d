#include "shape3d/zmc/contour.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "geometry.hpp"
#include "pipeline.hpp"
#include "zero_faces.hpp"

namespace shape3d::zmc {
namespace {

using Place = std::array<std::int64_t, 3>;

/// A surface vertex of the volume: kind 0, 1, 2 for a crossing along x, y, z above the lattice
/// point, 3 for the point itself.
using Key = std::uint64_t;

class ContourBuilder {
 public:
  ContourBuilder(const VolumeView& view, double isovalue, int axis, std::int64_t slice,
                 const Options& options)
      : view_(view),
        options_(options),
        axis_(axis),
        magnitude_(view, isovalue, false),
        geometry_(view, false) {
    detail::classify(view, {{isovalue, &lattice_}}, options,
                     detail::layer_loop(options, detail::sample_count(view), 0.0, 1.0));
    const detail::LatticeCells cells(lattice_, magnitude_, options.ties);
    regions_.solve(cells);

    // The layer above the plane, seen through its lower faces; for the last plane the one below.
    const bool last = slice + 1 == view.dims[static_cast<std::size_t>(axis)];
    side_ = last ? 1 : 0;
    Place lower{}, upper{};
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d] = 0;
      upper[d] = view.dims[d] - 1;
    }
    lower[static_cast<std::size_t>(axis)] = slice - side_;
    upper[static_cast<std::size_t>(axis)] = slice - side_ + 1;
    for (std::int64_t k = lower[2]; k < upper[2]; ++k) {
      for (std::int64_t j = lower[1]; j < upper[1]; ++j) {
        for (std::int64_t i = lower[0]; i < upper[0]; ++i) visit_cell(cells, {i, j, k});
      }
    }
  }

  Contour finish() {
    // Sides by their vertices; those that occur an even number of times cancel.
    std::stable_sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
      return std::minmax(a.from, a.to) < std::minmax(b.from, b.to);
    });
    Contour contour;
    std::vector<Eigen::Vector3d> points;
    std::vector<std::array<std::int32_t, 2>> edges;
    std::unordered_map<Key, std::int32_t> ids;
    const auto id = [&](Key key, const Eigen::Vector3d& point) {
      const auto [found, is_new] = ids.try_emplace(key, static_cast<std::int32_t>(points.size()));
      if (is_new) points.push_back(point);
      return found->second;
    };
    for (std::size_t at = 0; at < sides_.size();) {
      std::size_t end = at + 1;
      const auto vertices = std::minmax(sides_[at].from, sides_[at].to);
      while (end < sides_.size() && std::minmax(sides_[end].from, sides_[end].to) == vertices)
        ++end;
      if ((end - at) % 2 == 1) {
        const Side& side = sides_[at];
        edges.push_back({id(side.from, side.from_point), id(side.to, side.to_point)});
      }
      at = end;
    }
    contour.V.resize(static_cast<Eigen::Index>(points.size()), 3);
    contour.E.resize(static_cast<Eigen::Index>(edges.size()), 2);
    for (std::size_t n = 0; n < points.size(); ++n) {
      contour.V.row(static_cast<Eigen::Index>(n)) = points[n].transpose();
    }
    for (std::size_t n = 0; n < edges.size(); ++n) {
      contour.E(static_cast<Eigen::Index>(n), 0) = edges[n][0];
      contour.E(static_cast<Eigen::Index>(n), 1) = edges[n][1];
    }
    return contour;
  }

 private:
  struct Side {
    Key from, to;
    Eigen::Vector3d from_point, to_point;
  };

  void visit_cell(const detail::LatticeCells& cells, const Place& cell) {
    const auto [i, j, k] = cell;
    if (!lattice_.cell_valid(i, j, k)) return;
    const unsigned mask = lattice_.cell_mask(i, j, k);
    detail::CellSigns signs{};
    bool positive = false, negative = false;
    for (int v = 0; v < 8; ++v) {
      const int bit = detail::corner_bit(v);
      signs[v] = ((mask >> (8 + bit)) & 1u) != 0 ? 0 : ((mask >> bit) & 1u) != 0 ? -1 : 1;
      positive |= signs[v] > 0;
      negative |= signs[v] < 0;
    }
    if (positive && negative) {
      std::vector<detail::Comparison> comparisons = detail::required_comparisons(signs);
      const std::array<double, 8> magnitudes = cells.magnitudes(i, j, k);
      std::vector<bool> answers;
      for (const auto& c : comparisons) {
        answers.push_back(detail::positive_prevails(c, magnitudes, options_.ties));
      }
      for (const PatchEdge& edge : detail::apply_rules(signs, comparisons, answers).edges) {
        add_side(cell, edge.from, edge.to);
      }
    }
    const auto& face_case = cells.table().cases[cells.table().case_of_mask[mask]].face_case;
    for (int axis = 0; axis < 3; ++axis) {
      const auto face_number = static_cast<std::size_t>(detail::lower_face(axis));
      const bool closing = face_case[face_number] == 11;
      if (axis == axis_ || cell[static_cast<std::size_t>(axis)] == 0) continue;
      if (!closing && face_case[face_number] != 12) continue;
      const auto face =
          detail::inserted_face(cells, regions_, options_.zero_faces, i, j, k, axis, closing);
      if (!face) continue;
      const detail::FacePolygon polygon = detail::face_polygon(lattice_, *face, k);
      for (int n = 0; n < polygon.size; ++n) {
        add_side(cell, polygon.vertices[n], polygon.vertices[(n + 1) % polygon.size]);
      }
    }
  }

  bool in_plane(int vertex) const {
    if (vertex >= 12) return kCellVertices[vertex - 12][axis_] == side_;
    return kCellVertices[kCellEdges[vertex][0]][axis_] == side_ &&
           kCellVertices[kCellEdges[vertex][1]][axis_] == side_;
  }

  void add_side(const Place& cell, int from, int to) {
    if (!in_plane(from) || !in_plane(to)) return;
    if (side_ == 1) std::swap(from, to);
    sides_.push_back({key(cell, from), key(cell, to), point(cell, from), point(cell, to)});
  }

  Key key(const Place& cell, int vertex) const {
    const auto& low =
        kCellVertices[vertex >= 12 ? vertex - 12 : detail::Geometry::lower_end(vertex)];
    const int kind = vertex >= 12 ? 3 : detail::Geometry::edge_axis(vertex);
    const std::int64_t row = lattice_.row(cell[1] + low[1], cell[2] + low[2]);
    return 4 * static_cast<Key>(row * lattice_.nx + cell[0] + low[0]) + static_cast<Key>(kind);
  }

  Eigen::Vector3d point(const Place& cell, int vertex) const {
    return geometry_.surface_vertex(magnitude_, cell[0], cell[1], cell[2], vertex);
  }

  const VolumeView& view_;
  const Options& options_;
  int axis_;
  int side_ = 0;  ///< The plane is at this end of its layer: 0 lower, 1 upper.
  detail::AnyMagnitudeReader magnitude_;
  detail::Geometry geometry_;
  detail::SignLattice lattice_;
  detail::ZeroRegions regions_;
  std::vector<Side> sides_;
};

}  // namespace

Contour contour(const VolumeView& view, double isovalue, int axis, std::int64_t slice,
                const Options& options) {
  detail::check_arguments(view, isovalue, options);
  if (axis < 0 || axis > 2) {
    throw std::invalid_argument("axis: expected 0, 1 or 2, got " + std::to_string(axis));
  }
  const std::int64_t planes = view.dims[static_cast<std::size_t>(axis)];
  if (slice < 0 || slice >= planes) {
    throw std::invalid_argument("slice: expected 0 to " + std::to_string(planes - 1) + ", got " +
                                std::to_string(slice));
  }
  if (options.border == Border::capped) {
    throw std::invalid_argument("options.border: a contour needs Border::open, got capped");
  }
  Options quiet = options;
  quiet.progress = nullptr;
  return ContourBuilder(view, isovalue, axis, slice, quiet).finish();
}

}  // namespace shape3d::zmc
