#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"

namespace shape3d::learning {

/// Norm of the difference of two vectors: Σ |x_i − y_i|, or √Σ (x_i − y_i)².
enum class Norm { L1, L2 };

/// The k nearest items of each query, a row for each query.
struct Neighbours {
  using Rows = Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Rows rows;           ///< #Q by k, places in the library, by ascending distance.
  Features distances;  ///< #Q by k.
};

/// Exact nearest neighbours among n vectors.
///
/// All distances are first had in single precision from a product of matrices, block by block:
/// |x − q|² = |x|² + |q|² − 2 x·q, of coordinates about the mean. Those that may be among the k
/// smallest, by a bound on the error, are computed anew in double precision. The result is that of
/// computing all in double precision, bit for bit, for any number of threads; items of equal
/// distance are in the order of the library.
class SHAPE3D_LEARNING_EXPORT ExactNeighbours {
 public:
  /// @param X  n by d, n ≥ 0.
  /// @throws std::invalid_argument  a number is not finite.
  /// O(n d); keeps X, and half its memory again.
  explicit ExactNeighbours(Features X, Norm norm = Norm::L2);
  ~ExactNeighbours();
  ExactNeighbours(ExactNeighbours&&) noexcept;
  ExactNeighbours& operator=(ExactNeighbours&&) noexcept;

  [[nodiscard]] const Features& vectors() const;

  /// @param Q  Queries, #Q by d. @param k  ≥ 1; of n items there are at most n neighbours.
  /// @param threads  0: all processors; no matter for the result.
  /// @throws std::invalid_argument  Q has not d columns, or a number that is not finite; k < 1;
  /// threads < 0.
  /// O(#Q n d). May be called concurrently.
  [[nodiscard]] Neighbours query(const FeaturesView& Q, Eigen::Index k, int threads = 0) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace shape3d::learning
