#include "shape3d/learning/clustering.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <catch2/catch.hpp>

#include "generated.hpp"
#include "random_numbers.hpp"

using namespace shape3d::learning;
using Catch::Matchers::Contains;

namespace {

Features normal_rows(int n, int d, std::uint64_t seed) {
  detail::RandomNumbers random(seed);
  Features X(n, d);
  for (double& x : X.reshaped()) x = random.normal();
  return X;
}

// The distance of two clusters straight from its definition.
double apart(const Features& X, const std::vector<int>& a, const std::vector<int>& b,
             Linkage linkage) {
  double least = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  double sum = 0.0;
  Eigen::RowVectorXd mean_a = Eigen::RowVectorXd::Zero(X.cols());
  Eigen::RowVectorXd mean_b = mean_a;
  for (const int i : a) {
    mean_a += X.row(i) / static_cast<double>(a.size());
    for (const int j : b) {
      const double d = (X.row(i) - X.row(j)).norm();
      least = std::min(least, d);
      largest = std::max(largest, d);
      sum += d;
    }
  }
  for (const int j : b) mean_b += X.row(j) / static_cast<double>(b.size());
  const double n = static_cast<double>(a.size());
  const double m = static_cast<double>(b.size());
  switch (linkage) {
    case Linkage::single:
      return least;
    case Linkage::complete:
      return largest;
    case Linkage::average:
      return sum / (n * m);
    case Linkage::ward:
      break;
  }
  return std::sqrt(2.0 * n * m / (n + m)) * (mean_a - mean_b).norm();
}

}  // namespace

TEST_CASE("agglomeration joins the nearest clusters of all") {
  const Linkage linkage =
      GENERATE(Linkage::single, Linkage::complete, Linkage::average, Linkage::ward);
  const Features X = normal_rows(40, 3, 6);
  const std::vector<Merge> merges = agglomerate(X, linkage);
  REQUIRE(merges.size() == 39);
  std::vector<std::vector<int>> nodes;
  for (int i = 0; i < 40; ++i) nodes.push_back({i});
  std::set<int> open;
  for (int i = 0; i < 40; ++i) open.insert(i);
  double before = 0.0;
  for (const Merge& merge : merges) {
    double least = std::numeric_limits<double>::infinity();
    std::pair<int, int> expected;
    for (const int a : open) {
      for (const int b : open) {
        if (a >= b) continue;
        const double d = apart(X, nodes[static_cast<std::size_t>(a)],
                               nodes[static_cast<std::size_t>(b)], linkage);
        if (d < least) {
          least = d;
          expected = {a, b};
        }
      }
    }
    CHECK(merge.first == expected.first);
    CHECK(merge.second == expected.second);
    CHECK(merge.height == Approx(least));
    CHECK(merge.height >= before);
    before = merge.height;
    std::vector<int> both = nodes[static_cast<std::size_t>(merge.first)];
    const auto& second = nodes[static_cast<std::size_t>(merge.second)];
    both.insert(both.end(), second.begin(), second.end());
    nodes.push_back(both);
    open.erase(merge.first);
    open.erase(merge.second);
    open.insert(static_cast<int>(nodes.size()) - 1);
  }
  for (const int k : {1, 2, 7, 40}) CHECK(cut_tree(X, merges, k).count() == k);
}

TEST_CASE("k-means is a fixed point and seldom far from the best of all divisions") {
  // All divisions of nine items into three by enumeration.
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Features X = normal_rows(9, 2, seed);
    double best = std::numeric_limits<double>::infinity();
    for (int code = 0; code < 19683; ++code) {
      Features sums = Features::Zero(3, 2);
      Eigen::Vector3d sizes = Eigen::Vector3d::Zero();
      int rest = code;
      for (int i = 0; i < 9; ++i, rest /= 3) {
        sums.row(rest % 3) += X.row(i);
        sizes(rest % 3) += 1.0;
      }
      if (sizes.minCoeff() == 0.0) continue;
      double scatter = X.squaredNorm();
      for (int c = 0; c < 3; ++c) scatter -= sums.row(c).squaredNorm() / sizes(c);
      best = std::min(best, scatter);
    }
    const Clusters found = kmeans(X, 3, seed, 20);
    CHECK(found.count() == 3);
    CHECK(found.scatter == Approx(best));
    for (Eigen::Index i = 0; i < 9; ++i) {
      Eigen::Index nearest = 0;
      (found.centroids.rowwise() - X.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
      CHECK(nearest == found.assignment[static_cast<std::size_t>(i)]);
    }
    CHECK(kmeans(X, 3, seed, 20).assignment == found.assignment);
  }
}

TEST_CASE("as many clusters as different rows leave no scatter") {
  Features X(5, 1);
  X << 4, 1, 4, 9, 1;
  const Clusters clusters = kmeans(X, 3, 1);
  CHECK(clusters.scatter == 0.0);
  CHECK(clusters.assignment == std::vector<int>{0, 1, 0, 2, 1});
  CHECK_THROWS_WITH(kmeans(X, 4, 1), Contains("k is 4, expected 1 … 3"));
  CHECK_THROWS_WITH(kmeans(X, 2, 1, 0), Contains("starts is 0"));
  CHECK_THROWS_WITH(kmeans_by_davies_bouldin(X, 4, 1), Contains("most is 4, expected 2 … 3"));
  CHECK_THROWS_WITH(kmeans_by_davies_bouldin(Features::Ones(4, 2), 0, 1),
                    Contains("the number of different rows is 1"));
}

TEST_CASE("the Davies-Bouldin index is that of a case by hand") {
  Features X(4, 1);
  X << 0, 2, 10, 16;
  Clusters clusters = kmeans(X, 2, 1);
  CHECK(clusters.centroids(0, 0) == 1.0);
  CHECK(clusters.centroids(1, 0) == 13.0);
  CHECK(davies_bouldin(X, clusters) == Approx((1.0 + 3.0) / 12.0));
  clusters.centroids(0, 0) = 13.0;
  CHECK(std::isinf(davies_bouldin(X, clusters)));
  CHECK_THROWS_WITH(davies_bouldin(X, kmeans(X, 1, 1)), Contains("the number of clusters is 1"));
  clusters.assignment.pop_back();
  CHECK_THROWS_WITH(davies_bouldin(X, clusters),
                    Contains("the number of rows with a cluster is 3"));
}

TEST_CASE("a tree is cut only where it belongs") {
  const Features X = normal_rows(5, 2, 3);
  const std::vector<Merge> merges = agglomerate(X, Linkage::ward);
  CHECK_THROWS_WITH(cut_tree(X, merges, 6), Contains("k is 6, expected 1 … 5"));
  CHECK_THROWS_WITH(cut_tree(X, merges, 0), Contains("k is 0"));
  CHECK_THROWS_WITH(cut_tree(X.topRows(4), merges, 2), Contains("there are 4 merges, expected 3"));
  CHECK(agglomerate(X.topRows(1), Linkage::single).empty());
  CHECK_THROWS_WITH(agglomerate(Features(0, 2), Linkage::single), Contains("X has 0 rows"));
}
