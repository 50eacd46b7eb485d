#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "shape3d/zmc/options.hpp"
#include "zero_regions.hpp"

namespace shape3d::zmc::detail {

/// A cell face that becomes part of the surface: the lower face of cell (i, j, k) along `axis`.
struct InsertedFace {
  std::int64_t i = 0;
  std::int32_t j = 0;
  std::int8_t axis = 0;
  bool closing = false;       ///< A triangle in a face of case 11, not a quad.
  bool towards_upper = true;  ///< The normal points along +axis.
};

/// Lower face of a cell along an axis in the numbering of kCellFaces.
constexpr int lower_face(int axis) { return 2 * axis; }

/// Whether the lower face of cell (i, j, k) along an axis becomes part of the surface: its two
/// cells see different signs or, with ZeroFaces::mating, it is a zero face beside a cell that is
/// not all zero.
/// @param closing  The face is of case 11; otherwise it is of case 12.
std::optional<InsertedFace> inserted_face(const LatticeCells& cells, const ZeroRegions& regions,
                                          ZeroFaces rule, std::int64_t i, std::int64_t j,
                                          std::int64_t k, int axis, bool closing);

/// Appends the inserted lower faces of the cells of layer k. Quads and closing triangles go to
/// their own lists; both are ordered by j, i, axis.
void find_inserted_faces(const LatticeCells& cells, const ZeroRegions& regions, ZeroFaces rule,
                         std::int64_t k, std::vector<InsertedFace>& quads,
                         std::vector<InsertedFace>& closing);

/// Surface vertices (as in CellPatches, seen from the cell above the face) of the triangles of an
/// inserted face: three of a closing triangle, or the four corners of a quad in cyclic order from
/// the lowest, counter-clockwise seen from the side that the normal points to.
struct FacePolygon {
  int size = 0;
  std::array<int, 4> vertices{};
};
FacePolygon face_polygon(const SignLattice& lattice, const InsertedFace& face, std::int64_t k);

}  // namespace shape3d::zmc::detail
