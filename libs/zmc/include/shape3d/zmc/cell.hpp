#pragma once

#include <array>
#include <vector>

#include "shape3d/zmc/export.hpp"
#include "shape3d/zmc/options.hpp"

namespace shape3d::zmc {

/// Cell vertices in Lorensen's order: 0=(0,0,0) 1=(1,0,0) 2=(1,1,0) 3=(0,1,0), 4…7 the same at z
/// = 1.
inline constexpr std::array<std::array<int, 3>, 8> kCellVertices{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// Cell edges: 0–3 round z = 0, 4–7 round z = 1, 8–11 along z.
inline constexpr std::array<std::array<int, 2>, 12> kCellEdges{{{0, 1},
                                                                {1, 2},
                                                                {2, 3},
                                                                {3, 0},
                                                                {4, 5},
                                                                {5, 6},
                                                                {6, 7},
                                                                {7, 4},
                                                                {0, 4},
                                                                {1, 5},
                                                                {2, 6},
                                                                {3, 7}}};

/// Cell faces −x, +x, −y, +y, −z, +z: their cell vertices, counter-clockwise seen from outside the
/// cell.
inline constexpr std::array<std::array<int, 4>, 6> kCellFaces{
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

/// A surface vertex of a cell: 0…11 the crossing on that cell edge, 12 + v the zero cell vertex v.
using CellSurfaceVertex = int;

/// A patch edge and the cell face it lies in (a zero edge lies in two; the lower number is given).
struct PatchEdge {
  CellSurfaceVertex from = 0,
                    to = 0;  ///< Seen from outside the cell, the positive side is on the left.
  int face = 0;
};

/// What Zero-crossing Marching Cubes makes of one cell.
struct CellPatches {
  int case_index = 0;  ///< P = Σ 3^v p_v; p = 0, 1, 2 for zero, positive, negative (section 2.5.1).
  std::array<int, 6> face_case{};  ///< 1 … 13 (Fig. 2.6).
  /// Sign of the region of this cell at a zero face (case 12) or at the closing triangle of a
  /// case-11 face: −1 or +1; 0 for faces of other cases and for the cell of eight zeros.
  std::array<int, 6> zero_face_sign{};
  int resolution =
      0;  ///< R = Σ 2^f r_f; r_f = 1 where face f is ambiguous and the positive side prevails.
  std::vector<PatchEdge> patch_edges;
  std::vector<std::vector<CellSurfaceVertex>>
      patches;  ///< Polygons, counter-clockwise seen from the positive side.
  /// The triangles extract() makes of the patches. Ids from 20 on are the centroids in `centroids`.
  std::vector<std::array<CellSurfaceVertex, 3>> triangles;
  std::vector<std::vector<CellSurfaceVertex>> centroids;  ///< The vertices averaged by id 20, 21 …
};

/// Patches of a single cell by the rules of sections 2.3.1 to 2.3.3 and appendix A.
///
/// @param samples  Sample minus isovalue at the eight cell vertices; negative is inside.
/// @throws std::invalid_argument  a sample is not finite.
[[nodiscard]] SHAPE3D_ZMC_EXPORT CellPatches
cell_patches(const std::array<double, 8>& samples, TieRule ties = TieRule::neutral,
             Triangulation triangulation = Triangulation::compact);

}  // namespace shape3d::zmc
