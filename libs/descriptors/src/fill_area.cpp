// Surface area distributed trilinearly. Between planes of voxel centres each of the eight tents
// that reach a point is a product of three linear functions, so a piece of triangle that lies in
// one such cell is integrated exactly by a rule of degree 3.
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "parallel.hpp"
#include "voxel_fills.hpp"

namespace shape3d::descriptors::detail {
namespace {

using Eigen::Vector3d;

constexpr int kSlab = 8;  // layers of cells that one task fills

// A convex polygon; a triangle cut by six planes has at most nine corners.
struct Polygon {
  std::array<Vector3d, 10> corners;
  std::size_t size = 0;

  void add(const Vector3d& p) {
    if (size < corners.size()) corners[size++] = p;
  }
};

// Parts of a polygon below and above { x[axis] = at }.
void cut(const Polygon& polygon, Eigen::Index axis, double at, Polygon& below, Polygon& above) {
  below.size = above.size = 0;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vector3d& p = polygon.corners[i];
    const Vector3d& q = polygon.corners[(i + 1) % polygon.size];
    if (p[axis] <= at) below.add(p);
    if (p[axis] >= at) above.add(p);
    if ((p[axis] < at && q[axis] > at) || (p[axis] > at && q[axis] < at)) {
      Vector3d x = p + (at - p[axis]) / (q[axis] - p[axis]) * (q - p);
      x[axis] = at;
      below.add(x);
      above.add(x);
    }
  }
}

// Layers first … first + kSlab of voxel centres, the last one shared with the next slab.
class Slab {
 public:
  Slab(int side, int first, double* layers) : side_(side), first_(first), layers_(layers) {}

  // Adds the part of a polygon (in coordinates where voxel centres are integers) inside the slab.
  void add(const Polygon& polygon) {
    Vector3d low = polygon.corners[0], high = low;
    for (std::size_t i = 1; i < polygon.size; ++i) {
      low = low.cwiseMin(polygon.corners[i]);
      high = high.cwiseMax(polygon.corners[i]);
    }
    std::array<int, 3> from{}, to{};  // cells, the last one excluded
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      const int begin = axis == 2 ? first_ : -1;
      const int end = axis == 2 ? std::min(first_ + kSlab, side_) : side_;
      if (high[i] < begin || low[i] > end) return;
      from[axis] = std::max(begin, static_cast<int>(std::floor(std::max(low[i], -2.0))));
      to[axis] = std::min(end, static_cast<int>(std::ceil(std::min(high[i], side_ + 1.0))));
      if (to[axis] <= from[axis]) to[axis] = from[axis] + 1;  // it lies in a plane of centres
      if (from[axis] >= end) return;                          // which the next slab takes
    }
    Polygon inside = polygon, below, above;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      if (low[i] < from[axis]) {
        cut(inside, i, from[axis], below, above);
        inside = above;
      }
      if (high[i] > to[axis]) {
        cut(inside, i, to[axis], below, above);
        inside = below;
      }
      if (inside.size < 3) return;
    }
    split(inside, from, to);
  }

 private:
  void split(const Polygon& polygon, std::array<int, 3> from, std::array<int, 3> to) {
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (to[axis] - from[axis] > to[longest] - from[longest]) longest = axis;
    }
    if (to[longest] - from[longest] == 1) {
      integrate(polygon, from);
      return;
    }
    const int middle = (from[longest] + to[longest]) / 2;
    Polygon below, above;
    cut(polygon, static_cast<Eigen::Index>(longest), middle, below, above);
    auto end = to, begin = from;
    end[longest] = begin[longest] = middle;
    if (below.size >= 3) split(below, from, end);
    if (above.size >= 3) split(above, begin, to);
  }

  void integrate(const Polygon& polygon, const std::array<int, 3>& cell) {
    // Six points, degree 4, positive weights (Cowper 1973).
    static constexpr double kNear = 0.09157621350977073, kNearWeight = 0.1099517436553219;
    static constexpr double kFar = 0.4459484909159649, kFarWeight = 0.2233815896780115;
    const Vector3d base(cell[0], cell[1], cell[2]);
    std::array<double, 8> sums{};
    const Vector3d a = polygon.corners[0] - base;
    for (std::size_t i = 1; i + 1 < polygon.size; ++i) {
      const Vector3d b = polygon.corners[i] - base, c = polygon.corners[i + 1] - base;
      const double area = 0.5 * (b - a).cross(c - a).norm();
      const Vector3d total = a + b + c;
      for (const Vector3d* const corner : {&a, &b, &c}) {
        add_point(total * kNear + *corner * (1.0 - 3.0 * kNear), area * kNearWeight, sums);
        add_point(total * kFar + *corner * (1.0 - 3.0 * kFar), area * kFarWeight, sums);
      }
    }
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const int x = cell[0] + static_cast<int>(corner & 1),
                y = cell[1] + static_cast<int>((corner >> 1) & 1),
                z = cell[2] + static_cast<int>(corner >> 2);
      if (x < 0 || y < 0 || z < 0 || x >= side_ || y >= side_ || z >= side_) continue;
      const auto n = static_cast<std::size_t>(side_);
      layers_[static_cast<std::size_t>(x) +
              n * (static_cast<std::size_t>(y) + n * static_cast<std::size_t>(z - first_))] +=
          sums[corner];
    }
  }

  static void add_point(const Vector3d& p, double weight, std::array<double, 8>& sums) {
    const double x[2] = {weight * (1.0 - p[0]), weight * p[0]};
    const double y[2] = {1.0 - p[1], p[1]}, z[2] = {1.0 - p[2], p[2]};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      sums[corner] += x[corner & 1] * y[(corner >> 1) & 1] * z[corner >> 2];
    }
  }

  int side_, first_;
  double* layers_;
};

}  // namespace

