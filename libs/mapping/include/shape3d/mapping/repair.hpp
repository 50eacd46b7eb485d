#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "shape3d/mapping/export.hpp"
#include "shape3d/mapping/inspect.hpp"
#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

/// Settings of repair(): which steps are taken.
struct RepairOptions {
  bool keep_largest = true;  ///< Removes all components but that of the most triangles.
  bool fill_holes = true;    ///< Fills every boundary loop with triangles.
  /// Called between steps with the share done, 0 … 1; false cancels.
  std::function<bool(double)> progress;
};

/// What repair() changed.
struct RepairSummary {
  std::int64_t merged_vertices = 0;     ///< Vertices at the position of another one.
  std::int64_t removed_vertices = 0;    ///< In no triangle.
  std::int64_t removed_degenerate = 0;  ///< Triangles that named a vertex twice.
  std::int64_t removed_duplicates = 0;  ///< Triangles of the vertices of another one.
  std::int64_t separated_vertices = 0;  ///< Copies made to part sheets at non-manifold places.
  std::int64_t turned_triangles = 0;    ///< Oriented anew, so that neighbours agree.
  std::int64_t removed_components = 0;
  std::int64_t removed_component_triangles = 0;
  std::int64_t filled_holes = 0;
  std::int64_t unfilled_holes = 0;  ///< Loops that no triangulation was found for.
  std::int64_t filling_triangles = 0;
  bool turned_inside_out = false;  ///< All triangles were turned, so that the volume is positive.
};

/// Outcome of repair().
struct Repaired {
  Points V;  ///< Kept vertices have their positions to the bit.
  Triangles F;
  RepairSummary summary;
  Inspection after;        ///< Of V and F; what is still wrong are its findings.
  bool cancelled = false;  ///< V and F are empty.
};

/// Makes a closed, oriented manifold of triangles that nearly are one (CGAL's polygon mesh
/// processing): merges vertices of equal position; removes isolated vertices, degenerate and
/// duplicate triangles; orients neighbours alike and parts sheets where more than two meet;
/// stitches boundaries that coincide; keeps the largest component; fills the holes with triangles
/// between their boundary vertices; turns the surface so that its volume is positive.
///
/// It does not remove handles and does not undo self-intersections: see wrap().
///
/// @param V  #V by 3, finite.
/// @param F  #F by 3 rows of V, any.
/// @return   A mesh and what was done; whether it can be mapped now says after.spherical().
/// @throws std::invalid_argument  a coordinate is not finite; an index is out of range; there is no
/// triangle of three different vertices.
///
/// Deterministic. About 1 s for 100k triangles; filling a loop of n edges is O(n²) typically.
[[nodiscard]] SHAPE3D_MAPPING_EXPORT Repaired repair(const ConstPoints& V, const ConstTriangles& F,
                                                     const RepairOptions& options = {});

/// "removed 3 duplicate triangles, filled 2 holes with 40 triangles"; "nothing had to be repaired".
[[nodiscard]] SHAPE3D_MAPPING_EXPORT std::string to_sentence(const RepairSummary& summary);

}  // namespace shape3d::mapping
