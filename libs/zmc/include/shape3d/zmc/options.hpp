#pragma once

#include <cstdint>
#include <functional>

namespace shape3d::zmc {

/// Which side of the isovalue is the inside. Triangle normals point from inside to outside.
enum class Inside {
  below,  ///< Samples under the isovalue: level-set functions ψ, distance fields.
  above  ///< Samples over the isovalue: CT, label maps. Equals extraction from the negated samples.
};

/// How equal products are ordered when an ambiguous face compares the positive with the negative.
enum class TieRule {
  neutral,  ///< By the lattice: the product holding the cell vertex first in (z, y, x) order counts
            ///< as the larger. extract(−f) is then extract(f) reversed, exactly.
  positive  ///< The dissertation's (2.3.2): positive wins when no less than negative.
};

/// How a patch of more than three vertices becomes triangles.
enum class Triangulation {
  compact,  ///< Diagonals only, none in a cell face; a patch that admits none such falls back to
            ///< centroid.
  centroid  ///< The average of the vertices as a common vertex (2.3.3 of the dissertation).
};

/// Which cell faces of four zero samples become part of the surface.
enum class ZeroFaces {
  boundary,  ///< Those whose two cells see different signs (2.3.3): the surface is closed.
  mating  ///< Also those between equal signs (2.4), so that the common face of two touching parts
          ///< survives; a face between two all-zero cells of equal sign lies within a block of
          ///< zeros and is not one.
};

/// What a NaN or infinite sample means.
enum class NonFinite {
  error,  ///< std::invalid_argument naming the first one.
  mask    ///< Cells touching one are skipped and counted in Counts::masked_cells.
};

/// What happens where the surface reaches the border of the volume.
enum class Border {
  open,   ///< It ends there.
  capped  ///< It is closed as if the volume were surrounded by samples far outside: the cap lies at
          ///< the border samples, 2⁻²⁰ of a spacing outwards.
};

/// Settings of extract() and contour().
struct Options {
  Inside inside = Inside::below;
  TieRule ties = TieRule::neutral;
  Triangulation triangulation = Triangulation::compact;
  ZeroFaces zero_faces = ZeroFaces::boundary;
  NonFinite non_finite = NonFinite::error;
  Border border = Border::open;
  bool normals = false;            ///< Fill Surface::normals.
  bool gradients = false;          ///< Fill Surface::gradients.
  bool edges = false;              ///< Fill Surface::edges and Surface::edge_parameters.
  bool count_nonmanifold = false;  ///< Fill Counts::nonmanifold_edges: sorts the zero edges.
  int threads = 0;  ///< 0: all processors. The result is the same, byte for byte, for any number.
  /// Surfaces of more vertices are not generated: Status::too_many_vertices, with the counts filled
  /// in. 0: as many as the index type can number.
  std::int64_t max_vertices = 0;
  /// Called now and then from the calling thread with the share done, 0 … 1; false cancels.
  std::function<bool(double)> progress;
};

}  // namespace shape3d::zmc