std::vector<float> area_splat(const std::vector<GridTriangle>& triangles, int side, int threads) {
  const auto n = static_cast<std::size_t>(side);
  // Cells −1 … side − 1 of voxel centres; slab s begins at cell s · kSlab − 1 and writes kSlab + 1
  // layers of its own, which are added in order.
  const auto slabs = static_cast<std::size_t>((side + 1 + kSlab - 1) / kSlab);
  std::vector<std::vector<std::uint32_t>> members(slabs);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const double low = triangles[t].low()[2] + 0.5, high = triangles[t].high()[2] + 0.5;
    const double last = static_cast<double>(slabs) - 1.0;
    const auto from = static_cast<std::size_t>(std::clamp(std::floor(low / kSlab), 0.0, last));
    const auto to = static_cast<std::size_t>(std::clamp(std::floor(high / kSlab), 0.0, last));
    for (std::size_t s = from; s <= to; ++s) members[s].push_back(static_cast<std::uint32_t>(t));
  }
  const std::size_t layer = n * n, buffer = layer * (kSlab + 1);
  std::vector<double> layers(slabs * buffer, 0.0);
  parallel_blocks(
      static_cast<std::int64_t>(slabs), 1, threads, [&](std::int64_t first, std::int64_t) {
        const auto s = static_cast<std::size_t>(first);
        Slab slab(side, static_cast<int>(first) * kSlab - 1, layers.data() + s * buffer);
        const Vector3d half = Vector3d::Constant(0.5);
        for (const std::uint32_t t : members[s]) {
          Polygon polygon;
          polygon.add(triangles[t].a - half);
          polygon.add(triangles[t].b - half);
          polygon.add(triangles[t].c - half);
          slab.add(polygon);
        }
      });
  std::vector<float> values(n * n * n);
  for (std::size_t z = 0; z < n; ++z) {
    const std::size_t s = (z + 1) / kSlab, inner = (z + 1) % kSlab;
    const double* const own = layers.data() + s * buffer + inner * layer;
    const double* const before =
        inner == 0 && s > 0 ? layers.data() + (s - 1) * buffer + kSlab * layer : nullptr;
    const bool has_own = s < slabs;
    for (std::size_t i = 0; i < layer; ++i) {
      values[z * layer + i] =
          static_cast<float>((has_own ? own[i] : 0.0) + (before != nullptr ? before[i] : 0.0));
    }
  }
  return values;
}

}  // namespace shape3d::descriptors::detail
