#include "shape3d/mapping/inspect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include "disjoint_sets.hpp"
#include "edge_list.hpp"
#include "findings.hpp"

namespace shape3d::mapping {
namespace {

using detail::DisjointSets;
using detail::EdgeUse;
using detail::Examples;

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Fills an Inspection step by step.
class Inspector {
 public:
  Inspector(const ConstPoints& V, const ConstTriangles& F)
      : V_(V), F_(F), use_(index(F.rows()), true) {
    result_.vertices = V.rows();
    result_.triangles = F.rows();
  }

  Inspection finish(const InspectOptions& options) {
    check_vertices();
    check_triangles();
    check_edges();
    measure();
    if (options.self_intersections && result_.out_of_range_triangles == 0 &&
        result_.not_finite_vertices == 0) {
      result_.self_intersections = count_self_intersections(V_, F_);
    }
    detail::add_findings(result_, examples_);
    return std::move(result_);
  }

 private:
  void check_vertices() {
    for (Eigen::Index v = 0; v < V_.rows(); ++v) {
      if (V_.row(v).allFinite()) continue;
      if (result_.not_finite_vertices++ == 0) examples_.not_finite_vertex = v;
    }
  }

  // Takes out triangles with bad or repeated indices, and repetitions of earlier triangles.
  void check_triangles() {
    struct Key {
      std::array<std::int32_t, 3> ids;
      std::int32_t triangle;
    };
    std::vector<Key> keys;
    keys.reserve(index(F_.rows()));
    for (Eigen::Index t = 0; t < F_.rows(); ++t) {
      std::array<std::int32_t, 3> ids{F_(t, 0), F_(t, 1), F_(t, 2)};
      std::sort(ids.begin(), ids.end());
      if (ids[0] < 0 || ids[2] >= V_.rows()) {
        if (result_.out_of_range_triangles++ == 0) examples_.out_of_range_triangle = t;
        use_[index(t)] = false;
      } else if (ids[0] == ids[1] || ids[1] == ids[2]) {
        if (result_.degenerate_triangles++ == 0) examples_.degenerate_triangle = t;
        use_[index(t)] = false;
      } else {
        keys.push_back({ids, static_cast<std::int32_t>(t)});
      }
    }
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
      return a.ids != b.ids ? a.ids < b.ids : a.triangle < b.triangle;
    });
    for (std::size_t k = 1; k < keys.size(); ++k) {
      if (keys[k].ids != keys[k - 1].ids) continue;
      const std::int32_t t = keys[k].triangle;
      if (result_.duplicate_triangles++ == 0 || t < examples_.duplicate_triangle)
        examples_.duplicate_triangle = t;
      use_[index(t)] = false;
    }
  }

  void check_edges() {
    const std::vector<EdgeUse> uses = detail::edge_list(F_, use_, V_.rows());
    const std::size_t corners = 3 * use_.size();
    DisjointSets pieces(index(V_.rows())), fans(corners), sides(use_.size());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> boundary;  // corners at its two ends
    const auto corner = [](const EdgeUse& use, bool low) {
      const int at = use.forward == low ? use.side : (use.side + 1) % 3;
      return static_cast<std::uint32_t>(3 * use.triangle + at);
    };
    detail::for_each_edge(uses, [&](const EdgeUse* begin, const EdgeUse* end) {
      ++result_.edges;
      pieces.join(static_cast<std::uint32_t>(begin->low), static_cast<std::uint32_t>(begin->high));
      if (end - begin == 1) {
        if (result_.boundary_edges++ == 0) examples_.boundary_edge = {begin->low, begin->high};
        boundary.emplace_back(corner(*begin, true), corner(*begin, false));
      }
      if (end - begin > 2 && result_.nonmanifold_edges++ == 0)
        examples_.nonmanifold_edge = {begin->low, begin->high};
      if (end - begin == 2) {
        const bool same = begin[0].forward == begin[1].forward;
        if (same && result_.misoriented_edges++ == 0)
          examples_.misoriented_edge = {begin->low, begin->high};
        const bool fits = sides.join(static_cast<std::uint32_t>(begin[0].triangle),
                                     static_cast<std::uint32_t>(begin[1].triangle), same);
        result_.orientable = result_.orientable && fits;
      }
      for (const EdgeUse* use = begin + 1; use < end; ++use) {
        fans.join(corner(*begin, true), corner(*use, true));
        fans.join(corner(*begin, false), corner(*use, false));
      }
    });
    count_fans(fans);
    count_loops(fans, boundary);
    count_pieces(pieces);
  }

