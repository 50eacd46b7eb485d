#include "shape3d/learning/linear_metric.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "random_numbers.hpp"
#include "shape3d/learning/distance.hpp"
#include "shape3d/learning/retrieval.hpp"

using namespace shape3d::learning;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Classes that differ in the first column by little, and vary within themselves in the others by
// much.
struct Planted {
  Features X;
  Labels labels;
};

Planted planted(int classes, int members, std::uint64_t seed) {
  detail::RandomNumbers random(seed);
  Planted result;
  result.X.resize(classes * members, 6);
  for (int c = 0; c < classes; ++c) {
    const double middle = 4.0 * random.normal();
    for (int i = 0; i < members; ++i) {
      auto row = result.X.row(c * members + i);
      row[0] = middle + 0.2 * random.normal();
      for (int k = 1; k < 6; ++k) row[k] = 10.0 * random.normal();
      result.labels.push_back(c);
    }
  }
  return result;
}

double nearest(const Features& X, const Labels& labels) {
  return evaluate_retrieval(distances(X, X, Distance::L2), labels).micro.measures.nearest_neighbour;
}

}  // namespace

TEST_CASE("the learnt metric whitens what varies within classes") {
  const Planted p = planted(8, 25, 1);
  LinearMetricOptions options;
  options.components = 0;
  options.shrinkage = 1e-9;
  const LinearMetric metric = learn_linear_metric(p.X, p.labels, options);
  Features Y = metric.apply(p.X);
  CHECK(Y.colwise().mean().norm() < 1e-9);
  // The covariance within classes is the identity.
  MatrixXd W = MatrixXd::Zero(6, 6);
  for (int c = 0; c < 8; ++c) {
    MatrixXd members = Y.middleRows(25 * c, 25);
    members.rowwise() -= members.colwise().mean().eval();
    W += members.transpose() * members;
  }
  CHECK((W / (8 * 24) - MatrixXd::Identity(6, 6)).norm() < 1e-5);
  // With much shrinkage it is the Euclidean metric, up to a factor.
  options.shrinkage = 1e12;
  const MatrixXd D = distances(p.X, p.X, Distance::L2);
  const Features Z = learn_linear_metric(p.X, p.labels, options).apply(p.X);
  const MatrixXd E = distances(Z, Z, Distance::L2);
  CHECK((E / E.sum() - D / D.sum()).norm() < 1e-9);
}

TEST_CASE("the learnt metric serves classes that it has not seen") {
  const Planted seen = planted(10, 20, 2), unseen = planted(10, 20, 3);
  const LinearMetric metric = learn_linear_metric(seen.X, seen.labels, {0, 1e-4});
  CHECK(nearest(unseen.X, unseen.labels) < 0.3);
  CHECK(nearest(metric.apply(unseen.X), unseen.labels) > 0.6);
}

TEST_CASE("principal components keep distances, and the largest come first") {
  detail::RandomNumbers random(5);
  for (const auto& [rows, columns] : {std::pair{30, 8}, std::pair{8, 30}}) {
    Features X(rows, columns);
    for (double& x : X.reshaped()) x = random.normal();
    const Features Y = principal_components(X, 0).apply(X);
    CHECK((distances(Y, Y, Distance::L2) - distances(X, X, Distance::L2)).norm() < 1e-9);
    for (Eigen::Index c = 1; c < Y.cols(); ++c) {
      CHECK(Y.col(c).norm() < Y.col(c - 1).norm() * (1 + 1e-9));
      CHECK(std::abs(Y.col(c).dot(Y.col(c - 1))) < 1e-9);
    }
    CHECK(principal_components(X, 3).apply(X).cols() == 3);
  }
  CHECK(principal_components(Features::Ones(4, 5), 0).apply(Features::Ones(2, 5)).norm() == 0.0);
}

TEST_CASE("metrics are saved and loaded bit for bit, and damage is seen") {
  const Planted p = planted(4, 6, 7);
  const LinearMetric metric = learn_linear_metric(p.X, p.labels);
  const std::string bytes = metric.serialize();
  const LinearMetric read = LinearMetric::deserialize(bytes);
  CHECK(read.mean == metric.mean);
  CHECK(read.transform == metric.transform);
  for (const std::size_t place : {bytes.size() - 1, bytes.size() / 2, std::size_t{2}}) {
    std::string damaged = bytes;
    damaged[place] = static_cast<char>(damaged[place] ^ 4);
    CHECK_THROWS_WITH(LinearMetric::deserialize(damaged), Catch::Contains("metric is damaged"));
  }
  CHECK_THROWS_WITH(LinearMetric::deserialize(bytes.substr(0, bytes.size() / 2)),
                    Catch::Contains("metric is damaged"));
  CHECK_THROWS_WITH(LinearMetric::deserialize(""), Catch::Contains("metric is damaged"));
}

TEST_CASE("metrics refuse what cannot be learnt from") {
  const Planted p = planted(2, 3, 9);
  CHECK_THROWS_WITH(learn_linear_metric(p.X, {0, 1}),
                    "labels has 2 values, expected 6, one for each row of X");
  CHECK_THROWS_WITH(learn_linear_metric(p.X.topRows(1), {0}), "X has 1 rows, expected 2 or more");
  CHECK_THROWS_WITH(learn_linear_metric(p.X, {0, 1, 2, 3, 4, kUnlabelled}),
                    "labels: no class has two members, expected one at least");
  CHECK_THROWS_WITH(learn_linear_metric(p.X, p.labels, {-1, 1.0}),
                    "components is -1, expected 0 or more");
  CHECK_THROWS_WITH(learn_linear_metric(p.X, p.labels, {0, 0.0}),
                    "shrinkage is 0, expected a number above 0");
  Features bad = p.X;
  bad(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(learn_linear_metric(bad, p.labels),
                    "X has a number that is not finite, expected finite ones");
  CHECK_THROWS_WITH(learn_linear_metric(p.X, p.labels).apply(p.X.leftCols(2)),
                    "X has 2 columns, expected 6 as the metric was learnt from");
  CHECK_THROWS_WITH(principal_components(p.X, -1), "most is -1, expected 0 or more");
  CHECK_THROWS_WITH(principal_components(p.X.topRows(0), 1), "X has 0 rows, expected 1 or more");
}
