#include "mesh_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace shape3d::apps {
namespace {

// Disjoint sets; the root is the smallest member.
template <class Index>
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  Index find(Index a) {
    while (at(a) != a) {
      at(a) = at(at(a));
      a = at(a);
    }
    return a;
  }
  void unite(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a < b) {
      at(b) = a;
    } else {
      at(a) = b;
    }
  }

 private:
  Index& at(Index i) { return parent_[static_cast<std::size_t>(i)]; }
  std::vector<Index> parent_;
};

// Disjoint sets of triangles with the turn of each against its root; tells whether all demands
// agree.
template <class Index>
class TurnSets {
 public:
  explicit TurnSets(std::size_t size) : parent_(size), turned_(size, 0) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  // Demands that a and b are turned differently (or alike); false when that contradicts earlier
  // demands.
  bool demand(Index a, Index b, bool different) {
    const auto [root_a, turn_a] = find(a);
    const auto [root_b, turn_b] = find(b);
    const bool turn = (turn_a != turn_b) != different;
    if (root_a == root_b) return !turn;
    parent_[static_cast<std::size_t>(std::max(root_a, root_b))] = std::min(root_a, root_b);
    turned_[static_cast<std::size_t>(std::max(root_a, root_b))] = turn ? 1 : 0;
    return true;
  }

 private:
  std::pair<Index, bool> find(Index a) {
    Index root = a;
    bool turn = false;
    while (parent_[static_cast<std::size_t>(root)] != root) {
      turn ^= turned_[static_cast<std::size_t>(root)] != 0;
      root = parent_[static_cast<std::size_t>(root)];
    }
    bool rest = turn;
    while (parent_[static_cast<std::size_t>(a)] != root && a != root) {  // shorten the path
      const auto i = static_cast<std::size_t>(a);
      const Index next = parent_[i];
      const bool step = turned_[i] != 0;
      parent_[i] = root;
      turned_[i] = rest ? 1 : 0;
      rest ^= step;
      a = next;
    }
    return {root, turn};
  }
  std::vector<Index> parent_;
  std::vector<std::uint8_t> turned_;
};

// Which vertices are in which of the six border planes of a volume: bits 0–5.
class BorderPlanes {
 public:
  explicit BorderPlanes(const zmc::VolumeView& volume)
      : to_lattice_((volume.direction * volume.spacing.asDiagonal()).inverse()),
        origin_(volume.origin) {
    // A world coordinate p = o + d·s·i is rounded by a few ε times the largest magnitude involved.
    double extent = volume.origin.cwiseAbs().maxCoeff();
    for (int c = 0; c < 3; ++c) {
      last_[c] = static_cast<double>(volume.dims[static_cast<std::size_t>(c)] - 1);
      extent = std::max(extent, last_[c] * volume.spacing[c]);
    }
    const double rounding =
        16.0 * std::numeric_limits<double>::epsilon() * extent / volume.spacing.minCoeff();
    tolerance_ = std::max(std::ldexp(1.0, -26), rounding);
  }
  [[nodiscard]] unsigned planes_of(const double* position) const {
    const Eigen::Vector3d lattice =
        to_lattice_ * (Eigen::Vector3d(position[0], position[1], position[2]) - origin_);
    unsigned planes = 0;
    for (int c = 0; c < 3; ++c) {
      if (std::abs(lattice[c]) <= tolerance_) planes |= 1U << (2 * c);
      if (std::abs(lattice[c] - last_[c]) <= tolerance_) planes |= 2U << (2 * c);
    }
    return planes;
  }

 private:
  Eigen::Matrix3d to_lattice_;
  Eigen::Vector3d origin_, last_;
  double tolerance_;
};

// What is known at a vertex about its component.
enum VertexFlag : std::uint8_t { kNonmanifold = 1, kNotOrientable = 2 };

template <class Index>
class Checker {
 public:
  Checker(const MeshView& mesh, const Index* ids, const MeshCheckOptions& options)
      : mesh_(mesh),
        ids_(ids),
        n_(static_cast<std::size_t>(mesh.vertex_count)),
        m_(static_cast<std::size_t>(mesh.triangle_count)),
        sets_(n_),
        edge_count_(n_, 0),
        flags_(n_, 0),
        options_(options) {}

  MeshCheck run() {
    result_.vertices = mesh_.vertex_count;
    result_.triangles = mesh_.triangle_count;
    bin_halfedges();
    {
      DisjointSets<Index> corners(3 *
                                  m_);  // corners joined across edges of two triangles: the fans
      visit_edges(corners);
      count_fans(corners);
    }
    if (result_.inconsistent_edges > 0) mark_not_orientable();
    halfedges_ = {};
    summarise_components();
    count_duplicates();
    measure();
    return std::move(result_);
  }

