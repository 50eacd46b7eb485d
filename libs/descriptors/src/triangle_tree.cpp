#include "triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace shape3d::descriptors::detail {
namespace {

using Eigen::Vector3d;

constexpr int kMaxHalvings = 64;  // of triangles that reach far out of the grid

// Adds the parts of a triangle that come near the grid, halved at their longest edges.
void add_parts(const GridTriangle& t, int side, double margin, int halvings,
               std::vector<GridTriangle>& parts) {
  if ((t.high().array() < -margin).any() || (t.low().array() > side + margin).any()) return;
  const std::array<double, 3> squares{(t.b - t.a).squaredNorm(), (t.c - t.b).squaredNorm(),
                                      (t.a - t.c).squaredNorm()};
  const auto longest = std::max_element(squares.begin(), squares.end()) - squares.begin();
  if (squares[static_cast<std::size_t>(longest)] <=
          TriangleTree::kLongest * TriangleTree::kLongest ||
      halvings == kMaxHalvings) {
    parts.push_back(t);
    return;
  }
  const auto halve = [&](const Vector3d& from, const Vector3d& to, const Vector3d& opposite) {
    const Vector3d middle = 0.5 * (from + to);
    add_parts({from, middle, opposite}, side, margin, halvings + 1, parts);
    add_parts({middle, to, opposite}, side, margin, halvings + 1, parts);
  };
  if (longest == 0) halve(t.a, t.b, t.c);
  if (longest == 1) halve(t.b, t.c, t.a);
  if (longest == 2) halve(t.c, t.a, t.b);
}

void store(const Vector3d& v, float* out) {
  for (Eigen::Index i = 0; i < 3; ++i) out[i] = static_cast<float>(v[i]);
}

DistanceTriangle prepared(const GridTriangle& t) {
  DistanceTriangle result{};
  const Vector3d corner[3] = {t.a, t.b, t.c};
  const Vector3d edge[3] = {t.b - t.a, t.c - t.b, t.a - t.c};
  const Vector3d cross = edge[0].cross(edge[1]);
  double longest = 0.0;
  for (const Vector3d& e : edge) longest = std::max(longest, e.squaredNorm());
  // A triangle that is lower than 1e-6 voxel edges is as near as its edges are; the direction of
  // its normal would be lost in single precision.
  const bool flat = cross.norm() <= 1e-6 * std::sqrt(longest) || cross.norm() <= 1e-5 * longest;
  const Vector3d normal = flat ? Vector3d::Zero().eval() : cross.normalized().eval();
  for (int i = 0; i < 3; ++i) {
    store(corner[i], result.corner[i]);
    store(edge[i], result.edge[i]);
    const double square = edge[i].squaredNorm();
    result.inverse[i] = square > 1e-30 ? static_cast<float>(1.0 / square) : 0.0F;
    store(normal.cross(edge[i]), result.inward[i]);
  }
  store(normal, result.normal);
  result.inside = flat ? -1.0F : 0.0F;
  return result;
}

// Spreads the lowest 10 bits to every third place.
std::uint32_t spread(std::uint32_t x) {
  x = (x | (x << 16)) & 0x030000FFU;
  x = (x | (x << 8)) & 0x0300F00FU;
  x = (x | (x << 4)) & 0x030C30C3U;
  x = (x | (x << 2)) & 0x09249249U;
  return x;
}

std::uint32_t morton_code(const GridTriangle& t, int side, double margin) {
  const double scale = 1023.0 / (side + 2.0 * margin);
  std::uint32_t code = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double middle = (t.a[axis] + t.b[axis] + t.c[axis]) / 3.0;
    const double cell = std::clamp((middle + margin) * scale, 0.0, 1023.0);
    code |= spread(static_cast<std::uint32_t>(cell)) << axis;
  }
  return code;
}

// The next float towards infinity: boxes must not lose what rounding to single precision moved.
float below(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float above(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

}  // namespace

TriangleTree::TriangleTree(const std::vector<GridTriangle>& triangles, int side, double margin) {
  std::vector<GridTriangle> parts;
  parts.reserve(triangles.size());
  for (const GridTriangle& t : triangles) add_parts(t, side, margin, 0, parts);
  if (parts.empty()) return;

  std::vector<std::pair<std::uint32_t, std::uint32_t>> order(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    order[i] = {morton_code(parts[i], side, margin), static_cast<std::uint32_t>(i)};
  }
  std::sort(order.begin(), order.end());
  triangles_.reserve(parts.size());
  for (const auto& [code, i] : order) triangles_.push_back(prepared(parts[i]));

  // Ranges of triangles are halved until they are leaves; children of a node stand side by side.
  struct Range {
    std::uint32_t node, first, count;
  };
  nodes_.emplace_back();
  std::vector<Range> open{{0, 0, static_cast<std::uint32_t>(parts.size())}};
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    if (range.count <= kLeafSize) {
      Node& leaf = nodes_[range.node];
      leaf.first = range.first;
      leaf.count = range.count;
      continue;
    }
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[range.node].first = child;
    nodes_[range.node].count = 0;
    nodes_.emplace_back();
    nodes_.emplace_back();
    const std::uint32_t half = (range.count / 2 + kLeafSize - 1) / kLeafSize * kLeafSize;
    open.push_back({child, range.first, half});
    open.push_back({child + 1, range.first + half, range.count - half});
  }
  // Children come after their parents.
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis] = std::numeric_limits<float>::infinity();
      node.high[axis] = -node.low[axis];
    }
    if (node.count > 0) {
      for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
        const Vector3d low = parts[order[t].second].low(), high = parts[order[t].second].high();
        for (int axis = 0; axis < 3; ++axis) {
          node.low[axis] = std::min(node.low[axis], below(low[axis]));
          node.high[axis] = std::max(node.high[axis], above(high[axis]));
        }
      }
    } else {
      for (const std::uint32_t child : {node.first, node.first + 1}) {
        for (int axis = 0; axis < 3; ++axis) {
          node.low[axis] = std::min(node.low[axis], nodes_[child].low[axis]);
          node.high[axis] = std::max(node.high[axis], nodes_[child].high[axis]);
        }
      }
    }
  }
}

}  // namespace shape3d::descriptors::detail
