#include <algorithm>
#include <cmath>

#include "shape3d/learning/folds.hpp"
#include "svm_machines.hpp"

namespace shape3d::learning::detail {
namespace {

// −log likelihood of one target t at z = a f + b: t z + log(1 + e^−z), without overflow.
double loss(double t, double z) {
  return z >= 0.0 ? t * z + std::log1p(std::exp(-z)) : (t - 1.0) * z + std::log1p(std::exp(z));
}

double total_loss(const std::vector<double>& decisions, const std::vector<double>& targets,
                  const Sigmoid& s) {
  double sum = 0.0;
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    sum += loss(targets[i], s.a * decisions[i] + s.b);
  }
  return sum;
}

}  // namespace

Sigmoid fit_sigmoid(const std::vector<double>& decisions, const std::vector<bool>& is_first) {
  const double first = static_cast<double>(std::count(is_first.begin(), is_first.end(), true));
  const double second = static_cast<double>(is_first.size()) - first;
  std::vector<double> targets;
  targets.reserve(is_first.size());
  for (const bool yes : is_first) {
    targets.push_back(yes ? (first + 1.0) / (first + 2.0) : 1.0 / (second + 2.0));
  }

  Sigmoid s{0.0, std::log((second + 1.0) / (first + 1.0))};
  double value = total_loss(decisions, targets, s);
  for (int iteration = 0; iteration < 100; ++iteration) {
    double gradient_a = 0.0;
    double gradient_b = 0.0;
    double aa = 1e-12;  // keeps the Hessian positive definite
    double ab = 0.0;
    double bb = 1e-12;
    for (std::size_t i = 0; i < decisions.size(); ++i) {
      const double z = s.a * decisions[i] + s.b;
      const double e = std::exp(-std::abs(z));
      const double p = (z >= 0.0 ? e : 1.0) / (1.0 + e);
      const double curvature = e / ((1.0 + e) * (1.0 + e));
      gradient_a += decisions[i] * (targets[i] - p);
      gradient_b += targets[i] - p;
      aa += decisions[i] * decisions[i] * curvature;
      ab += decisions[i] * curvature;
      bb += curvature;
    }
    if (std::abs(gradient_a) < 1e-5 && std::abs(gradient_b) < 1e-5) break;
    const double determinant = aa * bb - ab * ab;
    const double step_a = -(bb * gradient_a - ab * gradient_b) / determinant;
    const double step_b = -(aa * gradient_b - ab * gradient_a) / determinant;
    const double slope = gradient_a * step_a + gradient_b * step_b;
    double step = 1.0;
    for (; step >= 1e-10; step /= 2.0) {
      const Sigmoid tried{s.a + step * step_a, s.b + step * step_b};
      const double tried_value = total_loss(decisions, targets, tried);
      if (tried_value >= value + 1e-4 * step * slope) continue;
      s = tried;
      value = tried_value;
      break;
    }
    if (step < 1e-10) break;  // as near as the arithmetic allows
  }
  return s;
}

Sigmoid pair_sigmoid(const std::vector<svm_node*>& rows, const std::vector<bool>& is_first,
                     const svm_parameter& parameters, double first_weight, double second_weight,
                     std::uint64_t seed) {
  const std::size_t count = rows.size();
  Labels labels;  // 0 for the first class
  labels.reserve(count);
  for (const bool yes : is_first) labels.push_back(yes ? 0 : 1);
  const int k = static_cast<int>(std::min<std::size_t>(5, count));
  const std::vector<int> folds = stratified_folds(labels, k, seed);

  svm_parameter pair = parameters;
  std::vector<int> names{0, 1};
  std::vector<double> weights{first_weight, second_weight};
  pair.nr_weight = 2;
  pair.weight_label = names.data();
  pair.weight = weights.data();
  std::vector<double> decisions(count, 0.0);
  for (int fold = 0; fold < k; ++fold) {
    std::vector<svm_node*> seen;
    Labels seen_labels;
    for (std::size_t i = 0; i < count; ++i) {
      if (folds[i] == fold) continue;
      seen.push_back(rows[i]);
      seen_labels.push_back(labels[i]);
    }
    const auto firsts = std::count(seen_labels.begin(), seen_labels.end(), 0);
    const bool one_class = firsts == 0 || firsts == static_cast<std::ptrdiff_t>(seen.size());
    SvmMachines machine;
    if (!one_class) machine = train_machines(seen, seen_labels, pair);
    for (std::size_t i = 0; i < count; ++i) {
      if (folds[i] != fold) continue;
      if (one_class) {
        decisions[i] = firsts > 0 ? 1.0 : -1.0;
        continue;
      }
      svm_predict_values(machine.get(), rows[i], &decisions[i]);
      if (machine->label[0] == 1) decisions[i] = -decisions[i];
    }
  }
  return fit_sigmoid(decisions, is_first);
}

}  // namespace shape3d::learning::detail
