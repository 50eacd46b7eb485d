#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "color_map.hpp"
#include "mesh.hpp"
#include "shape_library.hpp"
#include "shape_search.hpp"

namespace shape3d::apps {

/// What is looked for in a shape library.
struct Query {
  std::string name;                       ///< As the user named it: a path, or the id in digits.
  std::optional<LibraryModel> model;      ///< Where the query is in the library.
  std::optional<std::string> class_name;  ///< Of the query, when it is known.
  std::optional<Mesh> mesh;               ///< Empty for a model that is named by its id.
};

struct Found {
  Match match;
  LibraryModel model;
};

/// A model of the library. @throws FileError  there is none of this id.
[[nodiscard]] Query query_of_id(const ShapeLibrary& library, std::int64_t id);

/// A mesh file. When the library holds it, by its content, the model and its class are known, too.
/// @param warnings  What the reader remarks is added.
/// @throws FileError  it cannot be read, or its extension is of no mesh.
[[nodiscard]] Query query_of_mesh(const ShapeLibrary& library, const std::string& path,
                                  std::vector<std::string>& warnings);

/// The query's vector: that of the library, else computed.
/// @param spec  A descriptor of the library, canonical.
/// @throws FileError  the mesh cannot be described; the library has no vector of the model.
[[nodiscard]] Eigen::VectorXd vector_of(const ShapeLibrary& library, const Query& query,
                                        const std::string& spec, int threads);

/// Ids that a search passes over: the query's own.
[[nodiscard]] std::vector<std::int64_t> left_out(const Query& query);

/// Matches by the class-weighted distance (5.19), whose probabilities are the shares of classes
/// among the nearest models; what the query's class is said to be is not looked at.
struct WeightedMatches {
  std::vector<Match> matches;
  /// Classes of positive probability, the most probable first.
  std::vector<std::pair<std::string, double>> classes;
};

/// @param library_path  For messages.
/// @throws FileError  no model of the library has a class.
[[nodiscard]] WeightedMatches weighted_matches(const SearchSet& set, const Query& query,
                                               const Eigen::VectorXd& vector, std::size_t count,
                                               const std::string& library_path, int threads);

/// What a match is to the query.
enum class MatchKind { same_class, other_class, unknown };
[[nodiscard]] MatchKind match_kind(const Query& query, const LibraryModel& model);

/// Colors of frames as in Fig. 5.10: of the query, of models of its class, of other ones, and where
/// a class is not known.
inline constexpr Color kQueryFrame{0.10, 0.62, 0.22}, kSameClassFrame{0.13, 0.36, 0.86},
    kOtherClassFrame{0.85, 0.16, 0.14}, kUnknownFrame{0.62, 0.62, 0.62};
[[nodiscard]] Color frame_color(MatchKind kind);

}  // namespace shape3d::apps
