#include "mesh_properties.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

namespace shape3d::test {
namespace {

class DisjointSets {
 public:
  explicit DisjointSets(std::int64_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), std::int64_t{0});
  }
  std::int64_t find(std::int64_t x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  void unite(std::int64_t a, std::int64_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::int64_t> parent_;
};

/// One side of one triangle.
struct Side {
  std::int64_t low, high;
  bool forward;  ///< The triangle runs it from low to high.
  std::int64_t triangle;
};

void count_edges(const Points& V, const Triangles& F, const Exempt& exempt,
                 MeshProperties& result) {
  std::vector<Side> sides;
  for (std::int64_t f = 0; f < F.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const std::int64_t a = F(f, k), b = F(f, (k + 1) % 3);
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), a < b, f});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& l, const Side& r) {
    return l.low != r.low ? l.low < r.low : l.high < r.high;
  });
  DisjointSets triangles(F.rows());
  for (auto begin = sides.begin(); begin != sides.end();) {
    auto end = begin;
    std::int64_t forward = 0, count = 0;
    for (; end != sides.end() && end->low == begin->low && end->high == begin->high; ++end) {
      triangles.unite(begin->triangle, end->triangle);
      forward += end->forward;
      ++count;
    }
    ++result.edges;
    const bool odd = count % 2 == 1, unbalanced = 2 * forward != count;
    if (odd || unbalanced) {
      const bool is_exempt = exempt && exempt(V.row(begin->low), V.row(begin->high));
      result.odd_edges += odd && !is_exempt;
      result.exempt_edges += odd && is_exempt;
      result.unbalanced_edges += unbalanced && !is_exempt;
    }
    result.nonmanifold_edges += count > 2;
    result.inconsistent_edges += count == 2 && forward != 1;
    begin = end;
  }
  for (std::int64_t f = 0; f < F.rows(); ++f) result.edge_components += triangles.find(f) == f;
}

void count_triangles(const Triangles& F, MeshProperties& result) {
  std::vector<std::array<std::int64_t, 3>> sorted;
  for (std::int64_t f = 0; f < F.rows(); ++f) {
    std::array<std::int64_t, 3> t{F(f, 0), F(f, 1), F(f, 2)};
    std::sort(t.begin(), t.end());
    result.repeated_ids += t[0] == t[1] || t[1] == t[2];
    sorted.push_back(t);
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t n = 1; n < sorted.size(); ++n) {
    result.duplicate_triangles += sorted[n] == sorted[n - 1];
  }
}

void count_vertices(const Points& V, const Triangles& F, MeshProperties& result) {
  std::vector<char> used(V.rows(), 0);
  DisjointSets vertices(V.rows());
  for (std::int64_t f = 0; f < F.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      used[F(f, k)] = 1;
      vertices.unite(F(f, 0), F(f, k));
    }
  }
  std::int64_t in_use = 0;
  for (std::int64_t v = 0; v < V.rows(); ++v) {
    in_use += used[v];
    result.components += used[v] != 0 && vertices.find(v) == v;
    result.non_finite_vertices += !V.row(v).allFinite();
  }
  result.unreferenced_vertices = V.rows() - in_use;
  result.euler = in_use - result.edges + F.rows();

  if (result.non_finite_vertices != 0) return;  // No order among places with NaN.
  std::vector<std::int64_t> order(V.rows());
  std::iota(order.begin(), order.end(), std::int64_t{0});
  const auto place = [&](std::int64_t v) {
    return std::array<double, 3>{V(v, 0), V(v, 1), V(v, 2)};
  };
  std::sort(order.begin(), order.end(),
            [&](std::int64_t l, std::int64_t r) { return place(l) < place(r); });
  for (std::size_t n = 1; n < order.size(); ++n) {
    result.coincident_vertices += place(order[n]) == place(order[n - 1]);
  }
}

}  // namespace

Exempt on_border(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  return [lower, upper](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    for (int axis = 0; axis < 3; ++axis) {
      if (a[axis] == lower[axis] && b[axis] == lower[axis]) return true;
      if (a[axis] == upper[axis] && b[axis] == upper[axis]) return true;
    }
    return false;
  };
}

Exempt on_border(const std::array<std::int64_t, 3>& dims) {
  Eigen::Vector3d upper;
  for (int axis = 0; axis < 3; ++axis) upper[axis] = static_cast<double>(dims[axis] - 1);
  return on_border(Eigen::Vector3d::Zero(), upper);
}

MeshProperties mesh_properties(const Points& V, const Triangles& F, const Exempt& exempt) {
  MeshProperties result;
  result.vertices = V.rows();
  result.triangles = F.rows();
  for (std::int64_t f = 0; f < F.rows(); ++f) {
    result.invalid_ids += F.row(f).minCoeff() < 0 || F.row(f).maxCoeff() >= V.rows();
  }
  if (result.invalid_ids != 0) return result;
  count_edges(V, F, exempt, result);
  count_triangles(F, result);
  count_vertices(V, F, result);
  for (std::int64_t f = 0; f < F.rows(); ++f) {
    const Eigen::Vector3d a = V.row(F(f, 0)), b = V.row(F(f, 1)), c = V.row(F(f, 2));
    result.area += (b - a).cross(c - a).norm() / 2.0;
    result.volume += a.dot(b.cross(c)) / 6.0;
  }
  return result;
}

}  // namespace shape3d::test
