#include "shape3d/learning/distance.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "random_numbers.hpp"
#include "shape3d/learning/fusion.hpp"
#include "shape3d/learning/weighted_distance.hpp"

using namespace shape3d::learning;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

Features random_features(int rows, int columns, std::uint64_t seed) {
  detail::RandomNumbers random(seed);
  Features X(rows, columns);
  for (double& x : X.reshaped()) x = random.normal();
  return X;
}

}  // namespace

TEST_CASE("distances are their formulas") {
  const VectorXd x = (VectorXd(3) << 1, 0, -2).finished(), y = (VectorXd(3) << 3, 0, 2).finished();
  CHECK(distance(x, y, Distance::L1) == 6.0);
  CHECK(distance(x, y, Distance::L2) == Approx(std::sqrt(20.0)));
  CHECK(distance(x, y, Distance::L2_squared) == 20.0);
  CHECK(distance(x, y, Distance::chi_squared) == Approx(4 / 4.0 + 16 / 4.0));
  CHECK(distance(x, y, Distance::cosine) == Approx(1 - (3 - 4) / std::sqrt(5.0 * 13.0)));
  const VectorXd zero = VectorXd::Zero(3);
  CHECK(distance(x, zero, Distance::cosine) == 1.0);
  CHECK(distance(zero, zero, Distance::cosine) == 0.0);
  CHECK(distance(x, -x, Distance::cosine) == Approx(2.0));
  CHECK(distance(zero, zero, Distance::chi_squared) == 0.0);
}

TEST_CASE("distance matrices are those of their pairs, symmetric, and of any number of threads") {
  const Features X = random_features(37, 11, 1), Y = random_features(20, 11, 2);
  for (const Distance kind : {Distance::L1, Distance::L2, Distance::L2_squared,
                              Distance::chi_squared, Distance::cosine}) {
    CHECK(distance_named(to_string(kind)) == kind);
    const MatrixXd D = distances(X, Y, kind);
    for (int i = 0; i < X.rows(); ++i) {
      for (int j = 0; j < Y.rows(); ++j) {
        CHECK(D(i, j) == Approx(distance(X.row(i).transpose(), Y.row(j).transpose(), kind)));
      }
    }
    const MatrixXd S = distances(X, X, kind);
    CHECK(S == S.transpose());
    CHECK(S.diagonal().cwiseAbs().maxCoeff() < 1e-15);
    CHECK(S == distances(X, X, kind, 3));
  }
  CHECK_FALSE(distance_named("euclid"));
}

TEST_CASE("distances refuse what does not fit") {
  const Features X = random_features(3, 2, 1), Y = random_features(3, 4, 1);
  CHECK_THROWS_WITH(distances(X, Y, Distance::L1), "Y has 4 columns, expected 2 as X has");
  Features bad = X;
  bad(1, 1) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(distances(X, bad, Distance::L1),
                    "row 1 of Y has a number that is not finite, expected finite ones");
  CHECK_THROWS_WITH(distance(VectorXd::Zero(2), VectorXd::Zero(3), Distance::L2),
                    "y has 3 numbers, expected 2 as x has");
}

TEST_CASE("the class-weighted distance is hard with classes and in between with probabilities") {
  const MatrixXd D = (MatrixXd(2, 3) << 4, 4, 4, 8, 8, 8).finished();
  const Features P = hard_probabilities({0, 1}, 2), Q = hard_probabilities({0, 1, kUnlabelled}, 2);
  const MatrixXd hard = class_weighted(D, P, Q, {0.25, 1.0});
  CHECK(hard == (MatrixXd(2, 3) << 1, 4, 4, 8, 2, 8).finished());
  const Features soft = (Features(1, 2) << 0.7, 0.3).finished();
  const MatrixXd mixed = class_weighted(D.topRows(1), soft, Q, {0.25, 1.0});
  CHECK(mixed(0, 0) == Approx(4 * (1 - 0.75 * 0.7)));
  CHECK(mixed(0, 1) == Approx(4 * (1 - 0.75 * 0.3)));
  CHECK(mixed(0, 2) == 4.0);
  // The mean of the weight over classes drawn by the probabilities.
  CHECK(mixed(0, 0) == Approx(0.7 * hard(0, 0) + 0.3 * 4));
}

