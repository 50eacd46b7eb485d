#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/nearest_neighbours.hpp"

namespace shape3d::learning {

struct ApproximateNeighboursOptions {
  int links = 16;           ///< Of an item to others, 2 … 128 (M of the paper).
  int build_effort = 200;   ///< Candidates looked at when an item is added, links … 10000.
  int search_effort = 100;  ///< Candidates of a query, 1 … 100000; at least k are taken.
  unsigned seed = 1;        ///< Of the levels of items.
};

/// Nearest neighbours by Euclidean distance, nearly all of them, from a graph of small worlds
/// (Malkov and Yashunin 2018), by hnswlib. For libraries beyond 10⁵ items.
class SHAPE3D_LEARNING_EXPORT ApproximateNeighbours {
 public:
  /// Items are added one by one, in their order: the graph depends on X and the options alone.
  /// @param X  n by d; kept in single precision.
  /// @throws std::invalid_argument  an option is out of range; a number is not finite, or above
  /// 1e15 in magnitude. O(n log n), about 0.1 ms an item. Memory: 4 d + 8 links + 60 bytes an item.
  explicit ApproximateNeighbours(const FeaturesView& X,
                                 const ApproximateNeighboursOptions& options = {});
  ~ApproximateNeighbours();
  ApproximateNeighbours(ApproximateNeighbours&&) noexcept;
  ApproximateNeighbours& operator=(ApproximateNeighbours&&) noexcept;

  [[nodiscard]] Eigen::Index size() const;       ///< n.
  [[nodiscard]] Eigen::Index dimension() const;  ///< d.
  [[nodiscard]] const ApproximateNeighboursOptions& options() const;

  /// @param effort  Instead of options().search_effort; 0: that.
  /// @param threads  0: all processors; no matter for the result.
  /// @return distances of single precision; rows of equal distance in the order of the library. A
  /// query that finds fewer than k items has rows −1 and infinite distances at the end.
  /// @throws std::invalid_argument  as ExactNeighbours::query(); effort is out of range.
  /// May be called concurrently.
  [[nodiscard]] Neighbours query(const FeaturesView& Q, Eigen::Index k, int effort = 0,
                                 int threads = 0) const;

  /// The graph with its vectors, with version and check sum, little endian.
  [[nodiscard]] std::string serialize() const;
  /// @throws std::invalid_argument  the bytes are not of such a graph, of another version, or
  /// damaged. No bytes make query() read outside of memory.
  [[nodiscard]] static ApproximateNeighbours deserialize(std::string_view bytes);

 private:
  struct State;
  explicit ApproximateNeighbours(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// The share of the exact neighbours that are among those found, a mean over the queries; 1 when
/// there are none.
/// @throws std::invalid_argument  the numbers of queries differ.
[[nodiscard]] SHAPE3D_LEARNING_EXPORT double recall(const Neighbours& exact,
                                                    const Neighbours& found);

}  // namespace shape3d::learning
