#include "shape3d/learning/retrieval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "random_numbers.hpp"
#include "shape3d/learning/distance.hpp"

using namespace shape3d::learning;

namespace {

// A on a line at 0, 1, 5; B at 2, 3; C at 10, alone and so no query.
struct OnALine {
  Features X = (Features(6, 1) << 0, 1, 5, 2, 3, 10).finished();
  Labels labels{0, 0, 0, 1, 1, 2};
  Eigen::MatrixXd D = distances(X, X, Distance::L1);
};

// Measures of a query worked out from their definitions, without a list of ranks.
RetrievalMeasures by_definition(const Eigen::MatrixXd& D, const Labels& labels, int query) {
  const auto n = static_cast<int>(labels.size());
  const auto rank = [&](int item) {  // from 1, without the query
    int before = 0;
    for (int other = 0; other < n; ++other) {
      if (other == query || other == item) continue;
      if (D(query, other) < D(query, item) || (D(query, other) == D(query, item) && other < item)) {
        ++before;
      }
    }
    return before + 1;
  };
  std::vector<int> ranks;
  for (int item = 0; item < n; ++item) {
    if (item != query &&
        labels[static_cast<std::size_t>(item)] == labels[static_cast<std::size_t>(query)]) {
      ranks.push_back(rank(item));
    }
  }
  const auto relevant = static_cast<double>(ranks.size());
  RetrievalMeasures m;
  double perfect = 1.0, page = 0.0;
  for (int i = 2; i <= static_cast<int>(ranks.size()); ++i) perfect += 1.0 / std::log2(i);
  for (const int r : ranks) {
    if (r == 1) m.nearest_neighbour = 1.0;
    if (r <= relevant) m.first_tier += 1.0 / relevant;
    if (r <= 2 * relevant) m.second_tier += 1.0 / relevant;
    if (r <= 32) page += 1.0;
    m.dcg += (r == 1 ? 1.0 : 1.0 / std::log2(r)) / perfect;
    const auto hits = std::count_if(ranks.begin(), ranks.end(), [r](int q) { return q <= r; });
    m.average_precision += static_cast<double>(hits) / r / relevant;
  }
  if (page > 0.0) m.e_measure = 2.0 / (1.0 / (page / 32.0) + 1.0 / (page / relevant));
  return m;
}

}  // namespace

TEST_CASE("retrieval measures are those of rankings worked out by hand") {
  const OnALine line;
  const RetrievalResult found = evaluate_retrieval(line.D, line.labels);
  CHECK(found.micro.queries == 5);
  // Rankings: 0: A B B A C; 1: A B B A C (0 before 2 by order); 5: B B A A C; 2: A B A A C (1
  // before 3); 3: B A A A C (2, then 1 before 5, then 0).
  const RetrievalMeasures& m = found.micro.measures;
  CHECK(m.nearest_neighbour == Approx((1 + 1 + 0 + 0 + 1) / 5.0));
  CHECK(m.first_tier == Approx((0.5 + 0.5 + 0 + 0 + 1) / 5));
  CHECK(m.second_tier == Approx((1 + 1 + 1 + 1 + 1) / 5.0));
  const double perfect = 1 + 1, low = (1 + 0.5) / perfect;
  const double last = (1 / std::log2(3.0) + 0.5) / perfect;
  CHECK(m.dcg == Approx((low + low + last + 1 + 1) / 5));
  const double e_two = 2 / (32 / 2.0 + 2 / 2.0), e_one = 2 / (32.0 + 1.0);
  CHECK(m.e_measure == Approx((3 * e_two + 2 * e_one) / 5));
  const double ap_a = (1 + 2 / 4.0) / 2, ap_last = (1 / 3.0 + 2 / 4.0) / 2;
  CHECK(m.average_precision == Approx((2 * ap_a + ap_last + 0.5 + 1) / 5));
  // Means over the classes A and B; C has no query.
  CHECK(found.macro.measures.nearest_neighbour == Approx((2 / 3.0 + 1 / 2.0) / 2));
  REQUIRE(found.classes.size() == 3);
  CHECK(found.classes[0].queries == 3);
  CHECK(found.classes[2].queries == 0);
  CHECK(found.classes[0].measures.dcg == Approx((low + low + last) / 3));
}

TEST_CASE("precision is interpolated between hits, and absent below the first recall") {
  // One query whose hits are at ranks 1, 4, 5, 10 among 10 others.
  const int n = 11;
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
  Labels labels(n, 1);
  labels[0] = 0;
  for (const int item : {1, 4, 5, 10}) labels[static_cast<std::size_t>(item)] = 0;
  for (int i = 0; i < n; ++i) D(0, i) = i;
  RetrievalOptions options;
  options.queries.assign(n, false);
  options.queries[0] = true;
  const RetrievalResult found = evaluate_retrieval(D, labels, options);
  REQUIRE(found.queries.size() == 1);
  const auto& p = found.queries[0].precision;
  for (int k = 0; k < 4; ++k) CHECK(std::isnan(p[static_cast<std::size_t>(k)]));  // below 1/4
  CHECK(p[4] == 1.0);                                                             // recall 1/4
  CHECK(p[5] == Approx(1 + 0.2 * (2 / 4.0 - 1)));  // 0.3: a fifth of the way to 1/2
  CHECK(p[9] == 0.5);                              // 1/2
  CHECK(p[12] == Approx(0.5 + 0.6 * (3 / 5.0 - 0.5)));
  CHECK(p[14] == Approx(3 / 5.0));
  CHECK(p[19] == Approx(4 / 10.0));
  CHECK(found.micro.precision[19] == Approx(0.4));
  CHECK(std::isnan(found.micro.precision[0]));
}

