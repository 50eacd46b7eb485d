#pragma once

#include <set>
#include <string>
#include <vector>

#include "cell_drawing.hpp"

namespace shape3d::apps {

/// A configuration of faces in one cell.
struct FaceConfiguration {
  Samples samples{};         ///< A representative cell.
  std::string name;          ///< The cases of its faces.
  std::set<Edge> decided;    ///< Patch edges in these faces, whatever the other samples.
  std::set<Edge> undecided;  ///< Those that are there for some of the other samples only.
};

/// Faces −z (cell vertices 0 … 3) of the cases without zero edges, up to symmetry and sign: one
/// entry for each set of patch edges that magnitudes 1, 2, 3 bring about.
[[nodiscard]] std::vector<FaceConfiguration> single_faces();

/// Faces −z and −y at the zero edge 0–1, neither of them of case 12, up to symmetry and sign. The
/// other samples are those of cell vertices 6 and 7.
[[nodiscard]] std::vector<FaceConfiguration> faces_at_zero_edge();

/// Cells whose face −z is of case 12, up to symmetry and sign: one entry for all without a patch
/// edge, and one for each set of patch edges of the others.
[[nodiscard]] std::vector<FaceConfiguration> cells_at_zero_face();

}  // namespace shape3d::apps
