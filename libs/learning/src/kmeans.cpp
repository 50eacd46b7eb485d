#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "checks.hpp"
#include "clusters.hpp"
#include "random_numbers.hpp"
#include "shape3d/learning/clustering.hpp"
#include "text.hpp"

namespace shape3d::learning {
namespace {

constexpr int kMostIterations = 1000;

int different_rows(const FeaturesView& X) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(X.rows()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
  const auto less = [&](Eigen::Index a, Eigen::Index b) {
    return std::lexicographical_compare(X.row(a).begin(), X.row(a).end(), X.row(b).begin(),
                                        X.row(b).end());
  };
  std::sort(order.begin(), order.end(), less);
  int count = 1;
  for (std::size_t i = 1; i < order.size(); ++i) count += less(order[i - 1], order[i]) ? 1 : 0;
  return count;
}

// Squared distance of each row to its nearest centroid, and which that is.
double assign(const FeaturesView& X, const Features& centroids, std::vector<int>& assignment,
              Eigen::VectorXd& squares) {
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    Eigen::Index nearest = 0;
    squares(i) = (centroids.rowwise() - X.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
    assignment[static_cast<std::size_t>(i)] = static_cast<int>(nearest);
  }
  return squares.sum();
}

// k-means++ (Arthur and Vassilvitskii 2007): each next centroid is an item drawn by its squared
// distance to those there are.
Features spread_start(const FeaturesView& X, int k, detail::RandomNumbers& random) {
  Features centroids(k, X.cols());
  centroids.row(0) =
      X.row(static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(X.rows()))));
  Eigen::VectorXd squares = (X.rowwise() - centroids.row(0)).rowwise().squaredNorm();
  for (int c = 1; c < k; ++c) {
    double rest = random.uniform() * squares.sum();
    Eigen::Index drawn = -1;
    for (Eigen::Index i = 0; i < X.rows(); ++i) {
      if (squares(i) == 0.0) continue;  // a centroid is there
      drawn = i;
      rest -= squares(i);
      if (rest < 0.0) break;
    }
    centroids.row(c) = X.row(drawn);
    squares = squares.cwiseMin((X.rowwise() - centroids.row(c)).rowwise().squaredNorm());
  }
  return centroids;
}

// A cluster that ran empty takes the item farthest from its centroid.
void fill_empty(std::vector<int>& assignment, Eigen::VectorXd& squares, int k) {
  std::vector<int> sizes(static_cast<std::size_t>(k), 0);
  for (const int c : assignment) ++sizes[static_cast<std::size_t>(c)];
  for (int c = 0; c < k; ++c) {
    if (sizes[static_cast<std::size_t>(c)] > 0) continue;
    Eigen::Index farthest = 0;
    squares.maxCoeff(&farthest);
    int& old = assignment[static_cast<std::size_t>(farthest)];
    --sizes[static_cast<std::size_t>(old)];
    old = c;
    sizes[static_cast<std::size_t>(c)] = 1;
    squares(farthest) = 0.0;
  }
}

Clusters lloyd(const FeaturesView& X, int k, detail::RandomNumbers& random) {
  Features centroids = spread_start(X, k, random);
  std::vector<int> assignment(static_cast<std::size_t>(X.rows()));
  std::vector<int> before;
  Eigen::VectorXd squares(X.rows());
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    assign(X, centroids, assignment, squares);
    fill_empty(assignment, squares, k);
    if (assignment == before) break;
    before = assignment;
    centroids = detail::centroids_of(X, assignment, k);
  }
  return detail::clusters_of(X, assignment);
}

}  // namespace

namespace detail {

Features centroids_of(const FeaturesView& X, const std::vector<int>& assignment, int count) {
  Features centroids = Features::Zero(count, X.cols());
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    centroids.row(assignment[static_cast<std::size_t>(i)]) += X.row(i);
    sizes(assignment[static_cast<std::size_t>(i)]) += 1.0;
  }
  for (Eigen::Index c = 0; c < count; ++c) centroids.row(c) /= sizes(c);
  return centroids;
}

Clusters clusters_of(const FeaturesView& X, const std::vector<int>& assignment) {
  Clusters result;
  std::map<int, int> number;
  for (const int c : assignment) {
    result.assignment.push_back(
        number.try_emplace(c, static_cast<int>(number.size())).first->second);
  }
  result.centroids = centroids_of(X, result.assignment, static_cast<int>(number.size()));
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    result.scatter +=
        (X.row(i) - result.centroids.row(result.assignment[static_cast<std::size_t>(i)]))
            .squaredNorm();
  }
  return result;
}

}  // namespace detail

Clusters kmeans(const FeaturesView& X, int k, std::uint64_t seed, int starts) {
  detail::require_features(X);
  detail::require_between("k", k, 1, different_rows(X));
  detail::require_between("starts", starts, 1, 1000000);
  detail::RandomNumbers random(seed);
  Clusters best;
  for (int start = 0; start < starts; ++start) {
    Clusters found = lloyd(X, k, random);
    if (start == 0 || found.scatter < best.scatter) best = std::move(found);
  }
  return best;
}

double davies_bouldin(const FeaturesView& X, const Clusters& clusters) {
  const int k = clusters.count();
  detail::require_between("the number of clusters", k, 2, std::numeric_limits<int>::max());
  detail::require_columns(X, clusters.centroids.cols());
  detail::require_between("the number of rows with a cluster",
                          static_cast<long long>(clusters.assignment.size()), X.rows(), X.rows());
  Eigen::VectorXd spread = Eigen::VectorXd::Zero(k);
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(k);
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    const int c = clusters.assignment[static_cast<std::size_t>(i)];
    detail::require_between("a cluster", c, 0, k - 1);
    spread(c) += (X.row(i) - clusters.centroids.row(c)).norm();
    sizes(c) += 1.0;
  }
  spread = spread.cwiseQuotient(sizes.cwiseMax(1.0));
  double sum = 0.0;
  for (int i = 0; i < k; ++i) {
    double worst = 0.0;
    for (int j = 0; j < k; ++j) {
      if (i == j) continue;
      const double apart = (clusters.centroids.row(i) - clusters.centroids.row(j)).norm();
      worst = std::max(worst, apart > 0.0 ? (spread(i) + spread(j)) / apart
                                          : std::numeric_limits<double>::infinity());
    }
    sum += worst;
  }
  return sum / k;
}

ClusterChoice kmeans_by_davies_bouldin(const FeaturesView& X, int most, std::uint64_t seed,
                                       int starts) {
  detail::require_features(X);
  const int different = different_rows(X);
  detail::require_between("the number of different rows", different, 2, X.rows());
  if (most == 0) {
    const int root = static_cast<int>(std::sqrt(static_cast<double>(X.rows())));
    most = std::min(different, std::max(2, root));
  }
  detail::require_between("most", most, 2, different);
  ClusterChoice choice;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 2; k <= most; ++k) {
    Clusters found = kmeans(X, k, seed, starts);
    choice.index.push_back(davies_bouldin(X, found));
    if (choice.index.back() >= least && k > 2) continue;
    least = choice.index.back();
    choice.clusters = std::move(found);
  }
  return choice;
}

}  // namespace shape3d::learning
