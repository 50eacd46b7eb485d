#include "shape3d/learning/retrieval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "parallel.hpp"

namespace shape3d::learning {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double discount(int rank) {  // from 1
  return rank == 1 ? 1.0 : 1.0 / std::log2(static_cast<double>(rank));
}

// Ranks, from 1, of the items of the query's class.
std::vector<int> ranks_of_hits(const Eigen::Ref<const Eigen::MatrixXd>& D, const Labels& labels,
                               int query) {
  const auto n = static_cast<int>(labels.size());
  std::vector<double> row(labels.size());
  for (int i = 0; i < n; ++i) {
    row[static_cast<std::size_t>(i)] = D(query, i);
    if (i != query && std::isnan(D(query, i))) {
      throw std::invalid_argument("D(" + std::to_string(query) + ", " + std::to_string(i) +
                                  ") is nan, expected a distance");
    }
  }
  std::vector<int> ranking(labels.size());
  std::iota(ranking.begin(), ranking.end(), 0);
  ranking.erase(ranking.begin() + query);
  std::stable_sort(ranking.begin(), ranking.end(), [&](int a, int b) {
    return row[static_cast<std::size_t>(a)] < row[static_cast<std::size_t>(b)];
  });
  const int wanted = labels[static_cast<std::size_t>(query)];
  std::vector<int> ranks;
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    if (labels[static_cast<std::size_t>(ranking[i])] == wanted) {
      ranks.push_back(static_cast<int>(i) + 1);
    }
  }
  return ranks;
}

int hits_within(const std::vector<int>& ranks, int last) {
  return static_cast<int>(std::upper_bound(ranks.begin(), ranks.end(), last) - ranks.begin());
}

RetrievalMeasures measures_of(const std::vector<int>& ranks) {
  const auto relevant = static_cast<int>(ranks.size());
  RetrievalMeasures m;
  m.nearest_neighbour = ranks.front() == 1 ? 1.0 : 0.0;
  m.first_tier = hits_within(ranks, relevant) / static_cast<double>(relevant);
  m.second_tier = hits_within(ranks, 2 * relevant) / static_cast<double>(relevant);
  const double page = hits_within(ranks, kFirstPage);
  m.e_measure = page > 0.0 ? 2.0 / (kFirstPage / page + relevant / page) : 0.0;
  double gain = 0.0, perfect = 0.0, precisions = 0.0;
  for (int k = 1; k <= relevant; ++k) {
    const int rank = ranks[static_cast<std::size_t>(k - 1)];
    gain += discount(rank);
    perfect += discount(k);
    precisions += static_cast<double>(k) / rank;
  }
  m.dcg = gain / perfect;
  m.average_precision = precisions / relevant;
  return m;
}

std::array<double, kRecallSteps> curve_of(const std::vector<int>& ranks) {
  const auto relevant = static_cast<std::int64_t>(ranks.size());
  const auto precision = [&](std::int64_t k) {  // at the k-th hit, from 1
    return static_cast<double>(k) / ranks[static_cast<std::size_t>(k - 1)];
  };
  std::array<double, kRecallSteps> curve{};
  for (std::int64_t step = 1; step <= kRecallSteps; ++step) {
    // The place between hits is step · relevant / 20: in whole numbers, so that ends are exact.
    const std::int64_t k = step * relevant / kRecallSteps, rest = step * relevant % kRecallSteps;
    double value = kNone;
    if (k >= 1) {
      value = precision(k);
      if (rest > 0) value += (precision(k + 1) - value) * static_cast<double>(rest) / kRecallSteps;
    }
    curve[static_cast<std::size_t>(step - 1)] = value;
  }
  return curve;
}

constexpr std::array<double RetrievalMeasures::*, 6> kMembers{
    &RetrievalMeasures::nearest_neighbour,
    &RetrievalMeasures::first_tier,
    &RetrievalMeasures::second_tier,
    &RetrievalMeasures::e_measure,
    &RetrievalMeasures::dcg,
    &RetrievalMeasures::average_precision};

// Sums that become means; NaN precisions are passed over.
class Mean {
 public:
  void add(const RetrievalMeasures& measures, const std::array<double, kRecallSteps>& precision) {
    ++count_;
    for (const auto member : kMembers) sum_.measures.*member += measures.*member;
    for (std::size_t k = 0; k < precision.size(); ++k) {
      if (std::isnan(precision[k])) continue;
      sum_.precision[k] += precision[k];
      ++counts_[k];
    }
  }

