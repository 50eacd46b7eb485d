#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shape3d/learning/nearest_neighbours.hpp>

#include "shape_library.hpp"

namespace shape3d::apps {

/// A model and its distance from the query.
struct Match {
  std::int64_t id = 0;
  double distance = 0.0;
};

/// The vectors of one descriptor, ready to be searched.
class SearchSet {
 public:
  /// Takes vectors.vectors out, and keeps the rest as it is.
  explicit SearchSet(LibraryVectors vectors, learning::Norm norm = learning::Norm::L2);

  [[nodiscard]] const std::string& spec() const { return head_.spec; }
  [[nodiscard]] const std::vector<std::int64_t>& ids() const { return head_.ids; }
  [[nodiscard]] const std::vector<std::string>& classes() const { return head_.classes; }
  [[nodiscard]] const std::vector<std::int32_t>& labels() const { return head_.labels; }
  [[nodiscard]] const learning::Features& vectors() const { return neighbours_.vectors(); }
  [[nodiscard]] const learning::ExactNeighbours& neighbours() const { return neighbours_; }

  /// The `count` models of the smallest distances, or all when there are fewer; those of equal
  /// distance by their ids.
  /// @param without  Models that are passed over.
  /// @throws std::invalid_argument  the vector is of another length, or not finite; count < 1.
  [[nodiscard]] std::vector<Match> nearest(const Eigen::VectorXd& vector, std::size_t count,
                                           const std::vector<std::int64_t>& without = {},
                                           int threads = 0) const;

 private:
  LibraryVectors head_;  // without vectors
  learning::ExactNeighbours neighbours_;
};

}  // namespace shape3d::apps
