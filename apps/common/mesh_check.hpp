#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <shape3d/zmc/volume_view.hpp>

#include "mesh.hpp"

namespace shape3d::apps {

/// One piece of a mesh: vertices joined by edges of triangles. Pieces that touch in a vertex are
/// one.
struct MeshComponent {
  std::int64_t vertices = 0, edges = 0, triangles = 0;
  std::int64_t boundary_edges = 0;  ///< Edges of one triangle.
  bool manifold = false;  ///< Each edge has at most two triangles and each vertex one fan of them.
  bool orientable = false;  ///< The triangles can be turned so that no edge is inconsistent.
  [[nodiscard]] std::int64_t euler() const { return vertices - edges + triangles; }
  /// (2 − χ) / 2 of a closed orientable manifold; not defined for others.
  [[nodiscard]] std::optional<std::int64_t> genus() const {
    if (!manifold || !orientable || boundary_edges > 0) return std::nullopt;
    return (2 - euler()) / 2;
  }
};

/// Combinatorial and metric facts about a mesh.
///
/// Edges are unordered pairs of vertex ids. A triangle that repeats an id is degenerate and takes
/// part in nothing but its own count: it would add each of its edges an even number of times.
struct MeshCheck {
  std::int64_t vertices = 0;   ///< Rows of V.
  std::int64_t triangles = 0;  ///< Rows of F.
  std::int64_t edges = 0;
  std::int64_t components = 0;      ///< Of the vertices that triangles use.
  std::int64_t boundary_edges = 0;  ///< Edges of one triangle.
  std::int64_t odd_edges = 0;       ///< Edges of an odd number of triangles.
  std::optional<std::int64_t>
      odd_interior_edges;              ///< Odd edges that are not in a border plane of the volume.
  std::int64_t nonmanifold_edges = 0;  ///< Edges of more than two triangles.
  std::int64_t nonmanifold_vertices = 0;  ///< Vertices of more than one fan of triangles.
  std::int64_t inconsistent_edges =
      0;                   ///< Edges of two triangles that run along them in one direction.
  std::int64_t euler = 0;  ///< Used vertices − edges + triangles that are not degenerate.
  std::optional<std::int64_t>
      genus;              ///< Sum over the components; not defined unless it is for each.
  bool closed = false;    ///< There are triangles, and no odd edge.
  bool oriented = false;  ///< Each edge is run along equally often in both directions.
  std::int64_t degenerate_triangles = 0;   ///< Triangles that repeat an id.
  std::int64_t zero_area_triangles = 0;    ///< Three different ids, corners on a line to rounding.
  std::int64_t duplicate_triangles = 0;    ///< Triangles whose three ids an earlier one has.
  std::int64_t unreferenced_vertices = 0;  ///< Vertices that no triangle uses.
  std::int64_t coincident_vertices = 0;    ///< Vertices at the exact position of an earlier one.
  double area = 0.0;                       ///< Square of the unit of V.
  /// Σ a · (b × c) / 6, positive when the triangles are counter-clockwise seen from outside;
  /// defined for `oriented` meshes, where it does not depend on the origin.
  std::optional<double> volume;
  std::vector<MeshComponent> largest;  ///< Up to 20 components of the most triangles.
};

/// Settings of check_mesh().
struct MeshCheckOptions {
  /// The volume a surface was extracted from: odd_interior_edges is counted.
  const zmc::VolumeView* volume = nullptr;
};

/// Counts everything in MeshCheck.
///
/// Both ends of a border edge are in one border plane of the volume, to within 2⁻²⁶ of a spacing or
/// the rounding of world coordinates. Surface vertices off the plane are farther away: crossings by
/// 2⁻²⁰, centroids of up to 12 of them by 2⁻²⁰ / 12. Zero area: |(b − a) × (c − a)| ≤ 16 ε (longest
/// side)², below which the product is rounding. Deterministic. O(n + m) for bounded vertex degrees;
/// 24 bytes a triangle and 20 a vertex of working memory with 32-bit ids, twice with 64-bit.
/// @pre  The ids are within [0, vertex_count) and the positions finite, as read_mesh() leaves them.
[[nodiscard]] MeshCheck check_mesh(const MeshView& mesh, const MeshCheckOptions& options = {});

/// Vertices whose position, rounded to float, an earlier vertex has too (the STL format rounds so).
[[nodiscard]] std::int64_t coincident_as_float(const MeshView& mesh);

}  // namespace shape3d::apps
