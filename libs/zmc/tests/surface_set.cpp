#include "surface_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace shape3d::zmc::test {
namespace {

using Lattice = std::array<std::int64_t, 3>;
using Row = std::array<std::int64_t, 3>;

[[noreturn]] void fail(const std::string& what, const Row& triangle) {
  std::ostringstream out;
  out << what << ": triangle " << triangle[0] << ' ' << triangle[1] << ' ' << triangle[2];
  throw std::runtime_error(out.str());
}

class Converter {
 public:
  Converter(const Points& V, const Triangles& F, const std::vector<TriangleKind>& kinds,
            const reference::Volume& volume, int outside)
      : V_(V), F_(F), kinds_(kinds), volume_(volume), outside_(outside) {}

  Conversion run() {
    name_vertices();
    std::map<std::int64_t, std::vector<Row>> cells, faces;
    for (std::int64_t t = 0; t < F_.rows(); ++t) {
      const Row row{F_(t, 0), F_(t, 1), F_(t, 2)};
      switch (kinds_[t]) {
        case TriangleKind::patch: {
          const std::int64_t cell = cell_of(row);
          cells[cell].push_back(row);
          result_.triangle_cells.push_back(cell);
          break;
        }
        case TriangleKind::zero_face:
          faces[face_of(row)].push_back(row);
          break;
        case TriangleKind::closing:
          for (const std::int64_t v : row) {
            if (is_centroid_[v]) fail("a closing triangle with a centroid", row);
          }
          result_.surface.closing.push_back(named({row.begin(), row.end()}));
          break;
      }
    }
    for (const auto& [cell, rows] : cells) {
      for (auto& polygon : polygons(rows)) {
        result_.surface.patches.push_back({cell, std::move(polygon)});
      }
    }
    for (const auto& [face, rows] : faces) {
      for (auto& polygon : polygons(rows)) {
        if (polygon.size() != 4) fail("a zero face that is no quad", rows[0]);
        result_.surface.zero_faces.push_back(std::move(polygon));
      }
    }
    std::sort(result_.surface.patches.begin(), result_.surface.patches.end());
    std::sort(result_.surface.zero_faces.begin(), result_.surface.zero_faces.end());
    std::sort(result_.surface.closing.begin(), result_.surface.closing.end());
    return std::move(result_);
  }

 private:
  static bool whole(double x) { return x == std::floor(x); }

  void name_vertices() {
    for (std::int64_t v = 0; v < V_.rows(); ++v) {
      std::int64_t fractions = 0;
      Lattice low{}, high{};
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = static_cast<std::int64_t>(std::floor(V_(v, axis))) + outside_;
        high[axis] = low[axis] + (whole(V_(v, axis)) ? 0 : 1);
        fractions += high[axis] - low[axis];
        if (low[axis] < 0 || high[axis] >= volume_.dims[axis]) {
          throw std::runtime_error("vertex " + std::to_string(v) + " lies outside the volume");
        }
      }
      low_.push_back(low);
      high_.push_back(high);
      is_centroid_.push_back(fractions > 1);
      names_.push_back(
          {volume_.index(low[0], low[1], low[2]), volume_.index(high[0], high[1], high[2])});
      result_.centroids += fractions > 1;
      result_.zero_vertices += fractions == 0;
      if (fractions > 1) continue;
      const std::array<double, 3> place = position(volume_, names_.back());
      for (int axis = 0; axis < 3; ++axis) {
        result_.position_error =
            std::max(result_.position_error, std::abs(place[axis] - outside_ - V_(v, axis)));
      }
    }
  }

  reference::Cycle named(const std::vector<std::int64_t>& ids) const {
    reference::Cycle cycle;
    for (const std::int64_t v : ids) cycle.push_back(names_[v]);
    return reference::canonical(std::move(cycle));
  }

  /// First sample of the one cell that contains the three vertices.
  std::int64_t cell_of(const Row& row) const {
    Lattice cell{};
    for (int axis = 0; axis < 3; ++axis) {
      std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
      std::int64_t highest = std::numeric_limits<std::int64_t>::max();
      for (const std::int64_t v : row) {
        lowest = std::max(lowest, high_[v][axis] - 1);
        highest = std::min(highest, low_[v][axis]);
      }
      if (lowest < highest) fail("a patch triangle in a cell face", row);
      if (lowest > highest) fail("a patch triangle over more than one cell", row);
      cell[axis] = lowest;
    }
    return volume_.index(cell[0], cell[1], cell[2]);
  }

