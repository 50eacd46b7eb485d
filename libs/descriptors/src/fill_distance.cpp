// The distance from voxel centres to the surface. Eight centres, a block of 2 × 2 × 2, descend the
// tree of boxes together: a box further from the block than every centre's nearest triangle so far
// is passed over, and the distances to a triangle are computed for the eight at once. The nearest
// triangle of the block before gives the first bound.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "parallel.hpp"
#include "triangle_tree.hpp"
#include "vector_lanes.hpp"
#include "voxel_fills.hpp"

namespace shape3d::descriptors::detail {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct Block {
  FloatLanes x, y, z;     // centres of the eight voxels
  FloatLanes nearest;     // squared distances so far
  float worst;            // the largest of these
  float low[3], high[3];  // box of the centres
  std::uint32_t last;     // triangle that was nearest to some centre last
};

SHAPE3D_DESCRIPTORS_INLINE void minimum(FloatLanes& a, const FloatLanes& b) { a = b < a ? b : a; }
SHAPE3D_DESCRIPTORS_INLINE void maximum(FloatLanes& a, const FloatLanes& b) { a = b > a ? b : a; }

SHAPE3D_DESCRIPTORS_INLINE float largest(const FloatLanes& lanes) {
  float values[kFloatLanes];
  std::memcpy(values, &lanes, sizeof values);
  const float a = std::max(values[0], values[4]), b = std::max(values[1], values[5]),
              c = std::max(values[2], values[6]), d = std::max(values[3], values[7]);
  return std::max(std::max(a, b), std::max(c, d));
}

// Whether a is below b in some lane.
SHAPE3D_DESCRIPTORS_INLINE bool any_below(const FloatLanes& a, const FloatLanes& b) {
  const auto mask = a < b;
  std::uint64_t words[sizeof mask / sizeof(std::uint64_t)];
  std::memcpy(words, &mask, sizeof mask);
  return ((words[0] | words[1]) | (words[2] | words[3])) != 0;
}

// Squared distances of the centres to a triangle: to its plane where a centre is above the
// triangle, else to the nearest of its edges.
SHAPE3D_DESCRIPTORS_INLINE void visit_triangle(const DistanceTriangle& t, std::uint32_t id,
                                               Block& block) {
  FloatLanes zero, one, square, inside;
  set(zero, 0.0F);
  set(one, 1.0F);
  set(square, std::numeric_limits<float>::infinity());
  set(inside, t.inside);
  for (int i = 0; i < 3; ++i) {
    const FloatLanes wx = block.x - t.corner[i][0], wy = block.y - t.corner[i][1],
                     wz = block.z - t.corner[i][2];
    FloatLanes along = (wx * t.edge[i][0] + wy * t.edge[i][1] + wz * t.edge[i][2]) * t.inverse[i];
    maximum(along, zero);
    minimum(along, one);
    const FloatLanes dx = wx - along * t.edge[i][0], dy = wy - along * t.edge[i][1],
                     dz = wz - along * t.edge[i][2];
    minimum(square, dx * dx + dy * dy + dz * dz);
    minimum(inside, wx * t.inward[i][0] + wy * t.inward[i][1] + wz * t.inward[i][2]);
  }
  const FloatLanes height = (block.x - t.corner[0][0]) * t.normal[0] +
                            (block.y - t.corner[0][1]) * t.normal[1] +
                            (block.z - t.corner[0][2]) * t.normal[2];
  square = inside >= zero ? height * height : square;
  if (any_below(square, block.nearest)) {
    minimum(block.nearest, square);
    block.worst = largest(block.nearest);
    block.last = id;
  }
}

// Squared distance between the boxes of a node and of the block.
SHAPE3D_DESCRIPTORS_INLINE float separation(const TriangleTree::Node& node, const Block& block) {
  float sum = 0.0F;
  for (int axis = 0; axis < 3; ++axis) {
    const float gap =
        std::max({0.0F, node.low[axis] - block.high[axis], block.low[axis] - node.high[axis]});
    sum += gap * gap;
  }
  return sum;
}

// Whether some centre is nearer to the box of a node than to its nearest triangle so far.
SHAPE3D_DESCRIPTORS_INLINE bool reaches(const TriangleTree::Node& node, const Block& block) {
  FloatLanes zero;
  set(zero, 0.0F);
  FloatLanes x = node.low[0] - block.x, y = node.low[1] - block.y, z = node.low[2] - block.z;
  maximum(x, block.x - node.high[0]);
  maximum(y, block.y - node.high[1]);
  maximum(z, block.z - node.high[2]);
  maximum(x, zero);
  maximum(y, zero);
  maximum(z, zero);
  return any_below(x * x + y * y + z * z, block.nearest);
}

SHAPE3D_DESCRIPTORS_INLINE void descend(const TriangleTree& tree, Block& block) {
  struct Waiting {
    std::uint32_t node;
    float separation;
  };
  std::array<Waiting, TriangleTree::kMaxDepth> stack;
  std::size_t height = 0;
  Waiting current{0, separation(tree.node(0), block)};
  for (;;) {
    // First by the boxes as wholes, then by each centre.
    if (current.separation < block.worst && reaches(tree.node(current.node), block)) {
      const TriangleTree::Node& node = tree.node(current.node);
      if (node.count == 0) {
        Waiting near{node.first, separation(tree.node(node.first), block)};
        Waiting far{node.first + 1, separation(tree.node(node.first + 1), block)};
        if (far.separation < near.separation) std::swap(near, far);
        stack[height++] = far;
        current = near;
        continue;
      }
      for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
        visit_triangle(tree.triangle(t), t, block);
      }
    }
    if (height == 0) return;
    current = stack[--height];
  }
}

