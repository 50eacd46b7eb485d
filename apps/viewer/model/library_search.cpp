#include "library_search.hpp"

#include <array>
#include <chrono>
#include <exception>
#include <new>

namespace shape3d::apps::viewer {
namespace {

constexpr std::array<std::pair<Ranking, std::string_view>, 3> kRankings{
    {{Ranking::l2, "L2"}, {Ranking::l1, "L1"}, {Ranking::weighted, "weighted"}}};

}  // namespace

std::optional<Ranking> ranking_named(std::string_view name) {
  for (const auto& [ranking, known] : kRankings) {
    if (known == name) return ranking;
  }
  return std::nullopt;
}

std::string_view to_string(Ranking ranking) {
  return kRankings[static_cast<std::size_t>(ranking)].second;
}

LibrarySearch::LibrarySearch(const std::string& path)
    : library_(path, ShapeLibrary::Access::read) {}

LibrarySearch::~LibrarySearch() = default;

const SearchSet& LibrarySearch::set_of(const std::string& spec, learning::Norm norm) {
  const std::int64_t generation = library_.generation();
  if (!set_ || set_->spec() != spec || norm_ != norm || generation_ != generation) {
    set_ = std::make_unique<SearchSet>(library_.vectors(spec), norm);
    norm_ = norm;
    generation_ = generation;
  }
  return *set_;
}

SearchResult LibrarySearch::search(const SearchWish& wish) {
  const auto begin = std::chrono::steady_clock::now();
  SearchResult result;
  result.wish = wish;
  try {
    result.query = wish.id > 0 ? query_of_id(library_, wish.id)
                               : query_of_mesh(library_, wish.path, result.warnings);
    result.spec = library_.descriptor(wish.descriptor).spec;
    const Eigen::VectorXd vector = vector_of(library_, result.query, result.spec, 0);
    const learning::Norm norm =
        wish.ranking == Ranking::l1 ? learning::Norm::L1 : learning::Norm::L2;
    const SearchSet& set = set_of(result.spec, norm);
    result.models = static_cast<std::int64_t>(set.ids().size());
    const auto count = static_cast<std::size_t>(wish.count);
    std::vector<Match> matches;
    if (wish.ranking == Ranking::weighted) {
      WeightedMatches weighted =
          weighted_matches(set, result.query, vector, count, library_.path(), 0);
      matches = std::move(weighted.matches);
      result.classes = std::move(weighted.classes);
    } else {
      matches = set.nearest(vector, count, left_out(result.query));
    }
    for (const Match& match : matches) {
      // Unless it was removed meanwhile.
      if (std::optional<LibraryModel> model = library_.model(match.id))
        result.found.push_back({match, std::move(*model)});
    }
  } catch (const std::bad_alloc&) {
    result.error = library_.path() + ": there is not enough memory to search it";
  } catch (const std::exception& error) {
    result.error = error.what();
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace shape3d::apps::viewer
