#include "svm_folds.hpp"

#include <algorithm>
#include <stdexcept>

#include "checks.hpp"
#include "parallel.hpp"
#include "svm_machines.hpp"
#include "text.hpp"

namespace shape3d::learning {
namespace detail {

std::vector<FoldRows> rows_of_folds(const Labels& labels, const std::vector<int>& folds) {
  if (folds.size() != labels.size()) {
    throw std::invalid_argument("there are " + std::to_string(folds.size()) +
                                " folds, expected one for each of " +
                                std::to_string(labels.size()) + " rows");
  }
  int last = -1;
  for (const int fold : folds) {
    require(fold >= 0, "a fold", fold, "0 or more");
    last = std::max(last, fold);
  }
  std::vector<FoldRows> result(static_cast<std::size_t>(last + 1));
  for (std::size_t i = 0; i < folds.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t f = 0; f < result.size(); ++f) {
      if (static_cast<std::size_t>(folds[i]) == f) {
        result[f].held.push_back(row);
      } else if (labels[i] != kUnlabelled) {
        result[f].seen.push_back(row);
      }
    }
  }
  for (std::size_t f = 0; f < result.size(); ++f) {
    if (result[f].held.empty()) continue;
    result[f].classes = classes_of(labels, result[f].seen);
    if (result[f].classes.empty()) {
      throw std::invalid_argument("no row outside fold " + std::to_string(f) +
                                  " has a label, so that nothing can be trained for it");
    }
  }
  return result;
}

Features rows_of(const FeaturesView& X, const std::vector<Eigen::Index>& rows) {
  Features result(static_cast<Eigen::Index>(rows.size()), X.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) = X.row(rows[i]);
  }
  return result;
}

}  // namespace detail

SvmPredictions cross_validate_svm(const FeaturesView& X, const Labels& labels,
                                  const std::vector<int>& folds, const SvmOptions& options,
                                  int threads) {
  detail::require_features(X);
  detail::require_labels(labels, X.rows());
  detail::require_svm_options(options);
  threads = detail::resolve_threads(threads);
  const std::vector<detail::FoldRows> rows = detail::rows_of_folds(labels, folds);

  SvmPredictions result;
  result.labels.assign(labels.size(), kUnlabelled);
  std::vector<Eigen::Index> all(labels.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Eigen::Index>(i);
  result.classes = detail::classes_of(labels, all);
  if (options.probabilities) {
    result.probabilities =
        Features::Zero(X.rows(), static_cast<Eigen::Index>(result.classes.size()));
  }
  const auto column_of = [&](int label) {
    return std::lower_bound(result.classes.begin(), result.classes.end(), label) -
           result.classes.begin();
  };
  detail::parallel_blocks(
      static_cast<std::int64_t>(rows.size()), 1, threads, [&](std::int64_t f, std::int64_t) {
        const detail::FoldRows& fold = rows[static_cast<std::size_t>(f)];
        if (fold.held.empty()) return;
        if (fold.classes.size() == 1) {
          for (const Eigen::Index i : fold.held) {
            result.labels[static_cast<std::size_t>(i)] = fold.classes.front();
            if (options.probabilities) result.probabilities(i, column_of(fold.classes[0])) = 1.0;
          }
          return;
        }
        Labels seen;
        for (const Eigen::Index i : fold.seen) seen.push_back(labels[static_cast<std::size_t>(i)]);
        const Svm svm = Svm::train(detail::rows_of(X, fold.seen), seen, options, 1);
        const Features held = detail::rows_of(X, fold.held);
        const Labels predicted = svm.predict(held, 1);
        Features probable;
        if (options.probabilities) probable = svm.probabilities(held, 1);
        for (std::size_t i = 0; i < fold.held.size(); ++i) {
          result.labels[static_cast<std::size_t>(fold.held[i])] = predicted[i];
          for (Eigen::Index c = 0; c < probable.cols(); ++c) {
            result.probabilities(fold.held[i],
                                 column_of(svm.classes()[static_cast<std::size_t>(c)])) =
                probable(static_cast<Eigen::Index>(i), c);
          }
        }
      });
  return result;
}

}  // namespace shape3d::learning
