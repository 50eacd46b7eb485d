#pragma once

#include <array>
#include <vector>

/// Zero-crossing Marching Cubes of one cell, straight from the face rules: slow, without tables,
/// and independent of the library that it is there to check.
namespace shape3d::test::reference {

/// Cell vertex x + 2 y + 4 z; ascending numbers are the (z, y, x) order of the lattice.
using Corner = int;

/// Cell face 2 axis + side: -x +x -y +y -z +z.
using Face = int;

/// Who wins when two products are equal.
enum class Ties {
  neutral,      ///< The product that holds the corner first in (z, y, x) order.
  positive,     ///< The positive side.
  signless_13,  ///< As positive, but a face of case 13 asks f00 f11 > f01 f10 whatever the signs.
  separated_13  ///< As positive, but on a face of case 13 the negative side.
};

/// Surface vertex of a cell, 8 a + b: the crossing between the corners a < b, or with a = b that
/// corner itself, which is zero.
using LocalVertex = int;
[[nodiscard]] constexpr LocalVertex crossing(Corner a, Corner b) {
  return a < b ? 8 * a + b : 8 * b + a;
}
[[nodiscard]] constexpr LocalVertex zero_vertex(Corner a) { return 9 * a; }
[[nodiscard]] constexpr Corner first_corner(LocalVertex v) { return v / 8; }
[[nodiscard]] constexpr Corner second_corner(LocalVertex v) { return v % 8; }

/// Patch edge; seen from outside the cell the positive side is on its left.
struct LocalEdge {
  LocalVertex from = 0, to = 0;
  Face face = 0;  ///< Of the two faces of a zero edge, the lower.
};

/// A comparison that a face needed, for counting ambiguous cases.
enum class Prevails { not_asked, negative, positive };

struct CellSolution {
  std::array<int, 6> face_case{};  ///< 1 ... 13, Fig. 2.6.
  /// Sign of the region of the cell at a zero face; -1 for beta and +1 for gamma on a face of case
  /// 11; 0 for the other cases and for the cell of eight zeros.
  std::array<int, 6> region_sign{};
  std::array<Prevails, 6> prevails{};  ///< Outcome of the comparison of products on a face.
  std::vector<LocalEdge> edges;
};

/// Patch edges by sections 2.3.1 to 2.3.3 and appendix A.
/// @param samples  At corner x + 2 y + 4 z; finite; negative is inside.
/// @throws std::logic_error  the two pairs of opposite edges of a zero face see different signs.
[[nodiscard]] CellSolution solve_cell(const std::array<double, 8>& samples, Ties ties);

/// The patches: cycles of the patch edges, counter-clockwise seen from the positive side.
/// @throws std::logic_error  a vertex has not one edge in and one edge out.
[[nodiscard]] std::vector<std::vector<LocalVertex>> cycles(const std::vector<LocalEdge>& edges);

/// The four corners of a face, counter-clockwise seen from outside the cell.
[[nodiscard]] std::array<Corner, 4> corners_of(Face face);

/// Lorensen's number of a corner and back (2 and 3, 6 and 7 change places).
[[nodiscard]] constexpr int lorensen(Corner c) { return (c & 2) != 0 ? c ^ 1 : c; }

/// P = sum of 3^v p_v over Lorensen's vertices v; p = 0, 1, 2 for zero, positive, negative.
[[nodiscard]] int case_index(const std::array<double, 8>& samples);

}  // namespace shape3d::test::reference
