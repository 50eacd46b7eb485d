#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping::detail {

using Corner = std::int32_t;  ///< 3 · triangle + place; −1: none.

inline Corner next(Corner c) { return c % 3 == 2 ? c - 2 : c + 1; }
inline Corner previous(Corner c) { return c % 3 == 0 ? c + 2 : c - 1; }

/// The two triangles that a collapse of the edge between u and v removes, by their corners at u:
/// the left one runs u → v → apex, the right one v → u → apex. −1 where the edge has none.
struct CollapsePlace {
  Corner left = -1, right = -1;
};

/// An oriented manifold of triangles in which edges are collapsed, and collapses are undone in the
/// reverse order.
///
/// opposite(c) is the corner across the edge that c does not touch, −1 at the boundary. A triangle
/// that a collapse removes keeps its corners and opposites, which is all that undoing needs.
class CornerMesh {
 public:
  CornerMesh() = default;
  /// @pre  F is an oriented manifold.
  CornerMesh(const ConstTriangles& F, std::int64_t vertices);
  /// Without any triangle; set_triangle() adds them.
  CornerMesh(std::int64_t triangles, std::int64_t vertices);

  [[nodiscard]] std::int32_t vertex(Corner c) const { return vertex_[static_cast<std::size_t>(c)]; }
  [[nodiscard]] Corner opposite(Corner c) const { return opposite_[static_cast<std::size_t>(c)]; }
  /// Some corner at a vertex that is in the mesh.
  [[nodiscard]] Corner corner_at(std::int32_t v) const {
    return corner_[static_cast<std::size_t>(v)];
  }
  [[nodiscard]] std::size_t vertices() const { return corner_.size(); }
  [[nodiscard]] std::size_t triangles() const { return vertex_.size() / 3; }

  /// The next corner at the same vertex, across the edge to the vertex before; −1 at the boundary.
  [[nodiscard]] Corner turn(Corner c) const {
    const Corner d = opposite(next(c));
    return d < 0 ? -1 : next(d);
  }
  /// The same the other way round, across the edge to the vertex behind.
  [[nodiscard]] Corner turn_back(Corner c) const {
    const Corner d = opposite(previous(c));
    return d < 0 ? -1 : previous(d);
  }
  /// The corner at v where walking round it by turn() begins: behind the boundary, or else in the
  /// triangle of the smallest number.
  [[nodiscard]] Corner first_corner(std::int32_t v) const;

  /// Where the edge from u to v is. @pre  There is one.
  [[nodiscard]] CollapsePlace find_edge(std::int32_t u, std::int32_t v) const;

  /// Puts v in the place of u and removes the triangles of the edge.
  void collapse(const CollapsePlace& place);
  /// Undoes the last collapse that is not undone.
  void split(const CollapsePlace& place);

  // For building a mesh from records.
  void set_triangle(std::int32_t triangle, std::int32_t a, std::int32_t b, std::int32_t c);
  /// A triangle that a split will add: what its corners are and what is beyond them.
  void fill_triangle(std::int32_t triangle, const std::array<std::int32_t, 3>& ids);
  void set_beyond(Corner c, Corner beyond) { opposite_[static_cast<std::size_t>(c)] = beyond; }
  /// Finds the opposites of the triangles that were set. @return  false when they are not an
  /// oriented manifold.
  [[nodiscard]] bool connect(const std::vector<std::int32_t>& triangles);

 private:
  // Calls visit for the corners at u in the triangles that stay, beginning at those removed.
  template <class Visit>
  void for_each_kept_corner(const CollapsePlace& place, const Visit& visit) const;

  void set_opposite(Corner c, Corner d);

  std::vector<std::int32_t> vertex_;
  std::vector<Corner> opposite_;
  std::vector<Corner> corner_;
};

}  // namespace shape3d::mapping::detail
