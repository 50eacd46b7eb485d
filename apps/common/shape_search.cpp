#include "shape_search.hpp"

#include <algorithm>
#include <utility>

namespace shape3d::apps {

SearchSet::SearchSet(LibraryVectors vectors, learning::Norm norm)
    : head_(std::move(vectors)), neighbours_(std::move(head_.vectors), norm) {}

std::vector<Match> SearchSet::nearest(const Eigen::VectorXd& vector, std::size_t count,
                                      const std::vector<std::int64_t>& without, int threads) const {
  const learning::Neighbours found = neighbours_.query(
      vector.transpose(), static_cast<Eigen::Index>(count + (count > 0 ? without.size() : 0)),
      threads);
  std::vector<Match> matches;
  for (Eigen::Index i = 0; i < found.rows.cols() && matches.size() < count; ++i) {
    const std::int64_t id = head_.ids[static_cast<std::size_t>(found.rows(0, i))];
    if (std::find(without.begin(), without.end(), id) != without.end()) continue;
    matches.push_back({id, found.distances(0, i)});
  }
  return matches;
}

}  // namespace shape3d::apps
