#pragma once

#include <string>

namespace shape3d::apps {

/// The case Q of Marching Cubes and every case with zeros that becomes it when zeros are taken as
/// positive (Fig. 2.15 of the dissertation), one cell each, in the order of the number of zeros.
/// @return PNG bytes. @throws PictureError
[[nodiscard]] std::string draw_preimage_sheet(int Q);

/// The configurations of cell faces up to symmetry: single faces without a zero edge, pairs of
/// faces at a zero edge, cells with a zero face, and the two faces that are inserted between cells
/// (Fig. 2.7, 2.10, 2.11 and 2.12). All are found by enumeration.
/// @return PNG bytes. @throws PictureError
[[nodiscard]] std::string draw_face_sheet();

}  // namespace shape3d::apps
