#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/library_query.hpp"

namespace shape3d::apps::viewer {

/// How matches are ranked.
enum class Ranking { l2, l1, weighted };

/// By its name in sessions, "L2", "L1" or "weighted"; empty for another word.
[[nodiscard]] std::optional<Ranking> ranking_named(std::string_view name);
[[nodiscard]] std::string_view to_string(Ranking ranking);

/// What is looked for, and how.
struct SearchWish {
  std::int64_t id = 0;     ///< A model of the library; 0: the query is `path`.
  std::string path;        ///< A mesh file.
  std::string descriptor;  ///< "": the first one of the library.
  Ranking ranking = Ranking::l2;
  int count = 30;

  [[nodiscard]] bool has_query() const { return id > 0 || !path.empty(); }
  friend bool operator==(const SearchWish& a, const SearchWish& b) {
    return a.id == b.id && a.path == b.path && a.descriptor == b.descriptor &&
           a.ranking == b.ranking && a.count == b.count;
  }
};

struct SearchResult {
  SearchWish wish;
  Query query;
  std::string spec;                                     ///< Canonical.
  std::int64_t models = 0;                              ///< That have a vector of it.
  std::vector<Found> found;                             ///< By distance.
  std::vector<std::pair<std::string, double>> classes;  ///< Of weighted_matches().
  std::vector<std::string> warnings;                    ///< Of the reader of the query.
  double seconds = 0.0;
  std::string error;  ///< A sentence; empty: none.
};

/// Searches a library for models like a query; keeps the vectors for the next time. For one thread.
class LibrarySearch {
 public:
  /// @throws FileError  as ShapeLibrary.
  explicit LibrarySearch(const std::string& path);
  ~LibrarySearch();

  /// Does not throw: errors stand in the result.
  [[nodiscard]] SearchResult search(const SearchWish& wish);

 private:
  const SearchSet& set_of(const std::string& spec, learning::Norm norm);

  ShapeLibrary library_;
  std::unique_ptr<SearchSet> set_;
  learning::Norm norm_ = learning::Norm::L2;
  std::int64_t generation_ = -1;
};

}  // namespace shape3d::apps::viewer
