#include "shape3d/learning/confusion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace shape3d::learning {
namespace {

void require_equal_lengths(const Labels& truth, const Labels& predicted, const char* name) {
  if (truth.size() == predicted.size()) return;
  throw std::invalid_argument(std::string(name) + " has " + std::to_string(predicted.size()) +
                              " labels, expected " + std::to_string(truth.size()) +
                              " as truth has");
}

// Σ_{k ≤ most} C(n, k) / 2^n.
double binomial_tail(int n, int most) {
  double sum = 0.0;
  for (int k = 0; k <= most; ++k) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) -
                    n * std::log(2.0));
  }
  return sum;
}

}  // namespace

int Confusion::total() const { return counts.size() == 0 ? 0 : counts.sum(); }

double Confusion::correct_rate() const {
  const int all = total();
  return all == 0 ? 0.0 : counts.trace() / static_cast<double>(all);
}

double Confusion::balanced_rate() const {
  double sum = 0.0;
  int classes = 0;
  for (Eigen::Index c = 0; c < counts.rows(); ++c) {
    const int items = counts.row(c).sum();
    if (items == 0) continue;
    sum += counts(c, c) / static_cast<double>(items);
    ++classes;
  }
  return classes == 0 ? 0.0 : sum / classes;
}

double Confusion::majority_rate() const {
  const int all = total();
  return all == 0 ? 0.0 : counts.rowwise().sum().maxCoeff() / static_cast<double>(all);
}

Confusion confusion(const Labels& truth, const Labels& predicted, int classes) {
  require_equal_lengths(truth, predicted, "predicted");
  if (classes < 0) {
    throw std::invalid_argument("classes is " + std::to_string(classes) + ", expected 0 or more");
  }
  Confusion result;
  result.counts = Eigen::MatrixXi::Zero(classes, classes);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] == kUnlabelled) continue;
    for (const auto& [name, label] :
         {std::pair{"truth", truth[i]}, std::pair{"predicted", predicted[i]}}) {
      if (label < 0 || label >= classes) {
        throw std::invalid_argument(std::string(name) + " " + std::to_string(i) + " is " +
                                    std::to_string(label) + ", expected less than " +
                                    std::to_string(classes) + ", the number of classes");
      }
    }
    ++result.counts(truth[i], predicted[i]);
  }
  return result;
}

PairedTest paired_test(const Labels& truth, const Labels& first, const Labels& second) {
  require_equal_lengths(truth, first, "first");
  require_equal_lengths(truth, second, "second");
  PairedTest result;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool a = first[i] == truth[i], b = second[i] == truth[i];
    if (a && !b) ++result.first_only;
    if (b && !a) ++result.second_only;
  }
  const int n = result.first_only + result.second_only;
  const int less = std::min(result.first_only, result.second_only);
  result.p = n == 0 ? 1.0 : std::min(1.0, 2.0 * binomial_tail(n, less));
  return result;
}

}  // namespace shape3d::learning
