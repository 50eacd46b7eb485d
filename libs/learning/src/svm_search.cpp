#include "shape3d/learning/svm_search.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "checks.hpp"
#include "parallel.hpp"
#include "svm_folds.hpp"
#include "svm_machines.hpp"
#include "text.hpp"

namespace shape3d::learning {
namespace {

// What is the same for all pairs of the grid.
struct Fold {
  detail::SvmRows seen_rows, held_rows;
  Labels seen_labels, held_labels;
  std::vector<int> classes;
  std::vector<double> weights;
};

Fold prepare(const FeaturesView& X, const Labels& labels, const detail::FoldRows& rows,
             const SvmOptions& options) {
  Fold fold;
  fold.classes = rows.classes;
  for (const Eigen::Index i : rows.seen) {
    fold.seen_labels.push_back(labels[static_cast<std::size_t>(i)]);
  }
  std::vector<Eigen::Index> judged;  // rows that can be right
  for (const Eigen::Index i : rows.held) {
    const int label = labels[static_cast<std::size_t>(i)];
    if (!std::binary_search(rows.classes.begin(), rows.classes.end(), label)) continue;
    judged.push_back(i);
    fold.held_labels.push_back(label);
  }
  const Features seen = detail::rows_of(X, rows.seen);
  const Scaling scaling = fit_scaling(seen, options.scaling);
  fold.seen_rows = detail::SvmRows(scaling.apply(seen));
  fold.held_rows = detail::SvmRows(scaling.apply(detail::rows_of(X, judged)));
  fold.weights = detail::weights_of_classes(options, labels, rows.seen, rows.classes);
  return fold;
}

int correct(Fold& fold, const SvmOptions& options) {
  int count = 0;
  if (fold.classes.size() == 1) return static_cast<int>(fold.held_labels.size());
  const detail::SvmParameters parameters(options, fold.classes, fold.weights);
  std::vector<svm_node*> rows(fold.seen_rows.data(),
                              fold.seen_rows.data() + fold.seen_labels.size());
  const detail::SvmMachines machines =
      detail::train_machines(rows, fold.seen_labels, parameters.libsvm);
  for (std::size_t i = 0; i < fold.held_labels.size(); ++i) {
    const double predicted =
        svm_predict(machines.get(), fold.held_rows[static_cast<Eigen::Index>(i)]);
    if (static_cast<int>(predicted) == fold.held_labels[i]) ++count;
  }
  return count;
}

void require_list(const std::vector<double>& values, const char* name) {
  if (values.empty()) {
    throw std::invalid_argument(std::string("the grid has no ") + name + ", expected at least one");
  }
  for (const double value : values) {
    detail::require(value > 0.0 && std::isfinite(value), name, value, "a positive number");
  }
}

}  // namespace

SvmGrid default_svm_grid(SvmKernel kernel) {
  SvmGrid grid;
  for (int power = -5; power <= 15; power += 2) grid.C.push_back(std::ldexp(1.0, power));
  if (kernel == SvmKernel::linear) {
    grid.gamma = {1.0};
    return grid;
  }
  for (int power = -15; power <= 3; power += 2) grid.gamma.push_back(std::ldexp(1.0, power));
  return grid;
}

SvmSearch search_svm(const FeaturesView& X, const Labels& labels, const std::vector<int>& folds,
                     const SvmOptions& options, const SvmGrid& grid, int threads,
                     const std::function<bool(double)>& progress) {
  detail::require_features(X);
  detail::require_labels(labels, X.rows());
  detail::require_svm_options(options);
  require_list(grid.C, "C");
  require_list(grid.gamma, "gamma");
  threads = detail::resolve_threads(threads);
  std::vector<Fold> prepared;
  std::size_t judged = 0;
  for (const detail::FoldRows& rows : detail::rows_of_folds(labels, folds)) {
    if (rows.held.empty()) continue;
    prepared.push_back(prepare(X, labels, rows, options));
    judged += prepared.back().held_labels.size();
  }
  if (judged == 0) {
    throw std::invalid_argument(
        "no row is of a class that occurs in another fold, expected classes of two members or "
        "more");
  }

  // The dearest machines, those of large C, are trained first, so that no thread is left with one.
  const auto n_gamma = static_cast<std::int64_t>(grid.gamma.size());
  const auto n_folds = static_cast<std::int64_t>(prepared.size());
  const auto pairs = static_cast<std::int64_t>(grid.C.size()) * n_gamma;
  std::vector<int> right(static_cast<std::size_t>(pairs * n_folds), 0);
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::int64_t done = 0;
  detail::parallel_blocks(pairs * n_folds, 1, threads, [&](std::int64_t task, std::int64_t) {
    if (stop) return;
    const std::int64_t place = pairs * n_folds - 1 - task;
    const std::int64_t pair = place / n_folds;
    SvmOptions tried = options;
    tried.C = grid.C[static_cast<std::size_t>(pair / n_gamma)];
    tried.gamma = grid.gamma[static_cast<std::size_t>(pair % n_gamma)];
    right[static_cast<std::size_t>(place)] =
        correct(prepared[static_cast<std::size_t>(place % n_folds)], tried);
    if (!progress) return;
    const std::lock_guard<std::mutex> lock(mutex);
    ++done;
    if (!progress(static_cast<double>(done) / static_cast<double>(pairs * n_folds))) stop = true;
  });

  SvmSearch search;
  search.cancelled = stop;
  search.best = -1.0;
  search.correct_rate.resize(static_cast<Eigen::Index>(grid.C.size()), n_gamma);
  for (std::int64_t pair = 0; pair < pairs; ++pair) {
    int sum = 0;
    for (std::int64_t f = 0; f < n_folds; ++f) {
      sum += right[static_cast<std::size_t>(pair * n_folds + f)];
    }
    const double rate = stop ? std::numeric_limits<double>::quiet_NaN()
                             : static_cast<double>(sum) / static_cast<double>(judged);
    search.correct_rate(pair / n_gamma, pair % n_gamma) = rate;
    if (rate <= search.best || stop) continue;
    search.best = rate;
    search.C = grid.C[static_cast<std::size_t>(pair / n_gamma)];
    search.gamma = grid.gamma[static_cast<std::size_t>(pair % n_gamma)];
  }
  return search;
}

}  // namespace shape3d::learning
