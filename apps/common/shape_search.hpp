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

  /// How probable each class of classes() is for a vector: its shares among the `count` nearest
  /// models whose class is known. Zeros when there is none.
  /// @throws as nearest().
  [[nodiscard]] std::vector<double> class_probabilities(
      const Eigen::VectorXd& vector, const std::vector<std::int64_t>& without = {},
      std::size_t count = 10, int threads = 0) const;

  /// By the class-weighted distance (5.19): W D², D the distance of nearest(), W = other + (same −
  /// other) P, P how probable the model's class is for the query; `other` where it is not known.
  /// @param probabilities  One for each of classes(), of the query.
  /// @throws std::invalid_argument  as nearest(); there is another number of probabilities, or one
  /// is outside 0 … 1; not 0 < same ≤ other.
  [[nodiscard]] std::vector<Match> nearest_weighted(const Eigen::VectorXd& vector,
                                                    std::size_t count,
                                                    const std::vector<double>& probabilities,
                                                    const std::vector<std::int64_t>& without = {},
                                                    double same = 0.25, double other = 1.0,
                                                    int threads = 0) const;

 private:
  // All models by distance, as rows of vectors().
  [[nodiscard]] learning::Neighbours all(const Eigen::VectorXd& vector, int threads) const;

  LibraryVectors head_;  // without vectors
  learning::ExactNeighbours neighbours_;
};

}  // namespace shape3d::apps
