#pragma once

#include <string>
#include <vector>

#include "common/library_query.hpp"

namespace shape3d::apps {

/// The picture of Fig. 5.10: the query in a green frame, then what was found, in blue frames where
/// it is of the query's class, red where it is of another, grey where that is not known.
/// @return PNG bytes. @throws PictureError
[[nodiscard]] std::string draw_sheet(const ShapeLibrary& library, const Query& query,
                                     const std::vector<Found>& found);

}  // namespace shape3d::apps
