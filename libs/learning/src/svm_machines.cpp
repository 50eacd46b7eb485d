#include "svm_machines.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string>

#include "text.hpp"

namespace shape3d::learning::detail {

SvmRows::SvmRows(const FeaturesView& X) {
  const Eigen::Index length = X.cols() + 1;
  nodes_.resize(static_cast<std::size_t>(X.rows() * length));
  rows_.reserve(static_cast<std::size_t>(X.rows()));
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    svm_node* row = nodes_.data() + i * length;
    for (Eigen::Index j = 0; j < X.cols(); ++j) row[j] = {static_cast<int>(j) + 1, X(i, j)};
    row[X.cols()] = {-1, 0.0};
    rows_.push_back(row);
  }
}

SvmParameters::SvmParameters(const SvmOptions& options, const std::vector<int>& classes,
                             std::vector<double> weights)
    : labels_(classes), weights_(std::move(weights)) {
  libsvm.svm_type = C_SVC;
  libsvm.kernel_type = options.kernel == SvmKernel::rbf ? RBF : LINEAR;
  libsvm.degree = 3;
  libsvm.gamma = options.gamma;
  libsvm.cache_size = options.cache_mb;
  libsvm.eps = options.tolerance;
  libsvm.C = options.C;
  libsvm.nr_weight = static_cast<int>(labels_.size());
  libsvm.weight_label = labels_.data();
  libsvm.weight = weights_.data();
  libsvm.shrinking = 1;
}

SvmMachines train_machines(std::vector<svm_node*>& rows, const Labels& labels,
                           const svm_parameter& parameters) {
  static std::once_flag silent;  // libsvm keeps one function for the process
  std::call_once(silent, [] { svm_set_print_string_function([](const char*) {}); });
  std::vector<double> targets(labels.begin(), labels.end());
  svm_problem problem{};
  problem.l = static_cast<int>(rows.size());
  problem.y = targets.data();
  problem.x = rows.data();
  return SvmMachines(svm_train(&problem, &parameters));
}

void require_svm_options(const SvmOptions& options) {
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  require(positive(options.C), "C", options.C, "a positive number");
  require(options.gamma >= 0.0 && std::isfinite(options.gamma), "gamma", options.gamma,
          "0 for 1/d, or a positive number");
  require(positive(options.tolerance), "tolerance", options.tolerance, "a positive number");
  require(positive(options.cache_mb), "cache_mb", options.cache_mb, "a positive number");
  for (const double weight : options.class_weights) {
    require(positive(weight), "a class weight", weight, "a positive number");
  }
}

std::vector<int> classes_of(const Labels& labels, const std::vector<Eigen::Index>& members) {
  std::vector<int> classes;
  for (const Eigen::Index i : members) {
    const int label = labels[static_cast<std::size_t>(i)];
    if (label != kUnlabelled) classes.push_back(label);
  }
  std::sort(classes.begin(), classes.end());
  classes.erase(std::unique(classes.begin(), classes.end()), classes.end());
  return classes;
}

std::vector<double> weights_of_classes(const SvmOptions& options, const Labels& labels,
                                       const std::vector<Eigen::Index>& members,
                                       const std::vector<int>& classes) {
  std::vector<double> weights(classes.size(), 1.0);
  for (std::size_t c = 0; c < classes.size(); ++c) {
    if (options.balanced) {
      const auto count = std::count_if(members.begin(), members.end(), [&](Eigen::Index i) {
        return labels[static_cast<std::size_t>(i)] == classes[c];
      });
      weights[c] = static_cast<double>(members.size()) /
                   (static_cast<double>(classes.size()) * static_cast<double>(count));
    }
    if (options.class_weights.empty()) continue;
    const auto place = static_cast<std::size_t>(classes[c]);
    if (place >= options.class_weights.size()) {
      throw std::invalid_argument("there are " + std::to_string(options.class_weights.size()) +
                                  " class weights, expected one for each label up to " +
                                  std::to_string(classes.back()));
    }
    weights[c] *= options.class_weights[place];
  }
  return weights;
}

}  // namespace shape3d::learning::detail
