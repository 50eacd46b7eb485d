#include "shape3d/learning/svm.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "checks.hpp"
#include "parallel.hpp"
#include "svm_state.hpp"

namespace shape3d::learning {
namespace {

constexpr Eigen::Index kPredictBlock = 64;

// The sigmoids of all pairs of classes, in the order of libsvm.
void fit_sigmoids(const std::vector<svm_node*>& rows, const Labels& labels,
                  const std::vector<int>& order, const detail::SvmParameters& parameters,
                  const SvmOptions& options, int threads, Eigen::VectorXd& a, Eigen::VectorXd& b) {
  std::vector<std::array<std::size_t, 2>> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) pairs.push_back({i, j});
  }
  const auto weight_of = [&](int label) {
    const svm_parameter& p = parameters.libsvm;
    return p
        .weight[std::find(p.weight_label, p.weight_label + p.nr_weight, label) - p.weight_label];
  };
  a.resize(static_cast<Eigen::Index>(pairs.size()));
  b.resize(a.size());
  detail::parallel_blocks(a.size(), 1, threads, [&](std::int64_t p, std::int64_t) {
    const auto [i, j] = pairs[static_cast<std::size_t>(p)];
    std::vector<svm_node*> members;
    std::vector<bool> is_first;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (labels[row] != order[i] && labels[row] != order[j]) continue;
      members.push_back(rows[row]);
      is_first.push_back(labels[row] == order[i]);
    }
    const detail::Sigmoid s =
        detail::pair_sigmoid(members, is_first, parameters.libsvm, weight_of(order[i]),
                             weight_of(order[j]), options.seed);
    a(p) = s.a;
    b(p) = s.b;
  });
}

std::string only_class(const std::vector<int>& classes) {
  return classes.empty() ? "no row has a label"
                         : "all labelled rows are of class " + std::to_string(classes.front());
}

}  // namespace

Svm::Svm(std::shared_ptr<const State> state) : state_(std::move(state)) {}

Svm Svm::train(const FeaturesView& X, const Labels& labels, const SvmOptions& options,
               int threads) {
  detail::require_features(X);
  detail::require_labels(labels, X.rows());
  detail::require_svm_options(options);
  threads = detail::resolve_threads(threads);
  std::vector<Eigen::Index> members;
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    if (labels[static_cast<std::size_t>(i)] != kUnlabelled) members.push_back(i);
  }
  const std::vector<int> classes = detail::classes_of(labels, members);
  if (classes.size() < 2) {
    throw std::invalid_argument(only_class(classes) + ", expected two classes or more");
  }

  Features seen(static_cast<Eigen::Index>(members.size()), X.cols());
  Labels seen_labels;
  for (std::size_t i = 0; i < members.size(); ++i) {
    seen.row(static_cast<Eigen::Index>(i)) = X.row(members[i]);
    seen_labels.push_back(labels[static_cast<std::size_t>(members[i])]);
  }
  auto state = std::make_shared<State>();
  state->options = options;
  if (options.gamma == 0.0) state->options.gamma = 1.0 / static_cast<double>(X.cols());
  state->scaling = fit_scaling(seen, options.scaling);
  detail::SvmRows nodes(state->scaling.apply(seen));
  std::vector<svm_node*> rows(nodes.data(), nodes.data() + members.size());
  const detail::SvmParameters parameters(
      state->options, classes, detail::weights_of_classes(options, labels, members, classes));
  state->take(*detail::train_machines(rows, seen_labels, parameters.libsvm));
  if (options.probabilities) {
    fit_sigmoids(rows, seen_labels, state->order, parameters, options, threads, state->sigmoid_a,
                 state->sigmoid_b);
  }
  state->connect();
  return Svm(std::move(state));
}

Labels Svm::predict(const FeaturesView& X, int threads) const {
  const Features scaled = state_->scaling.apply(X);
  Labels result(static_cast<std::size_t>(X.rows()));
  detail::parallel_blocks(X.rows(), kPredictBlock, detail::resolve_threads(threads),
                          [&](std::int64_t first, std::int64_t last) {
                            const detail::SvmRows rows(scaled.middleRows(first, last - first));
                            for (std::int64_t i = first; i < last; ++i) {
                              result[static_cast<std::size_t>(i)] =
                                  static_cast<int>(svm_predict(state_->libsvm(), rows[i - first]));
                            }
                          });
  return result;
}

Features Svm::probabilities(const FeaturesView& X, int threads) const {
  if (state_->sigmoid_a.size() == 0) {
    throw std::invalid_argument("the SVM was trained without probabilities");
  }
  const Features scaled = state_->scaling.apply(X);
  const std::vector<int>& order = state_->order;
  std::vector<Eigen::Index> column;  // of each class of `order`
  for (const int label : order) {
    column.push_back(std::lower_bound(classes().begin(), classes().end(), label) -
                     classes().begin());
  }
  Features result(X.rows(), static_cast<Eigen::Index>(order.size()));
  detail::parallel_blocks(X.rows(), kPredictBlock, detail::resolve_threads(threads),
                          [&](std::int64_t first, std::int64_t last) {
                            const detail::SvmRows rows(scaled.middleRows(first, last - first));
                            std::vector<double> estimates(order.size());
                            for (std::int64_t i = first; i < last; ++i) {
                              svm_predict_probability(state_->libsvm(), rows[i - first],
                                                      estimates.data());
                              for (std::size_t c = 0; c < order.size(); ++c)
                                result(i, column[c]) = estimates[c];
                            }
                          });
  return result;
}

Eigen::MatrixXd Svm::decision_values(const FeaturesView& X, int threads) const {
  const Features scaled = state_->scaling.apply(X);
  Features result(X.rows(), state_->pairs());
  detail::parallel_blocks(X.rows(), kPredictBlock, detail::resolve_threads(threads),
                          [&](std::int64_t first, std::int64_t last) {
                            const detail::SvmRows rows(scaled.middleRows(first, last - first));
                            for (std::int64_t i = first; i < last; ++i) {
                              svm_predict_values(state_->libsvm(), rows[i - first],
                                                 result.row(i).data());
                            }
                          });
  return result;
}

const std::vector<int>& Svm::classes() const { return state_->classes; }
const std::vector<int>& Svm::order() const { return state_->order; }
Eigen::Index Svm::dimension() const { return state_->scaling.offset.size(); }
Eigen::Index Svm::support_vectors() const { return state_->vectors.rows(); }
const SvmOptions& Svm::options() const { return state_->options; }
const Scaling& Svm::scaling() const { return state_->scaling; }

}  // namespace shape3d::learning