 private:
  // Edge {lo, hi} of halfedge h = 3t + c, which runs from corner c of triangle t to corner c + 1;
  // it is stored in the bin of lo.
  struct HalfEdge {
    Index hi, h;
  };

  [[nodiscard]] Index id(std::size_t corner) const { return ids_[corner]; }
  static std::size_t next(std::size_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  [[nodiscard]] bool degenerate(std::size_t t) const {
    const Index* f = ids_ + 3 * t;
    return f[0] == f[1] || f[1] == f[2] || f[2] == f[0];
  }

  void bin_halfedges() {
    bins_.assign(n_ + 1, 0);
    for (std::size_t t = 0; t < m_; ++t) {
      if (degenerate(t)) {
        ++result_.degenerate_triangles;
        continue;
      }
      for (std::size_t h = 3 * t; h < 3 * t + 3; ++h)
        ++bins_[static_cast<std::size_t>(std::min(id(h), id(next(h)))) + 1];
    }
    std::partial_sum(bins_.begin(), bins_.end(), bins_.begin());
    halfedges_.resize(bins_[n_]);
    // bins_[v] moves from the start of bin v to its end while it is filled, and back afterwards.
    for (std::size_t t = 0; t < m_; ++t) {
      if (degenerate(t)) continue;
      for (std::size_t h = 3 * t; h < 3 * t + 3; ++h) {
        const auto [lo, hi] = std::minmax({id(h), id(next(h))});
        halfedges_[bins_[static_cast<std::size_t>(lo)]++] = {hi, static_cast<Index>(h)};
      }
    }
    for (std::size_t v = n_; v > 0; --v) bins_[v] = bins_[v - 1];
    bins_[0] = 0;
  }

  // Calls visit(lo, first, last) with the halfedges of each edge; they have been sorted by hi
  // before.
  template <class Visitor>
  void for_each_edge(Visitor&& visit) {
    for (std::size_t lo = 0; lo < n_; ++lo) {
      HalfEdge* const end = halfedges_.data() + bins_[lo + 1];
      for (HalfEdge* first = halfedges_.data() + bins_[lo]; first != end;) {
        HalfEdge* last = first + 1;
        while (last != end && last->hi == first->hi) ++last;
        visit(static_cast<Index>(lo), first, last);
        first = last;
      }
    }
  }

  void visit_edges(DisjointSets<Index>& corners) {
    for (std::size_t lo = 0; lo < n_; ++lo) {
      std::sort(halfedges_.begin() + static_cast<std::ptrdiff_t>(bins_[lo]),
                halfedges_.begin() + static_cast<std::ptrdiff_t>(bins_[lo + 1]),
                [](const HalfEdge& a, const HalfEdge& b) {
                  return a.hi != b.hi ? a.hi < b.hi : a.h < b.h;
                });
    }
    std::optional<BorderPlanes> border;
    if (options_.volume != nullptr) {
      border.emplace(*options_.volume);
      result_.odd_interior_edges = 0;
    }
    bool balanced = true;
    for_each_edge([&](Index lo, const HalfEdge* first, const HalfEdge* last) {
      const Index hi = first->hi;
      const std::ptrdiff_t count = last - first;
      ++result_.edges;
      ++edge_count_[static_cast<std::size_t>(lo)];
      sets_.unite(lo, hi);
      std::ptrdiff_t forward = 0;  // triangles that run from lo to hi
      for (const HalfEdge* e = first; e != last; ++e)
        forward += id(static_cast<std::size_t>(e->h)) == lo;
      balanced = balanced && 2 * forward == count;
      if (count % 2 == 1) {
        ++result_.odd_edges;
        if (border && (border->planes_of(position(lo)) & border->planes_of(position(hi))) == 0) {
          ++*result_.odd_interior_edges;
        }
      }
      if (count == 1) {
        ++result_.boundary_edges;
        boundary_at_.push_back(lo);
      } else if (count == 2) {
        const auto h = static_cast<std::size_t>(first[0].h),
                   g = static_cast<std::size_t>(first[1].h);
        const bool opposite = forward == 1;
        if (!opposite) ++result_.inconsistent_edges;
        // Corners at the same vertex: the starts are joined crosswise when the directions are
        // opposite.
        corners.unite(static_cast<Index>(h), static_cast<Index>(opposite ? next(g) : g));
        corners.unite(static_cast<Index>(next(h)), static_cast<Index>(opposite ? g : next(g)));
      } else {
        ++result_.nonmanifold_edges;
        flags_[static_cast<std::size_t>(lo)] |= kNonmanifold;
      }
    });
    result_.oriented = balanced && result_.edges > 0;
    result_.closed = result_.edges > 0 && result_.odd_edges == 0;
  }

  void count_fans(DisjointSets<Index>& corners) {
    std::vector<std::uint8_t> fans(n_, 0);  // 0, 1, or 2 for more
    for (std::size_t h = 0; h < 3 * m_; ++h) {
      if (degenerate(h / 3) || corners.find(static_cast<Index>(h)) != static_cast<Index>(h))
        continue;
      std::uint8_t& count = fans[static_cast<std::size_t>(id(h))];
      if (count < 2) ++count;
    }
    for (std::size_t v = 0; v < n_; ++v) {
      if (fans[v] < 2) continue;
      ++result_.nonmanifold_vertices;
      flags_[v] |= kNonmanifold;
    }
  }

  void mark_not_orientable() {
    TurnSets<Index> turns(m_);
    for_each_edge([&](Index lo, const HalfEdge* first, const HalfEdge* last) {
      if (last - first != 2) return;
      const bool same_direction = (id(static_cast<std::size_t>(first[0].h)) == lo) ==
                                  (id(static_cast<std::size_t>(first[1].h)) == lo);
      if (!turns.demand(first[0].h / 3, first[1].h / 3, same_direction)) {
        flags_[static_cast<std::size_t>(lo)] |= kNotOrientable;
      }
    });
  }

  void summarise_components() {
    std::vector<std::uint8_t> used(n_, 0);
    for (std::size_t h = 0; h < 3 * m_; ++h) {
      std::uint8_t& use = used[static_cast<std::size_t>(id(h))];
      use = static_cast<std::uint8_t>(use | (degenerate(h / 3) ? 1 : 2));
    }
    std::vector<Index> number(n_, -1);  // of the component, at its root
    std::vector<MeshComponent> components;
    std::vector<std::uint8_t> flags;
    std::int64_t in_triangles = 0;
    for (std::size_t v = 0; v < n_; ++v) {
      if (used[v] == 0) ++result_.unreferenced_vertices;
      if ((used[v] & 2) == 0) continue;
      ++in_triangles;
      const auto root = static_cast<std::size_t>(sets_.find(static_cast<Index>(v)));
      if (number[root] < 0) {
        number[root] = static_cast<Index>(components.size());
        components.emplace_back();
        flags.push_back(0);
      }
      const auto c = static_cast<std::size_t>(number[root]);
      ++components[c].vertices;
      components[c].edges += edge_count_[v];
      flags[c] |= flags_[v];
    }
    const auto component_of = [&](Index v) -> MeshComponent& {
      return components[static_cast<std::size_t>(number[static_cast<std::size_t>(sets_.find(v))])];
    };
    for (std::size_t t = 0; t < m_; ++t) {
      if (!degenerate(t)) ++component_of(id(3 * t)).triangles;
    }
    for (const Index v : boundary_at_) ++component_of(v).boundary_edges;
    std::int64_t genus = 0;
    bool defined = !components.empty();
    for (std::size_t c = 0; c < components.size(); ++c) {
      components[c].manifold = (flags[c] & kNonmanifold) == 0;
      components[c].orientable = (flags[c] & kNotOrientable) == 0;
      const std::optional<std::int64_t> own = components[c].genus();
      defined = defined && own.has_value();
      genus += own.value_or(0);
    }
    result_.components = static_cast<std::int64_t>(components.size());
    if (defined) result_.genus = genus;
    result_.euler =
        in_triangles - result_.edges + (result_.triangles - result_.degenerate_triangles);
    std::stable_sort(
        components.begin(), components.end(),
        [](const MeshComponent& a, const MeshComponent& b) { return a.triangles > b.triangles; });
    components.resize(std::min<std::size_t>(components.size(), 20));
    result_.largest = std::move(components);
  }

  // Triangles in bins by smallest id, each bin sorted by the other two.
  void count_duplicates() {
    std::vector<std::size_t> bins(n_ + 1, 0);
    const auto sorted = [this](std::size_t t) {
      std::array<Index, 3> f{id(3 * t), id(3 * t + 1), id(3 * t + 2)};
      std::sort(f.begin(), f.end());
      return f;
    };
    for (std::size_t t = 0; t < m_; ++t) {
      if (!degenerate(t)) ++bins[static_cast<std::size_t>(sorted(t)[0]) + 1];
    }
    std::partial_sum(bins.begin(), bins.end(), bins.begin());
    std::vector<std::pair<Index, Index>> others(bins[n_]);
    for (std::size_t t = 0; t < m_; ++t) {
      if (degenerate(t)) continue;
      const std::array<Index, 3> f = sorted(t);
      others[bins[static_cast<std::size_t>(f[0])]++] = {f[1], f[2]};
    }
    std::size_t start = 0;
    for (std::size_t v = 0; v < n_; ++v) {  // bins[v] is now the end of bin v
      const auto first = others.begin() + static_cast<std::ptrdiff_t>(start);
      const auto last = others.begin() + static_cast<std::ptrdiff_t>(bins[v]);
      std::sort(first, last);
      for (auto at = first; at != last && at + 1 != last; ++at)
        result_.duplicate_triangles += *at == *(at + 1);
      start = bins[v];
    }
  }

  void measure() {
    Eigen::Vector3d centre =
        Eigen::Vector3d::Zero();  // near the mesh, so that the volume does not cancel
    if (n_ > 0) {
      const Eigen::Map<const Mesh::Points> V(mesh_.positions, mesh_.vertex_count, 3);
      centre = 0.5 * (V.colwise().minCoeff() + V.colwise().maxCoeff()).transpose();
    }
    double area = 0.0, volume = 0.0;
    for (std::size_t t = 0; t < m_; ++t) {
      if (degenerate(t)) continue;
      const Eigen::Vector3d a = point(id(3 * t)) - centre, b = point(id(3 * t + 1)) - centre,
                            c = point(id(3 * t + 2)) - centre;
      const Eigen::Vector3d normal = (b - a).cross(c - a);
      const double length = normal.norm();
      const double longest =
          std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
      if (length <= 16.0 * std::numeric_limits<double>::epsilon() * longest)
        ++result_.zero_area_triangles;
      area += length;
      volume += a.dot(b.cross(c));
    }
    result_.area = area / 2.0;
    if (result_.oriented) result_.volume = volume / 6.0;
  }

  [[nodiscard]] const double* position(Index v) const {
    return mesh_.positions + 3 * static_cast<std::size_t>(v);
  }
  [[nodiscard]] Eigen::Vector3d point(Index v) const {
    return Eigen::Map<const Eigen::Vector3d>(position(v));
  }

  const MeshView& mesh_;
  const Index* ids_;
  std::size_t n_, m_;
  std::vector<std::size_t> bins_;
  std::vector<HalfEdge> halfedges_;
  DisjointSets<Index> sets_;
  std::vector<Index> edge_count_;  // edges whose lo the vertex is
  std::vector<std::uint8_t> flags_;
  std::vector<Index> boundary_at_;  // lo of each boundary edge
  const MeshCheckOptions& options_;
  MeshCheck result_;
};

template <class Real, class Id>
std::int64_t count_coincident(const MeshView& mesh) {
  const auto n = static_cast<std::size_t>(mesh.vertex_count);
  std::size_t size = 1024;
  while (size < 2 * n) size *= 2;
  constexpr Id kEmpty = std::numeric_limits<Id>::max();
  std::vector<Id> slots(size, kEmpty);
  const auto coordinates = [&mesh](std::size_t v) {
    std::array<Real, 3> p;
    for (std::size_t c = 0; c < 3; ++c)
      p[c] = static_cast<Real>(mesh.positions[3 * v + c]) + Real(0);  // −0 is 0
    return p;
  };
  std::int64_t repeated = 0;
  for (std::size_t v = 0; v < n; ++v) {
    const std::array<Real, 3> p = coordinates(v);
    std::uint64_t hash = 0;
    for (const Real c : p) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &c, sizeof c);
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 32;
    }
    std::size_t at = static_cast<std::size_t>(hash) & (size - 1);
    while (slots[at] != kEmpty && coordinates(static_cast<std::size_t>(slots[at])) != p)
      at = (at + 1) & (size - 1);
    if (slots[at] == kEmpty) {
      slots[at] = static_cast<Id>(v);
    } else {
      ++repeated;
    }
  }
  return repeated;
}

template <class Real>
std::int64_t coincident(const MeshView& mesh) {
  return mesh.vertex_count < std::int64_t{std::numeric_limits<std::uint32_t>::max()}
             ? count_coincident<Real, std::uint32_t>(mesh)
             : count_coincident<Real, std::uint64_t>(mesh);
}

}  // namespace

MeshCheck check_mesh(const MeshView& mesh, const MeshCheckOptions& options) {
  MeshCheck result = std::visit(
      [&](const auto* ids) {
        using Index = std::remove_cv_t<std::remove_pointer_t<decltype(ids)>>;
        if constexpr (sizeof(Index) == 4) {
          // Halfedges are numbered in Index too.
          if (3 * mesh.triangle_count > std::numeric_limits<std::int32_t>::max()) {
            const std::vector<std::int64_t> wide(ids, ids + 3 * mesh.triangle_count);
            return Checker<std::int64_t>(mesh, wide.data(), options).run();
          }
        }
        return Checker<Index>(mesh, ids, options).run();
      },
      mesh.indices);
  result.coincident_vertices = coincident<double>(mesh);
  return result;
}

std::int64_t coincident_as_float(const MeshView& mesh) { return coincident<float>(mesh); }

}  // namespace shape3d::apps
