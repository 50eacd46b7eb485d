#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "shape3d/learning/export.hpp"
#include "shape3d/learning/features.hpp"

namespace shape3d::learning {

/// Recalls 1/20, 2/20 … 1 at which precision is given.
inline constexpr int kRecallSteps = 20;
/// Items on the first page, which the E-measure looks at.
inline constexpr int kFirstPage = 32;

/// Measures of one ranking, 0 … 1. G_i is 1 where the i-th item, from 1, is of the query's class;
/// R is the number of items of that class without the query.
struct RetrievalMeasures {
  double nearest_neighbour = 0.0;  ///< G_1.
  double first_tier = 0.0;         ///< Σ_{i ≤ R} G_i / R.
  double second_tier = 0.0;        ///< Σ_{i ≤ 2R} G_i / R.
  double e_measure = 0.0;  ///< 2 / (1/P + 1/Q), P = hits / 32, Q = hits / R, hits = Σ_{i ≤ 32} G_i.
  /// (G_1 + Σ_{i ≥ 2} G_i / log2 i) / (1 + Σ_{i=2}^R 1 / log2 i), over the whole ranking.
  double dcg = 0.0;
  double average_precision = 0.0;  ///< Mean over the hits of hits so far / i.
};

/// Measures of one query.
struct QueryMeasures {
  int item = 0;      ///< Place in the library.
  int relevant = 0;  ///< R.
  RetrievalMeasures measures;
  /// At recalls (k+1)/20; NaN where that recall is less than 1/R and so no hit belongs to it.
  std::array<double, kRecallSteps> precision{};
};

/// Means over queries.
struct RetrievalMeans {
  int queries = 0;
  RetrievalMeasures measures;
  std::array<double, kRecallSteps> precision{};  ///< NaN where no query has one.
};

struct RetrievalResult {
  std::vector<QueryMeasures> queries;   ///< In the order of the items.
  RetrievalMeans micro;                 ///< Over the queries.
  RetrievalMeans macro;                 ///< Over the classes that have queries, of their means.
  std::vector<RetrievalMeans> classes;  ///< Of each label, 0 … the largest.
};

struct RetrievalOptions {
  /// Whether each item is a query; empty: all are. It stays in the library in either case.
  std::vector<bool> queries = {};
  int threads = 0;  ///< 0: all processors; no matter for the result.
};

/// Each item looks for its class among all others, as the programs of the Princeton Shape Benchmark
/// do (Shilane, Min, Kazhdan, Funkhouser 2004). The query is not in its own ranking. Items of equal
/// distance are in the order of the library. Items with kUnlabelled, and items whose class has no
/// other member, are no queries.
///
/// Precision at the k-th hit, at recall k/R, is k / its rank; between two hits it is interpolated
/// linearly; at recalls below 1/R there is none, and a mean there is over larger classes alone.
/// @param D       n by n, row i the distances of item i to all; the diagonal is not looked at.
/// @param labels  n.
/// @throws std::invalid_argument  sizes do not fit; a distance is NaN; a label is below
/// kUnlabelled. O(n² log n).
[[nodiscard]] SHAPE3D_LEARNING_EXPORT RetrievalResult
evaluate_retrieval(const Eigen::Ref<const Eigen::MatrixXd>& D, const Labels& labels,
                   const RetrievalOptions& options = {});

/// Measures that a random order has on average over all orders, for the nearest neighbour and the
/// tiers exactly: R/(n−1), and min(2R, n−1)/(n−1); means over the queries.
struct ChanceLevel {
  double nearest_neighbour = 0.0, first_tier = 0.0, second_tier = 0.0;
};
[[nodiscard]] SHAPE3D_LEARNING_EXPORT ChanceLevel
chance_level(const Labels& labels, const std::vector<bool>& queries = {});

}  // namespace shape3d::learning