  // A vertex whose corners fall into more than one fan is not manifold; one without is isolated.
  void count_fans(DisjointSets& fans) {
    std::vector<std::int32_t> count(index(V_.rows()), 0);
    for (std::size_t t = 0; t < use_.size(); ++t) {
      if (!use_[t]) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto id = static_cast<std::uint32_t>(3 * t + i);
        if (fans.root(id) == id)
          ++count[index(F_(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(i)))];
      }
    }
    std::vector<bool> named(index(V_.rows()), false);
    for (Eigen::Index t = 0; t < F_.rows(); ++t) {
      for (Eigen::Index i = 0; i < 3; ++i)
        if (F_(t, i) >= 0 && F_(t, i) < V_.rows()) named[index(F_(t, i))] = true;
    }
    for (std::size_t v = 0; v < count.size(); ++v) {
      if (count[v] > 1 && result_.nonmanifold_vertices++ == 0)
        examples_.nonmanifold_vertex = static_cast<std::int64_t>(v);
      if (!named[v] && result_.isolated_vertices++ == 0)
        examples_.isolated_vertex = static_cast<std::int64_t>(v);
      used_ += count[v] > 0 ? 1 : 0;
    }
  }

  // Boundary edges that follow each other round a fan are one loop.
  void count_loops(DisjointSets& fans,
                   const std::vector<std::pair<std::uint32_t, std::uint32_t>>& boundary) {
    DisjointSets loops(3 * use_.size());
    for (const auto& [a, b] : boundary) loops.join(fans.root(a), fans.root(b));
    std::vector<std::uint32_t> roots;
    for (const auto& [a, b] : boundary) roots.push_back(loops.root(fans.root(a)));
    std::sort(roots.begin(), roots.end());
    result_.boundary_loops = std::unique(roots.begin(), roots.end()) - roots.begin();
  }

  void count_pieces(DisjointSets& pieces) {
    std::vector<std::int64_t> triangles(index(V_.rows()), 0);
    for (Eigen::Index t = 0; t < F_.rows(); ++t) {
      if (use_[index(t)]) ++triangles[pieces.root(static_cast<std::uint32_t>(F_(t, 0)))];
    }
    std::int64_t kept = 0;
    for (const std::int64_t count : triangles) {
      result_.components += count > 0 ? 1 : 0;
      result_.largest_component = std::max(result_.largest_component, count);
      kept += count;
    }
    result_.euler = used_ - result_.edges + kept;
    if (result_.components > 0 && result_.orientable && result_.nonmanifold_edges == 0 &&
        result_.nonmanifold_vertices == 0) {
      result_.genus = (2 * result_.components - result_.boundary_loops - result_.euler) / 2;
    }
  }

  void measure() {
    if (result_.not_finite_vertices > 0) return;
    // Relative to a vertex of the surface, in units of its extent, so that nothing overflows.
    Eigen::RowVector3d lower = Eigen::RowVector3d::Constant(std::numeric_limits<double>::max());
    Eigen::RowVector3d upper = -lower;
    for_each_triangle([&](Eigen::Index t) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        lower = lower.cwiseMin(V_.row(F_(t, i)));
        upper = upper.cwiseMax(V_.row(F_(t, i)));
      }
    });
    const Eigen::RowVector3d centre = 0.5 * lower + 0.5 * upper;
    const double extent = (0.5 * upper - 0.5 * lower).maxCoeff();
    const double unit =
        extent > 0 && std::isfinite(extent) ? std::ldexp(1.0, std::ilogb(extent)) : 1;
    double area = 0.0, volume = 0.0;
    for_each_triangle([&](Eigen::Index t) {
      std::array<Eigen::Vector3d, 3> p;
      for (Eigen::Index i = 0; i < 3; ++i)
        p[index(i)] = ((V_.row(F_(t, i)) - centre) / unit).transpose();
      const Eigen::Vector3d cross = (p[1] - p[0]).cross(p[2] - p[0]);
      const double longest = std::max(
          {(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
      constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
      if (cross.norm() <= kRounding * longest && result_.zero_area_triangles++ == 0)
        examples_.zero_area_triangle = t;
      area += 0.5 * cross.norm();
      volume += p[0].dot(p[1].cross(p[2])) / 6.0;
    });
    result_.area = area * unit * unit;
    if (result_.closed() && result_.misoriented_edges == 0 && result_.nonmanifold_edges == 0)
      result_.volume = volume * unit * unit * unit;
    examples_.positive_volume = volume > 0.0;
    examples_.positive_area = area > 0.0;
  }

  template <class Visit>
  void for_each_triangle(const Visit& visit) const {
    for (Eigen::Index t = 0; t < F_.rows(); ++t)
      if (use_[index(t)]) visit(t);
  }

  const ConstPoints& V_;
  const ConstTriangles& F_;
  std::vector<bool> use_;  ///< Triangles that take part in the counts of edges and fans.
  std::int64_t used_ = 0;  ///< Vertices of such triangles.
  Inspection result_;
  Examples examples_;
};

}  // namespace

bool Inspection::spherical() const {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& finding) { return finding.blocking; });
}

std::string Inspection::why_not_spherical(std::string_view repair, std::string_view wrap) const {
  std::string text;
  for (const Finding& finding : findings) {
    if (!finding.blocking) continue;
    if (!text.empty()) text += "; ";
    text += to_sentence(finding, repair, wrap);
  }
  return text;
}

Inspection inspect(const ConstPoints& V, const ConstTriangles& F, const InspectOptions& options) {
  return Inspector(V, F).finish(options);
}

}  // namespace shape3d::mapping
