#include "shape_search.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
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

learning::Neighbours SearchSet::all(const Eigen::VectorXd& vector, int threads) const {
  return neighbours_.query(vector.transpose(),
                           std::max<Eigen::Index>(1, neighbours_.vectors().rows()), threads);
}

std::vector<double> SearchSet::class_probabilities(const Eigen::VectorXd& vector,
                                                   const std::vector<std::int64_t>& without,
                                                   std::size_t count, int threads) const {
  if (count < 1) throw std::invalid_argument("count is 0, expected 1 or more");
  const learning::Neighbours found = all(vector, threads);
  std::vector<double> shares(head_.classes.size(), 0.0);
  std::size_t seen = 0;
  for (Eigen::Index i = 0; i < found.rows.cols() && seen < count; ++i) {
    const auto row = static_cast<std::size_t>(found.rows(0, i));
    const std::int32_t label = head_.labels[row];
    if (label < 0 || std::find(without.begin(), without.end(), head_.ids[row]) != without.end()) {
      continue;
    }
    shares[static_cast<std::size_t>(label)] += 1.0;
    ++seen;
  }
  for (double& share : shares) share /= std::max<double>(1.0, static_cast<double>(seen));
  return shares;
}

std::vector<Match> SearchSet::nearest_weighted(const Eigen::VectorXd& vector, std::size_t count,
                                               const std::vector<double>& probabilities,
                                               const std::vector<std::int64_t>& without,
                                               double same, double other, int threads) const {
  if (count < 1) throw std::invalid_argument("count is 0, expected 1 or more");
  if (!(same > 0.0 && same <= other)) {
    throw std::invalid_argument("the weights are " + std::to_string(same) + " and " +
                                std::to_string(other) + ", expected 0 < same ≤ other");
  }
  if (probabilities.size() != head_.classes.size()) {
    throw std::invalid_argument("there are " + std::to_string(probabilities.size()) +
                                " probabilities, expected one for each of " +
                                std::to_string(head_.classes.size()) + " classes");
  }
  for (const double p : probabilities) {
    if (!(p >= 0.0 && p <= 1.0)) {
      throw std::invalid_argument("a probability is " + std::to_string(p) + ", expected 0 … 1");
    }
  }
  const learning::Neighbours found = all(vector, threads);
  std::vector<Match> matches;
  for (Eigen::Index i = 0; i < found.rows.cols(); ++i) {
    const auto row = static_cast<std::size_t>(found.rows(0, i));
    if (std::find(without.begin(), without.end(), head_.ids[row]) != without.end()) continue;
    const std::int32_t label = head_.labels[row];
    const double p = label < 0 ? 0.0 : probabilities[static_cast<std::size_t>(label)];
    const double weight = other + (same - other) * p;
    matches.push_back({head_.ids[row], weight * found.distances(0, i) * found.distances(0, i)});
  }
  std::stable_sort(matches.begin(), matches.end(), [](const Match& a, const Match& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.id < b.id);
  });
  if (matches.size() > count) matches.resize(count);
  return matches;
}

}  // namespace shape3d::apps
