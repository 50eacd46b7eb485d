#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grid_triangles.hpp"

namespace shape3d::descriptors::detail {

/// What the distance from a point to a triangle needs, in single precision: coordinates of grids of
/// up to 256 voxels are then good to 1.5e-5 voxel edges.
struct DistanceTriangle {
  float corner[3][3];  ///< a, b, c
  float edge[3][3];    ///< b − a, c − b, a − c
  float inverse[3];    ///< 1 / |edge|², 0 for an edge of no length
  float inward[3][3];  ///< normal × edge: positive inside of the edge's line
  float normal[3];     ///< Of length 1, or 0 for a degenerate triangle,
  float inside;        ///< for which this is −1, so that no point counts as above it; else 0.
};

/// Boxes round triangles, a complete binary tree. Triangles longer than kLongest are halved first,
/// and parts of them far from the grid left out, so that boxes are near what they hold.
class TriangleTree {
 public:
  static constexpr double kLongest = 12.0;       ///< Voxel edges.
  static constexpr std::uint32_t kLeafSize = 2;  ///< Triangles of a leaf.
  static constexpr std::size_t kMaxDepth = 40;

  struct Node {
    float low[3], high[3];
    std::uint32_t first, count;  ///< Leaf: triangles. Inner: count is 0, children first, first + 1.
  };

  /// @param margin  Parts of triangles further from the grid [0, side]³ are left out.
  TriangleTree(const std::vector<GridTriangle>& triangles, int side, double margin);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  [[nodiscard]] const Node& node(std::uint32_t i) const { return nodes_[i]; }
  [[nodiscard]] const DistanceTriangle& triangle(std::uint32_t i) const { return triangles_[i]; }

 private:
  std::vector<Node> nodes_;
  std::vector<DistanceTriangle> triangles_;
};

}  // namespace shape3d::descriptors::detail
