#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace shape3d::bench {

enum class Distance { L1, L2 };

/// Distances of all pairs of rows of X, n × n.
[[nodiscard]] Eigen::MatrixXd distances(const Eigen::MatrixXd& X, Distance distance);

/// Measures of the Princeton Shape Benchmark (Shilane et al. 2004), means over the queries, 0 … 1.
struct RetrievalMeasures {
  double nearest_neighbour = 0.0;
  double first_tier = 0.0;   ///< Share of the class among the |C| − 1 nearest.
  double second_tier = 0.0;  ///< Among the 2(|C| − 1) nearest.
  double e_measure = 0.0;    ///< 2 / (1/P + 1/R) of the first 32.
  double dcg = 0.0;  ///< G_1 + Σ_{i≥2} G_i / log2 i, divided by its value for a perfect ranking.
  int queries = 0;   ///< Models whose class has another member.
};

/// Every model queries all the others. Ties: in the order of the models.
/// @param D         n × n distances.
/// @param of_class  n classes.
[[nodiscard]] RetrievalMeasures retrieval_measures(const Eigen::MatrixXd& D,
                                                   const std::vector<std::size_t>& of_class);

}  // namespace shape3d::bench