  [[nodiscard]] RetrievalMeans mean(int queries) const {
    RetrievalMeans result = sum_;
    result.queries = queries;
    if (count_ > 0) {
      for (const auto member : kMembers) result.measures.*member /= count_;
    }
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      result.precision[k] = counts_[k] > 0 ? result.precision[k] / counts_[k] : kNone;
    }
    return result;
  }
  [[nodiscard]] int count() const { return count_; }

 private:
  RetrievalMeans sum_;
  std::array<int, kRecallSteps> counts_{};
  int count_ = 0;
};

void check_labels(const Labels& labels, const std::vector<bool>& queries) {
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] < kUnlabelled) {
      throw std::invalid_argument("label " + std::to_string(i) + " is " +
                                  std::to_string(labels[i]) + ", expected -1 or more");
    }
  }
  if (!queries.empty() && queries.size() != labels.size()) {
    throw std::invalid_argument("queries has " + std::to_string(queries.size()) +
                                " values, expected none or " + std::to_string(labels.size()));
  }
}

// Members of each class.
std::vector<int> class_sizes(const Labels& labels) {
  std::vector<int> sizes;
  for (const int label : labels) {
    if (label == kUnlabelled) continue;
    const auto place = static_cast<std::size_t>(label);
    if (place >= sizes.size()) sizes.resize(place + 1);
    ++sizes[place];
  }
  return sizes;
}

bool is_query(const Labels& labels, const std::vector<int>& sizes, const std::vector<bool>& queries,
              std::size_t i) {
  return labels[i] != kUnlabelled && sizes[static_cast<std::size_t>(labels[i])] > 1 &&
         (queries.empty() || queries[i]);
}

}  // namespace

RetrievalResult evaluate_retrieval(const Eigen::Ref<const Eigen::MatrixXd>& D, const Labels& labels,
                                   const RetrievalOptions& options) {
  const auto n = static_cast<Eigen::Index>(labels.size());
  if (D.rows() != n || D.cols() != n) {
    throw std::invalid_argument("D is " + std::to_string(D.rows()) + " by " +
                                std::to_string(D.cols()) + ", expected " + std::to_string(n) +
                                " by " + std::to_string(n) + " for as many labels");
  }
  check_labels(labels, options.queries);
  const std::vector<int> sizes = class_sizes(labels);
  RetrievalResult result;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!is_query(labels, sizes, options.queries, i)) continue;
    result.queries.emplace_back();
    result.queries.back().item = static_cast<int>(i);
    result.queries.back().relevant = sizes[static_cast<std::size_t>(labels[i])] - 1;
  }
  detail::parallel_blocks(static_cast<std::int64_t>(result.queries.size()), 4,
                          detail::resolve_threads(options.threads),
                          [&](std::int64_t first, std::int64_t last) {
                            for (std::int64_t q = first; q < last; ++q) {
                              QueryMeasures& query = result.queries[static_cast<std::size_t>(q)];
                              const std::vector<int> ranks = ranks_of_hits(D, labels, query.item);
                              query.measures = measures_of(ranks);
                              query.precision = curve_of(ranks);
                            }
                          });
  Mean micro, macro;
  std::vector<Mean> classes(sizes.size());
  for (const QueryMeasures& query : result.queries) {
    const int label = labels[static_cast<std::size_t>(query.item)];
    micro.add(query.measures, query.precision);
    classes[static_cast<std::size_t>(label)].add(query.measures, query.precision);
  }
  const auto queries = static_cast<int>(result.queries.size());
  for (const Mean& mean : classes) {
    result.classes.push_back(mean.mean(mean.count()));
    if (mean.count() > 0)
      macro.add(result.classes.back().measures, result.classes.back().precision);
  }
  result.micro = micro.mean(queries);
  result.macro = macro.mean(queries);
  return result;
}

ChanceLevel chance_level(const Labels& labels, const std::vector<bool>& queries) {
  check_labels(labels, queries);
  const std::vector<int> sizes = class_sizes(labels);
  const double others = static_cast<double>(labels.size()) - 1.0;
  ChanceLevel sum;
  int count = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!is_query(labels, sizes, queries, i)) continue;
    const double relevant = sizes[static_cast<std::size_t>(labels[i])] - 1;
    sum.nearest_neighbour += relevant / others;
    sum.first_tier += relevant / others;
    sum.second_tier += std::min(2.0 * relevant, others) / others;
    ++count;
  }
  if (count == 0) return sum;
  return {sum.nearest_neighbour / count, sum.first_tier / count, sum.second_tier / count};
}

}  // namespace shape3d::learning
