#include "retrieval_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

namespace shape3d::bench {
namespace {

constexpr std::size_t kFirstPage = 32;

double discount(std::size_t rank) {  // from 1
  return rank == 1 ? 1.0 : 1.0 / std::log2(static_cast<double>(rank));
}

RetrievalMeasures of_query(const Eigen::MatrixXd& D, const std::vector<std::size_t>& of_class,
                           std::size_t query) {
  std::vector<std::size_t> ranking(of_class.size());
  std::iota(ranking.begin(), ranking.end(), std::size_t{0});
  ranking.erase(ranking.begin() + static_cast<std::ptrdiff_t>(query));
  const auto row = D.row(static_cast<Eigen::Index>(query));
  std::stable_sort(ranking.begin(), ranking.end(), [&](std::size_t a, std::size_t b) {
    return row[static_cast<Eigen::Index>(a)] < row[static_cast<Eigen::Index>(b)];
  });
  std::vector<bool> hit;
  for (const std::size_t model : ranking) hit.push_back(of_class[model] == of_class[query]);
  const auto relevant = static_cast<std::size_t>(std::count(hit.begin(), hit.end(), true));
  RetrievalMeasures result;
  if (relevant == 0) return result;
  const auto hits_of_first = [&](std::size_t n) {
    const auto end = hit.begin() + static_cast<std::ptrdiff_t>(std::min(n, hit.size()));
    return static_cast<double>(std::count(hit.begin(), end, true));
  };
  const auto count = static_cast<double>(relevant);
  result.queries = 1;
  result.nearest_neighbour = hit[0] ? 1.0 : 0.0;
  result.first_tier = hits_of_first(relevant) / count;
  result.second_tier = hits_of_first(2 * relevant) / count;
  const double page = hits_of_first(kFirstPage);
  result.e_measure = page > 0.0 ? 2.0 / (kFirstPage / page + count / page) : 0.0;
  double gain = 0.0, perfect = 0.0;
  for (std::size_t i = 0; i < hit.size(); ++i) {
    if (hit[i]) gain += discount(i + 1);
    if (i < relevant) perfect += discount(i + 1);
  }
  result.dcg = gain / perfect;
  return result;
}

}  // namespace

Eigen::MatrixXd distances(const Eigen::MatrixXd& X, Distance distance) {
  const Eigen::MatrixXd columns = X.transpose();
  Eigen::MatrixXd D(X.rows(), X.rows());
  tbb::parallel_for(Eigen::Index{0}, X.rows(), [&](Eigen::Index i) {
    for (Eigen::Index j = 0; j < X.rows(); ++j) {
      const auto difference = columns.col(i) - columns.col(j);
      D(i, j) = distance == Distance::L1 ? difference.lpNorm<1>() : difference.norm();
    }
  });
  return D;
}

RetrievalMeasures retrieval_measures(const Eigen::MatrixXd& D,
                                     const std::vector<std::size_t>& of_class) {
  std::vector<RetrievalMeasures> each(of_class.size());
  tbb::parallel_for(std::size_t{0}, each.size(),
                    [&](std::size_t query) { each[query] = of_query(D, of_class, query); });
  RetrievalMeasures mean;
  for (const RetrievalMeasures& one : each) {
    mean.queries += one.queries;
    mean.nearest_neighbour += one.nearest_neighbour;
    mean.first_tier += one.first_tier;
    mean.second_tier += one.second_tier;
    mean.e_measure += one.e_measure;
    mean.dcg += one.dcg;
  }
  if (mean.queries == 0) return mean;
  for (double* const value :
       {&mean.nearest_neighbour, &mean.first_tier, &mean.second_tier, &mean.e_measure, &mean.dcg}) {
    *value /= mean.queries;
  }
  return mean;
}

}  // namespace shape3d::bench
