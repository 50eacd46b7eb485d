#pragma once

// What counting finds out, so that every thread can write its part of the surface at its place.

#include <array>
#include <cstdint>
#include <vector>

#include "shape3d/zmc/surface.hpp"
#include "zero_faces.hpp"

namespace shape3d::zmc::detail {

/// The vertices that belong to a lattice row, in the order of their ids: crossings along x, y, z,
/// used zero samples, centroids of the cells of the row, centres of their zero faces. Triangles:
/// those of the cells of the row, by x.
struct RowPlan {
  std::uint32_t first_vertex = 0;     ///< Relative to the row's group.
  std::uint32_t first_triangle = 0;   ///< Relative to the row's group.
  std::uint32_t x = 0, y = 0, z = 0;  ///< Crossings.
};

/// Inserted faces of the cells of a layer and their places among all.
struct LayerPlan {
  std::vector<InsertedFace> quads, closing;
  std::int64_t first_quad = 0, first_closing = 0;
  /// Sides of polygons that run along lattice edges between two zero samples: 3·(i + nx·j) + axis,
  /// of edges that start in this layer's lower plane and of edges in its upper one.
  std::vector<std::uint64_t> lower_edges, upper_edges;
};

struct Plan {
  /// Planes of the lattice, and layers of cells that start at them, whose part of the surface is
  /// wanted. The others are only there for what they say about the vertices of these.
  struct Part {
    std::int64_t first = 0, last = 0;
  };
  static constexpr int kGroupShift = 6;
  /// Rows longer than this would overflow the numbers of a group.
  static constexpr std::int64_t kLongestRow = std::int64_t{1} << 22;

  std::vector<RowPlan> rows;
  std::vector<std::int64_t> group_vertex, group_triangle;
  std::vector<LayerPlan> layers;
  std::int64_t vertices = 0;  ///< Of the part, like all counts.
  std::int64_t patch_triangles = 0;
  Counts counts;
  Part part;
  std::int64_t part_vertex = 0,
               part_triangle = 0;  ///< Where the part begins in the numbers of the lattice.
  std::int64_t first_id = 0;       ///< Id of the first vertex of the part.

  [[nodiscard]] std::int64_t first_vertex(std::int64_t row) const {
    return group_vertex[static_cast<std::size_t>(row >> kGroupShift)] +
           rows[static_cast<std::size_t>(row)].first_vertex;
  }
  /// Id of the first vertex of a row; rows beyond the part have ids beyond its own.
  [[nodiscard]] std::int64_t first_row_id(std::int64_t row) const {
    return first_vertex(row) - part_vertex + first_id;
  }
  [[nodiscard]] std::int64_t first_triangle(std::int64_t row) const {
    return group_triangle[static_cast<std::size_t>(row >> kGroupShift)] +
           rows[static_cast<std::size_t>(row)].first_triangle;
  }
};

}  // namespace shape3d::zmc::detail
