#include "shape3d/learning/nearest_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::learning;
using Catch::Matchers::Contains;

Features random_features(Eigen::Index rows, Eigen::Index columns, unsigned seed, double scale = 1.0,
                         double offset = 0.0) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  Features X(rows, columns);
  for (Eigen::Index i = 0; i < X.size(); ++i) X.data()[i] = offset + scale * normal(engine);
  return X;
}

// The definition: all distances in double precision, sorted by distance, then place.
Neighbours by_definition(const Features& X, const Features& Q, Eigen::Index k, Norm norm) {
  k = std::min(k, X.rows());
  Neighbours result;
  result.rows.resize(Q.rows(), k);
  result.distances.resize(Q.rows(), k);
  for (Eigen::Index q = 0; q < Q.rows(); ++q) {
    std::vector<std::pair<double, Eigen::Index>> all;
    for (Eigen::Index row = 0; row < X.rows(); ++row) {
      double sum = 0.0;
      for (Eigen::Index i = 0; i < X.cols(); ++i) {
        const double difference = X(row, i) - Q(q, i);
        sum += norm == Norm::L1 ? std::abs(difference) : difference * difference;
      }
      all.emplace_back(norm == Norm::L1 ? sum : std::sqrt(sum), row);
    }
    std::sort(all.begin(), all.end());
    for (Eigen::Index i = 0; i < k; ++i) {
      result.distances(q, i) = all[static_cast<std::size_t>(i)].first;
      result.rows(q, i) = all[static_cast<std::size_t>(i)].second;
    }
  }
  return result;
}

void check_equal(const Neighbours& a, const Neighbours& b) {
  REQUIRE(a.rows.rows() == b.rows.rows());
  REQUIRE(a.rows.cols() == b.rows.cols());
  CHECK((a.rows.array() == b.rows.array()).all());
  CHECK((a.distances.array() == b.distances.array()).all());
}

TEST_CASE("exact neighbours are those of the definition, bit for bit", "[neighbours]") {
  const Norm norm = GENERATE(Norm::L1, Norm::L2);
  struct Case {
    Eigen::Index n, d, queries, k;
  };
  const Case c = GENERATE(Case{1, 1, 1, 1}, Case{7, 3, 5, 2}, Case{1025, 45, 33, 10},
                          Case{40000, 45, 3, 11}, Case{500, 200, 300, 7}, Case{3000, 2, 20, 100});
  const Features X = random_features(c.n, c.d, 1), Q = random_features(c.queries, c.d, 2);
  const Neighbours expected = by_definition(X, Q, c.k, norm);
  const ExactNeighbours index(X, norm);
  check_equal(index.query(Q, c.k, 1), expected);
  check_equal(index.query(Q, c.k, 2), expected);
  check_equal(index.query(Q, c.k, 5), expected);
  // One by one, and together.
  for (Eigen::Index q = 0; q < std::min<Eigen::Index>(3, c.queries); ++q) {
    const Neighbours one = index.query(Q.row(q), c.k);
    CHECK((one.rows.row(0).array() == expected.rows.row(q).array()).all());
  }
}

TEST_CASE("items that single precision cannot tell apart are in the right order", "[neighbours]") {
  // Steps of 1e-9 about 1: the smallest distances differ in the ninth digit of the coordinates.
  const Norm norm = GENERATE(Norm::L1, Norm::L2);
  const double offset = GENERATE(0.0, 1.0, 1e6);
  Features X = random_features(4000, 12, 3, 1.0, offset);
  for (Eigen::Index row = 0; row < 600; ++row) {
    X.row(row) = X.row(0);
    X(row, 5) += 1e-9 * static_cast<double>((row * 7919) % 600) * std::max(1.0, offset);
  }
  const Features Q = X.topRows(3);
  check_equal(ExactNeighbours(X, norm).query(Q, 50), by_definition(X, Q, 50, norm));
}

TEST_CASE("items of equal distance are in the order of the library", "[neighbours]") {
  const Features pattern = random_features(8, 5, 4);
  Features X(40000, 5);  // several parts
  for (Eigen::Index row = 0; row < X.rows(); ++row) X.row(row) = pattern.row(row % 8);
  const Neighbours found = ExactNeighbours(X).query(pattern.row(3), 2000, 2);
  for (Eigen::Index i = 0; i < 2000; ++i) {
    REQUIRE(found.rows(0, i) == 3 + 8 * i);
    REQUIRE(found.distances(0, i) == 0.0);
  }
}

TEST_CASE("neighbours of vectors of any magnitude", "[neighbours]") {
  const Norm norm = GENERATE(Norm::L1, Norm::L2);
  const double scale = GENERATE(1e-140, 1e-30, 1e20, 1e140);
  Features X = random_features(300, 6, 5, scale);
  Features Q = random_features(4, 6, 6, scale);
  SECTION("all alike") {}
  SECTION("one far away") { X.row(17) *= 1e9; }
  SECTION("a query far away") { Q.row(2) *= 1e9; }
  SECTION("a query beyond single precision") { Q.row(2) = Q.row(2) / scale * 1e-150; }
  check_equal(ExactNeighbours(X, norm).query(Q, 9), by_definition(X, Q, 9, norm));
}

TEST_CASE("a library smaller than k gives all it has", "[neighbours]") {
  const Features X = random_features(5, 4, 7), Q = random_features(2, 4, 8);
  check_equal(ExactNeighbours(X).query(Q, 100), by_definition(X, Q, 5, Norm::L2));
  const Neighbours none = ExactNeighbours(Features(0, 4)).query(Q, 3);
  CHECK(none.rows.rows() == 2);
  CHECK(none.rows.cols() == 0);
}

TEST_CASE("equal items, and vectors of no numbers", "[neighbours]") {
  const Features X = Features::Constant(10, 3, 0.25);
  const Neighbours found = ExactNeighbours(X).query(X.topRows(1), 4);
  CHECK(found.rows(0, 3) == 3);
  CHECK(found.distances.maxCoeff() == 0.0);
  const Neighbours empty = ExactNeighbours(Features(3, 0)).query(Features(1, 0), 2);
  CHECK(empty.rows(0, 1) == 1);
}

TEST_CASE("exact neighbours refuse what they cannot use", "[neighbours][contract]") {
  const Features X = random_features(5, 4, 9);
  const ExactNeighbours index(X);
  CHECK_THROWS_AS(index.query(Features(1, 3), 1), std::invalid_argument);
  CHECK_THROWS_WITH(index.query(Features(1, 3), 1), "Q has 3 columns, expected 4");
  CHECK_THROWS_WITH(index.query(X, 0), "k is 0, expected 1 or more");
  CHECK_THROWS_WITH(index.query(X, 1, -1), Contains("threads is -1"));
  Features bad = X;
  bad(3, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(ExactNeighbours(bad), "row 3 of X has a number that is not finite");
  CHECK_THROWS_WITH(index.query(bad, 1), "row 3 of Q has a number that is not finite");
}

}  // namespace