// The blocks of a row along x, where each starts with the triangle that the one before ended with.
SHAPE3D_DESCRIPTORS_INLINE void row_lanes(const TriangleTree& tree, int side, int j, int k,
                                          float reach, float* squares) {
  const auto n = static_cast<std::size_t>(side);
  const float ball = 0.5F * static_cast<float>(side);
  Block block{};
  block.last = kNone;
  block.low[1] = static_cast<float>(j) + 0.5F;
  block.low[2] = static_cast<float>(k) + 0.5F;
  for (int i = 0; i < side; i += 2) {
    block.low[0] = static_cast<float>(i) + 0.5F;
    float outside = 0.0F;  // squared distance of the nearest centre from the middle
    for (int axis = 0; axis < 3; ++axis) {
      block.high[axis] = block.low[axis] + 1.0F;
      const float gap = std::max({0.0F, block.low[axis] - ball, ball - block.high[axis]});
      outside += gap * gap;
    }
    float x[kFloatLanes], y[kFloatLanes], z[kFloatLanes];
    for (std::size_t lane = 0; lane < kFloatLanes; ++lane) {
      x[lane] = block.low[0] + static_cast<float>(lane & 1);
      y[lane] = block.low[1] + static_cast<float>((lane >> 1) & 1);
      z[lane] = block.low[2] + static_cast<float>(lane >> 2);
    }
    load(block.x, x);
    load(block.y, y);
    load(block.z, z);
    block.worst = reach * reach;
    set(block.nearest, block.worst);
    // A voxel reaches √3/2 from its centre; interpolation within the ball looks as far again.
    const float limit = ball + 1.7320508F;
    if (outside <= limit * limit) {
      if (block.last != kNone) visit_triangle(tree.triangle(block.last), block.last, block);
      descend(tree, block);
    }
    for (std::size_t lane = 0; lane < kFloatLanes; ++lane) {
      const auto column = static_cast<std::size_t>(i) + (lane & 1),
                 line = static_cast<std::size_t>(j) + ((lane >> 1) & 1),
                 plane = static_cast<std::size_t>(k) + (lane >> 2);
      if (column < n && line < n && plane < n) {
        squares[column + n * (line + n * plane)] = block.nearest[lane];
      }
    }
  }
}

void row_portable(const TriangleTree& tree, int side, int j, int k, float reach, float* squares) {
  row_lanes(tree, side, j, k, reach, squares);
}

SHAPE3D_DESCRIPTORS_AVX2 void row_avx2(const TriangleTree& tree, int side, int j, int k,
                                       float reach, float* squares) {
  row_lanes(tree, side, j, k, reach, squares);
}

}  // namespace

std::vector<float> gaussian_of_surface(const std::vector<GridTriangle>& triangles, int side,
                                       double sigma, double reach, int threads) {
  const auto n = static_cast<std::size_t>(side);
  std::vector<float> values(n * n * n, 0.0F);
  const TriangleTree tree(triangles, side, reach);
  if (tree.empty()) return values;
  const auto row = has_avx2() ? row_avx2 : row_portable;
  const auto limit = static_cast<float>(reach);
  const auto scale = static_cast<float>(-0.5 / (sigma * sigma));
  const std::int64_t half = (side + 1) / 2;  // rows of blocks along an axis
  parallel_blocks(half * half, 4, threads, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t r = first; r < last; ++r) {
      const int j = 2 * static_cast<int>(r % half), k = 2 * static_cast<int>(r / half);
      row(tree, side, j, k, limit, values.data());
      for (int z = k; z < std::min(k + 2, side); ++z) {
        for (int y = j; y < std::min(j + 2, side); ++y) {
          float* const line =
              values.data() + n * (static_cast<std::size_t>(y) + n * static_cast<std::size_t>(z));
          for (std::size_t x = 0; x < n; ++x) {
            line[x] = line[x] < limit * limit ? std::exp(scale * line[x]) : 0.0F;
          }
        }
      }
    }
  });
  return values;
}

}  // namespace shape3d::descriptors::detail
