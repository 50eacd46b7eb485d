#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/mesh.hpp"
#include "common/shape_library.hpp"
#include "common/shape_search.hpp"

namespace shape3d::apps {

/// What is looked for.
struct Query {
  std::string name;                       ///< As the command line names it.
  std::optional<LibraryModel> model;      ///< Where the query is in the library.
  std::optional<std::string> class_name;  ///< Of the query, when it is known.
  std::optional<Mesh> mesh;               ///< Empty for a model that is named by its id.
};

struct Found {
  Match match;
  LibraryModel model;
};

/// The picture of Fig. 5.10: the query in a green frame, then what was found, in blue frames where
/// it is of the query's class, red where it is of another, grey where that is not known.
/// @return PNG bytes. @throws PictureError
[[nodiscard]] std::string draw_sheet(const ShapeLibrary& library, const Query& query,
                                     const std::vector<Found>& found);

}  // namespace shape3d::apps
