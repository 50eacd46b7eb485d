#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "checks.hpp"
#include "clusters.hpp"
#include "shape3d/learning/clustering.hpp"
#include "text.hpp"

namespace shape3d::learning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Clusters are known by the place of their lowest item. For ward the matrix holds squares.
class Agglomeration {
 public:
  Agglomeration(const FeaturesView& X, Linkage linkage)
      : linkage_(linkage),
        n_(X.rows()),
        D_(n_, n_),
        active_(static_cast<std::size_t>(n_), true),
        sizes_(static_cast<std::size_t>(n_), 1.0),
        names_(static_cast<std::size_t>(n_)),
        nearest_(static_cast<std::size_t>(n_), -1) {
    for (Eigen::Index i = 0; i < n_; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        const double square = (X.row(i) - X.row(j)).squaredNorm();
        D_(i, j) = D_(j, i) = linkage == Linkage::ward ? square : std::sqrt(square);
      }
      names_[at(i)] = static_cast<int>(i);
    }
    for (Eigen::Index i = 0; i < n_; ++i) look(i);
  }

  std::vector<Merge> run() {
    std::vector<Merge> merges;
    for (Eigen::Index step = 0; step + 1 < n_; ++step) {
      Eigen::Index i = -1;
      for (Eigen::Index a = 0; a < n_; ++a) {
        if (!active_[at(a)] || nearest_[at(a)] < 0) continue;
        if (i < 0 || D_(a, nearest_[at(a)]) < D_(i, nearest_[at(i)])) i = a;
      }
      const Eigen::Index j = nearest_[at(i)];
      const double distance = D_(i, j);
      const auto [low, high] = std::minmax(names_[at(i)], names_[at(j)]);
      merges.push_back({low, high, linkage_ == Linkage::ward ? std::sqrt(distance) : distance});
      join(i, j);
      names_[at(i)] = static_cast<int>(n_ + step);
    }
    return merges;
  }

 private:
  static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }

  // The nearest cluster of a higher place.
  void look(Eigen::Index i) {
    Eigen::Index& best = nearest_[at(i)];
    best = -1;
    for (Eigen::Index j = i + 1; j < n_; ++j) {
      if (active_[at(j)] && (best < 0 || D_(i, j) < D_(i, best))) best = j;
    }
  }

  // The distance of cluster k to the union of i and j (Lance and Williams 1967).
  [[nodiscard]] double united(Eigen::Index i, Eigen::Index j, Eigen::Index k) const {
    const double ni = sizes_[at(i)];
    const double nj = sizes_[at(j)];
    const double nk = sizes_[at(k)];
    switch (linkage_) {
      case Linkage::single:
        return std::min(D_(i, k), D_(j, k));
      case Linkage::complete:
        return std::max(D_(i, k), D_(j, k));
      case Linkage::average:
        return (ni * D_(i, k) + nj * D_(j, k)) / (ni + nj);
      case Linkage::ward:
        break;
    }
    return ((ni + nk) * D_(i, k) + (nj + nk) * D_(j, k) - nk * D_(i, j)) / (ni + nj + nk);
  }

  void join(Eigen::Index i, Eigen::Index j) {
    active_[at(j)] = false;
    for (Eigen::Index k = 0; k < n_; ++k) {
      if (!active_[at(k)] || k == i) continue;
      D_(i, k) = D_(k, i) = united(i, j, k);
    }
    sizes_[at(i)] += sizes_[at(j)];
    look(i);
    for (Eigen::Index k = 0; k < j; ++k) {
      if (!active_[at(k)] || k == i) continue;
      const Eigen::Index near = nearest_[at(k)];
      if (near == i || near == j) {
        look(k);
      } else if (k < i && D_(k, i) <= D_(k, near)) {
        if (D_(k, i) < D_(k, near) || i < near) nearest_[at(k)] = i;
      }
    }
  }

  Linkage linkage_;
  Eigen::Index n_;
  Eigen::MatrixXd D_;
  std::vector<bool> active_;
  std::vector<double> sizes_;
  std::vector<int> names_;
  std::vector<Eigen::Index> nearest_;
};

}  // namespace

std::vector<Merge> agglomerate(const FeaturesView& X, Linkage linkage) {
  detail::require_features(X);
  return Agglomeration(X, linkage).run();
}

Clusters cut_tree(const FeaturesView& X, const std::vector<Merge>& merges, int k) {
  detail::require_features(X);
  const auto n = static_cast<std::size_t>(X.rows());
  detail::require_between("k", k, 1, X.rows());
  if (merges.size() + 1 != n) {
    throw std::invalid_argument("there are " + std::to_string(merges.size()) +
                                " merges, expected " + std::to_string(n - 1));
  }
  // Above each node of the tree the node it becomes a part of, as far as the tree is kept.
  const std::size_t kept = n - static_cast<std::size_t>(k);
  std::vector<int> above(n + kept, -1);
  for (std::size_t s = 0; s < kept; ++s) {
    for (const int part : {merges[s].first, merges[s].second}) {
      detail::require_between("a merged cluster", part, 0, static_cast<long long>(n + s) - 1);
      above[static_cast<std::size_t>(part)] = static_cast<int>(n + s);
    }
  }
  std::vector<int> assignment(n);
  for (std::size_t i = 0; i < n; ++i) {
    auto node = static_cast<int>(i);
    while (above[static_cast<std::size_t>(node)] >= 0) node = above[static_cast<std::size_t>(node)];
    assignment[i] = node;
  }
  return detail::clusters_of(X, assignment);
}

}  // namespace shape3d::learning
