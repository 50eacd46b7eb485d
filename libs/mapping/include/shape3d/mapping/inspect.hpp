#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shape3d/mapping/export.hpp"
#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

/// What can be wrong with a mesh that is to be a closed surface.
enum class Defect {
  too_few_triangles,    ///< Fewer than 4: nothing closed.
  index_out_of_range,   ///< A triangle names a vertex that is not there.
  not_finite,           ///< A coordinate is NaN or infinite.
  zero_extent,          ///< The total area is zero.
  degenerate_triangle,  ///< Names a vertex twice.
  duplicate_triangle,   ///< Has the three vertices of an earlier one.
  isolated_vertex,      ///< Is in no triangle.
  nonmanifold_edge,     ///< Is in more than two triangles.
  nonmanifold_vertex,   ///< Joins more than one fan of triangles.
  boundary_loop,        ///< A closed chain of edges of one triangle.
  misoriented_edge,     ///< Its two triangles run along it in one direction.
  not_orientable,       ///< No way to turn the triangles makes all edges agree (Möbius strip).
  several_components,   ///< More than one piece.
  handle,               ///< A hole through the body: genus above 0.
  inside_out,           ///< Triangles run clockwise seen from outside: the volume is negative.
  zero_area_triangle,   ///< Three vertices on a line, to rounding.
  self_intersection     ///< Two triangles cut through each other.
};

/// One word or two: "boundary loop".
[[nodiscard]] SHAPE3D_MAPPING_EXPORT std::string_view to_string(Defect defect);

/// What may help.
enum class Remedy { none, repair, wrap };

/// A defect, how often it occurs, and what to do.
struct Finding {
  Defect defect = Defect::too_few_triangles;
  std::int64_t count = 0;
  bool blocking = true;  ///< The mesh cannot be mapped to a sphere as it is.
  std::string sentence;  ///< "3 boundary loops of 223 edges in all: the surface is open".
  Remedy remedy = Remedy::none;
  std::string advice;  ///< What the remedy does: "fills the holes"; without one, what to do.
};

/// What a mesh is. A triangle that is degenerate, a duplicate or has an index out of range is
/// counted there and nowhere else. Edges are pairs of vertices, whatever their positions.
struct Inspection {
  std::int64_t vertices = 0, triangles = 0;  ///< Rows of V and F.
  std::int64_t edges = 0;
  std::int64_t components = 0;         ///< Pieces; those that touch in a vertex are one.
  std::int64_t largest_component = 0;  ///< Triangles of the piece that has most.
  std::int64_t boundary_edges = 0, boundary_loops = 0;
  std::int64_t nonmanifold_edges = 0, nonmanifold_vertices = 0;
  std::int64_t misoriented_edges = 0;
  bool orientable = true;  ///< The triangles can be turned so that no edge is misoriented.
  std::int64_t euler = 0;  ///< Used vertices − edges + triangles.
  /// Of the surface with its boundary loops filled, summed over the components:
  /// (2 · components − loops − χ) / 2; for orientable manifolds.
  std::optional<std::int64_t> genus;
  std::int64_t isolated_vertices = 0, not_finite_vertices = 0;
  std::int64_t degenerate_triangles = 0, duplicate_triangles = 0, zero_area_triangles = 0;
  std::int64_t out_of_range_triangles = 0;
  double area = 0.0;
  /// Σ a · (b × c) / 6; for closed meshes without misoriented edges.
  std::optional<double> volume;
  std::optional<std::int64_t> self_intersections;  ///< Pairs of triangles; when asked for.

  std::vector<Finding> findings;  ///< All defects, in the order of Defect.

  [[nodiscard]] bool closed() const { return triangles > 0 && boundary_edges == 0; }
  /// spherical_map() takes the mesh: a closed, oriented, connected manifold of genus 0, without
  /// isolated vertices and of finite coordinates; no finding is blocking.
  [[nodiscard]] bool spherical() const;
  /// The blocking findings in one line, each with its advice, divided by "; "; empty when there is
  /// none. `repair` and `wrap` are how the caller names these remedies: "--repair", "repair()".
  [[nodiscard]] std::string why_not_spherical(std::string_view repair = "repair()",
                                              std::string_view wrap = "wrap()") const;
};

/// "3 boundary loops of 223 edges in all: the surface is open; --repair fills the holes".
[[nodiscard]] SHAPE3D_MAPPING_EXPORT std::string to_sentence(const Finding& finding,
                                                             std::string_view repair,
                                                             std::string_view wrap);

/// Settings of inspect().
struct InspectOptions {
  bool self_intersections = false;  ///< Count them too (CGAL), where no index is out of range.
};

/// Counts everything in Inspection. Any matrices are accepted: what is wrong is a finding.
///
/// Zero area: |(b − a) × (c − a)| ≤ 16 ε (longest side)², below which the product is rounding.
/// O(#F log #F), about 0.1 s for 100k triangles. Deterministic.
[[nodiscard]] SHAPE3D_MAPPING_EXPORT Inspection inspect(const ConstPoints& V,
                                                        const ConstTriangles& F,
                                                        const InspectOptions& options = {});

/// Pairs of triangles that cut through each other or overlap beyond what they share (CGAL,
/// exact predicates). O(#F log #F) for meshes that do not pile up.
/// @throws std::invalid_argument  a coordinate is not finite or an index is out of range.
[[nodiscard]] SHAPE3D_MAPPING_EXPORT std::int64_t count_self_intersections(const ConstPoints& V,
                                                                           const ConstTriangles& F);

}  // namespace shape3d::mapping