  /// A number for the lattice face that contains the three vertices.
  std::int64_t face_of(const Row& row) const {
    Lattice low = low_[row[0]], high = high_[row[0]];
    for (const std::int64_t v : row) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], low_[v][axis]);
        high[axis] = std::max(high[axis], high_[v][axis]);
      }
    }
    int normal = -1, extent = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (high[axis] == low[axis]) normal = axis;
      if (high[axis] - low[axis] > 1) fail("a zero-face triangle over more than one face", row);
      extent += static_cast<int>(high[axis] - low[axis]);
    }
    if (extent != 2) fail("a zero-face triangle not in a face", row);
    return 3 * volume_.index(low[0], low[1], low[2]) + normal;
  }

  std::vector<reference::Cycle> polygons(const std::vector<Row>& rows) {
    std::map<std::pair<std::int64_t, std::int64_t>, int> sides;
    for (const Row& row : rows) {
      for (int k = 0; k < 3; ++k) {
        const std::pair side{row[k], row[(k + 1) % 3]};
        const std::pair back{side.second, side.first};
        const auto opposite = sides.find(back);
        if (opposite == sides.end()) {
          if (++sides[side] > 1) fail("a side that two triangles run the same way", row);
        } else {
          sides.erase(opposite);
        }
      }
    }
    std::map<std::int64_t, std::int64_t> next;
    for (const auto& [side, count] : sides) {
      if (is_centroid_[side.first]) fail("a centroid on a boundary", rows[0]);
      if (!next.emplace(side.first, side.second).second) {
        fail("two sides leave one vertex in one cell", rows[0]);
      }
    }
    std::vector<reference::Cycle> result;
    while (!next.empty()) {
      std::vector<std::int64_t> ids;
      for (auto at = next.begin(); at != next.end(); at = next.find(ids.back())) {
        ids.push_back(at->second);
        next.erase(at);
      }
      check_disk(rows, ids);
      result.push_back(named(ids));
    }
    return result;
  }

  /// Are the triangles on these vertices a fan of diagonals, or one round a centroid at their
  /// average?
  void check_disk(const std::vector<Row>& rows, const std::vector<std::int64_t>& polygon) {
    const std::set<std::int64_t> own(polygon.begin(), polygon.end());
    std::set<std::int64_t> centres;
    std::size_t triangles = 0;
    for (const Row& row : rows) {
      const auto inside =
          std::count_if(row.begin(), row.end(), [&](std::int64_t v) { return own.count(v) != 0; });
      if (inside == 0) continue;
      ++triangles;
      for (const std::int64_t v : row) {
        if (own.count(v) != 0) continue;
        if (!is_centroid_[v]) fail("a triangle joins two polygons", row);
        centres.insert(v);
      }
      if (inside == 3 && !centres.empty()) fail("a triangle beside a centroid", row);
    }
    if (centres.size() > 1) fail("a polygon with two centroids", rows[0]);
    const std::size_t expected = centres.empty() ? polygon.size() - 2 : polygon.size();
    if (triangles != expected) fail("a polygon of a wrong number of triangles", rows[0]);
    if (centres.empty()) return;
    Eigen::RowVector3d average = Eigen::RowVector3d::Zero();
    for (const std::int64_t v : polygon) average += V_.row(v);
    average /= static_cast<double>(polygon.size());
    result_.position_error = std::max(result_.position_error,
                                      (average - V_.row(*centres.begin())).cwiseAbs().maxCoeff());
  }

  const Points& V_;
  const Triangles& F_;
  const std::vector<TriangleKind>& kinds_;
  const reference::Volume& volume_;
  int outside_;
  std::vector<Lattice> low_, high_;  ///< Lattice box of each vertex.
  std::vector<char> is_centroid_;
  std::vector<reference::Vertex> names_;
  Conversion result_;
};

}  // namespace

reference::Vertex vertex_at(const Eigen::Vector3d& place, const reference::Volume& volume) {
  Lattice low{}, high{};
  std::int64_t fractions = 0;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = static_cast<std::int64_t>(std::floor(place[axis]));
    high[axis] = static_cast<std::int64_t>(std::ceil(place[axis]));
    fractions += high[axis] - low[axis];
    if (low[axis] < 0 || high[axis] >= volume.dims[axis]) fractions = 3;
  }
  if (fractions > 1) throw std::runtime_error("a vertex that is not on a lattice edge");
  return {volume.index(low[0], low[1], low[2]), volume.index(high[0], high[1], high[2])};
}

shape3d::test::Exempt at_border_or_mask(const reference::Volume& volume) {
  return [&volume](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    Lattice first{}, last{};
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = static_cast<std::int64_t>(std::ceil(std::max(p[axis], q[axis]))) - 1;
      last[axis] = static_cast<std::int64_t>(std::floor(std::min(p[axis], q[axis])));
      if (first[axis] < 0 || last[axis] > volume.dims[axis] - 2) return true;
    }
    // All cells round the edge lie in the volume: their samples must be finite.
    for (std::int64_t k = first[2]; k <= last[2] + 1; ++k) {
      for (std::int64_t j = first[1]; j <= last[1] + 1; ++j) {
        for (std::int64_t i = first[0]; i <= last[0] + 1; ++i) {
          if (!std::isfinite(volume.at(i, j, k))) return true;
        }
      }
    }
    return false;
  };
}

Conversion convert(const Points& V, const Triangles& F, const std::vector<TriangleKind>& kinds,
                   const reference::Volume& volume, int outside) {
  return Converter(V, F, kinds, volume, outside).run();
}

}  // namespace shape3d::zmc::test