TEST_CASE("measures agree with their definitions on random distances with ties") {
  detail::RandomNumbers random(3);
  const int n = 120;
  Labels labels;
  for (int i = 0; i < n; ++i) labels.push_back(static_cast<int>(random.below(9)) - 1);
  Eigen::MatrixXd D(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) D(i, j) = static_cast<double>(random.below(40));
  }
  const RetrievalResult found = evaluate_retrieval(D, labels);
  RetrievalMeasures sum;
  for (const QueryMeasures& query : found.queries) {
    CHECK(labels[static_cast<std::size_t>(query.item)] != kUnlabelled);
    const RetrievalMeasures expected = by_definition(D, labels, query.item);
    CHECK(query.measures.nearest_neighbour == expected.nearest_neighbour);
    CHECK(query.measures.first_tier == Approx(expected.first_tier));
    CHECK(query.measures.second_tier == Approx(expected.second_tier));
    CHECK(query.measures.e_measure == Approx(expected.e_measure));
    CHECK(query.measures.dcg == Approx(expected.dcg));
    CHECK(query.measures.average_precision == Approx(expected.average_precision));
    sum.dcg += expected.dcg;
  }
  CHECK(found.micro.measures.dcg == Approx(sum.dcg / static_cast<double>(found.queries.size())));
  RetrievalOptions options;
  options.threads = 3;
  CHECK(evaluate_retrieval(D, labels, options).micro.measures.dcg == found.micro.measures.dcg);
}

TEST_CASE("a perfect order has all measures at one, and random orders are at chance") {
  detail::RandomNumbers random(5);
  const int n = 600, classes = 20;
  Labels labels;
  for (int i = 0; i < n; ++i) labels.push_back(i % classes);
  Eigen::MatrixXd perfect(n, n), noise(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      perfect(i, j) = i % classes == j % classes ? 0.0 : 1.0;
      noise(i, j) = random.uniform();
    }
  }
  const RetrievalMeasures best = evaluate_retrieval(perfect, labels).micro.measures;
  CHECK(best.nearest_neighbour == 1.0);
  CHECK(best.first_tier == 1.0);
  CHECK(best.second_tier == 1.0);
  CHECK(best.dcg == Approx(1.0));
  CHECK(best.average_precision == Approx(1.0));
  const RetrievalMeasures chance = evaluate_retrieval(noise, labels).micro.measures;
  const ChanceLevel level = chance_level(labels);
  CHECK(level.nearest_neighbour == Approx(29.0 / 599.0));
  CHECK(level.second_tier == Approx(58.0 / 599.0));
  // Standard errors: √(p/600) = 0.009 for the nearest, a fifth of it for the tiers of 29 hits.
  CHECK(std::abs(chance.nearest_neighbour - level.nearest_neighbour) < 4 * 0.009);
  CHECK(std::abs(chance.first_tier - level.first_tier) < 4 * 0.002);
  CHECK(std::abs(chance.second_tier - level.second_tier) < 4 * 0.003);
}

TEST_CASE("unlabelled items are distractors") {
  const OnALine line;
  Labels labels = line.labels;
  labels[3] = labels[4] = kUnlabelled;
  const RetrievalResult found = evaluate_retrieval(line.D, labels);
  CHECK(found.micro.queries == 3);
  CHECK(found.queries[2].measures.nearest_neighbour == 0.0);  // 5 has 3 before 1
  CHECK(evaluate_retrieval(line.D, Labels{0, 1, 2, 3, 4, -1}).micro.queries == 0);
}

TEST_CASE("measures refuse what does not fit") {
  const OnALine line;
  CHECK_THROWS_WITH(evaluate_retrieval(line.D, {0, 1}),
                    "D is 6 by 6, expected 2 by 2 for as many labels");
  CHECK_THROWS_WITH(evaluate_retrieval(line.D, {0, 0, 0, 1, 1, -2}),
                    "label 5 is -2, expected -1 or more");
  RetrievalOptions options;
  options.queries = {true};
  CHECK_THROWS_WITH(evaluate_retrieval(line.D, line.labels, options),
                    "queries has 1 values, expected none or 6");
  Eigen::MatrixXd D = line.D;
  D(1, 4) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(evaluate_retrieval(D, line.labels), "D(1, 4) is nan, expected a distance");
}