TEST_CASE("the class-weighted distance refuses what does not fit") {
  const MatrixXd D = MatrixXd::Ones(1, 1);
  const Features P = Features::Ones(1, 1);
  CHECK_THROWS_WITH(class_weighted(D, P, P, {0.0, 1.0}), "same is 0, expected a number above 0");
  CHECK_THROWS_WITH(class_weighted(D, P, P, {2.0, 1.0}),
                    "other is 1, expected a number not below same");
  CHECK_THROWS_WITH(class_weighted(D, Features::Ones(2, 1), P),
                    "P has 2 rows, expected 1 as D has");
  CHECK_THROWS_WITH(class_weighted(D, P, Features::Zero(1, 2)),
                    "Q has 2 columns, expected 1 as P has");
  CHECK_THROWS_WITH(
      class_weighted(D, P * 1.1, P),
      "row 0 of P is no probabilities, expected numbers from 0 whose sum is at most 1");
  CHECK_THROWS_WITH(hard_probabilities({3}, 3),
                    "label 0 is 3, expected less than 3, the number of classes");
  CHECK_THROWS_WITH(hard_probabilities({}, -1), "classes is -1, expected 0 or more");
}

TEST_CASE("fusion adds distances in their units") {
  const Features X = random_features(15, 3, 4);
  const MatrixXd D = distances(X, X, Distance::L1);
  double sum = 0.0;
  for (int i = 0; i < 15; ++i) {
    for (int j = 0; j < 15; ++j) sum += i == j ? 0.0 : D(i, j);
  }
  CHECK(mean_distance(D) == Approx(sum / 210.0));
  CHECK(mean_distance(MatrixXd::Ones(1, 1)) == 0.0);
  const MatrixXd same = fused({{D, mean_distance(D), 1.0}, {7.0 * D, mean_distance(7.0 * D), 3.0}});
  CHECK((same - D / mean_distance(D)).cwiseAbs().maxCoeff() < 1e-12);  // units do not matter
  const MatrixXd without = fused({{D, 2.0, 1.0}, {D, 0.0, 1.0}});
  CHECK((without - D / 4.0).cwiseAbs().maxCoeff() < 1e-12);
  CHECK_THROWS_WITH(fused({}), "there are 0 parts, expected 1 or more");
  CHECK_THROWS_WITH(fused({{D, 1.0, 1.0}, {D.topRows(2), 1.0, 1.0}}),
                    "a part is 2 by 15, expected 15 by 15 as the first");
  CHECK_THROWS_WITH(fused({{D, -1.0, 1.0}}), "unit is -1, expected 0 or more");
  CHECK_THROWS_WITH(fused({{D, 1.0, -1.0}}), "weight is -1, expected 0 or more");
  CHECK_THROWS_WITH(fused({{D, 1.0, 0.0}}), "sum of weights is 0, expected more than 0");
  CHECK_THROWS_WITH(mean_distance(D.topRows(2)), "D is 2 by 15, expected as many rows as columns");
}

TEST_CASE("local scaling makes neighbourhoods of all densities alike") {
  // Two groups of the same shape, one a hundred times as large, far from each other.
  const Features shape = random_features(20, 2, 6);
  Features X(40, 2);
  X << shape, (100.0 * shape).rowwise() + Eigen::RowVector2d(1e4, 0.0);
  const MatrixXd D = distances(X, X, Distance::L2), scaled = locally_scaled(D, 5);
  CHECK((scaled.topLeftCorner(20, 20) - scaled.bottomRightCorner(20, 20)).cwiseAbs().maxCoeff() <
        1e-9);
  CHECK(scaled == scaled.transpose());
  // By the formula.
  const auto unit = [&](int i) {
    std::vector<double> row;
    for (int j = 0; j < 40; ++j) {
      if (j != i) row.push_back(D(i, j));
    }
    std::sort(row.begin(), row.end());
    return (row[0] + row[1] + row[2] + row[3] + row[4]) / 5.0;
  };
  CHECK(scaled(3, 30) == Approx(D(3, 30) / std::sqrt(unit(3) * unit(30))));
  // Two collections that are infinitely far from each other are scaled each by itself.
  MatrixXd apart = D;
  apart.topRightCorner(20, 20).setConstant(std::numeric_limits<double>::infinity());
  apart.bottomLeftCorner(20, 20) = apart.topRightCorner(20, 20);
  const MatrixXd each = locally_scaled(apart, 30);
  CHECK(each.topLeftCorner(20, 20) == locally_scaled(D.topLeftCorner(20, 20), 19));
  CHECK(std::isinf(each(0, 20)));
  // Copies have no unit of their own, and no distance becomes infinite.
  const MatrixXd copies = locally_scaled(MatrixXd::Zero(4, 4), 2);
  CHECK(copies == MatrixXd::Zero(4, 4));
  CHECK((locally_scaled(D, 39) - locally_scaled(D, 1000)).norm() == 0.0);
  CHECK_THROWS_WITH(locally_scaled(D, 0), "k is 0, expected 1 or more");
  CHECK_THROWS_WITH(locally_scaled(D.topRows(3), 1),
                    "D is 3 by 40, expected as many rows as columns");
}
