#include "shape3d/levelset/intensity_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "message.hpp"

namespace shape3d::levelset {
namespace {

constexpr int kSteps = 4096;
/// Least variance of a class beside the largest, where Λ is formed.
constexpr double kVarianceRatio = 1.0 / 16.0;

/// ln Σ π_k N(u; μ_k, σ_k²) over the classes with the flag `side`, stable where all underflow.
double log_density(const GaussianMixture& mixture, const std::vector<bool>& inside, bool side,
                   double u) {
  const double least = kVarianceRatio * mixture.variances.maxCoeff();
  double greatest = -std::numeric_limits<double>::infinity(), sum = 0.0;
  for (int k = 0; k < mixture.size(); ++k) {
    if (inside[static_cast<std::size_t>(k)] != side || !(mixture.weights[k] > 0.0)) continue;
    const double variance = std::max(mixture.variances[k], least), d = u - mixture.means[k];
    const double term =
        std::log(mixture.weights[k]) - 0.5 * std::log(variance) - 0.5 * d * d / variance;
    if (term > greatest) {
      sum = sum * std::exp(greatest - term) + 1.0;
      greatest = term;
    } else {
      sum += std::exp(term - greatest);
    }
  }
  return greatest + std::log(sum);
}

/// Split k (classes 0 … k−1 below, k … n−1 above) with the largest variance between the groups.
int best_split(const GaussianMixture& mixture) {
  int best = mixture.size() > 1 ? 1 : 0;
  double best_value = -1.0;
  for (int split = 1; split < mixture.size(); ++split) {
    const int above = mixture.size() - split;
    const double w0 = mixture.weights.head(split).sum(), w1 = mixture.weights.tail(above).sum();
    if (!(w0 > 0.0 && w1 > 0.0)) continue;
    const double m0 = (mixture.weights.head(split) * mixture.means.head(split)).sum() / w0;
    const double m1 = (mixture.weights.tail(above) * mixture.means.tail(above)).sum() / w1;
    const double value = w0 * w1 * (m1 - m0) * (m1 - m0);
    if (value > best_value) {
      best_value = value;
      best = split;
    }
  }
  return best;
}

}  // namespace

IntensityModel::IntensityModel(GaussianMixture mixture, std::vector<bool> inside)
    : mixture_(std::move(mixture)), inside_(std::move(inside)) {
  if (!two_sided()) return;
  table_.resize(kSteps + 1);
  const double least = mixture_.means[0], span = mixture_.means[mixture_.size() - 1] - least;
  for (int step = 0; step <= kSteps; ++step) {
    const double u = least + span * step / kSteps;
    table_[step] =
        log_density(mixture_, inside_, true, u) - log_density(mixture_, inside_, false, u);
  }
  if (is_split()) {
    // A wide class can overtake a narrow one again near its mean: Λ is made monotone.
    const bool rising = inside_.back();
    for (int step = 1; step <= kSteps; ++step) {
      table_[step] = rising ? std::max(table_[step], table_[step - 1])
                            : std::min(table_[step], table_[step - 1]);
    }
  }
  min_log_odds_ = table_.minCoeff();
  max_log_odds_ = table_.maxCoeff();
}

bool IntensityModel::two_sided() const {
  return std::find(inside_.begin(), inside_.end(), true) != inside_.end() &&
         std::find(inside_.begin(), inside_.end(), false) != inside_.end();
}

bool IntensityModel::is_split() const {
  return two_sided() && (std::is_sorted(inside_.begin(), inside_.end()) ||
                         std::is_sorted(inside_.rbegin(), inside_.rend()));
}

double IntensityModel::density_inside(double u) const {
  double sum = 0.0;
  for (int k = 0; k < mixture_.size(); ++k)
    if (inside_[static_cast<std::size_t>(k)]) sum += mixture_.component(k, u);
  return sum;
}

double IntensityModel::density_outside(double u) const {
  double sum = 0.0;
  for (int k = 0; k < mixture_.size(); ++k)
    if (!inside_[static_cast<std::size_t>(k)]) sum += mixture_.component(k, u);
  return sum;
}

double IntensityModel::log_odds(double u) const {
  if (table_.size() == 0) {
    const double infinity = std::numeric_limits<double>::infinity();
    return !inside_.empty() && inside_.front() ? infinity : -infinity;
  }
  const double least = mixture_.means[0], span = mixture_.means[mixture_.size() - 1] - least;
  const double at = span > 0.0 ? std::clamp((u - least) / span, 0.0, 1.0) * kSteps : 0.0;
  const int step = std::min(static_cast<int>(at), kSteps - 1);
  const double t = at - step;
  return (1.0 - t) * table_[step] + t * table_[step + 1];
}

double IntensityModel::phi(double u, double w) const { return -std::tanh(0.5 * log_odds(u)) - w; }

std::vector<double> IntensityModel::levels(double lambda) const {
  std::vector<double> found;
  if (table_.size() == 0) return found;
  const double least = mixture_.means[0], span = mixture_.means[mixture_.size() - 1] - least;
  for (int step = 0; step < kSteps; ++step) {
    const double a = table_[step] - lambda, b = table_[step + 1] - lambda;
    if ((a < 0.0) == (b < 0.0)) continue;
    found.push_back(least + span * (step + a / (a - b)) / kSteps);
  }
  return found;
}

double IntensityModel::signed_level_distance(double u, const std::vector<double>& levels,
                                             double lambda) const {
  const bool is_inside = log_odds(u) > lambda;
  double distance = std::numeric_limits<double>::infinity();
  for (const double level : levels) distance = std::min(distance, std::abs(u - level));
  return is_inside ? distance : -distance;
}

double offset_of_log_odds(double lambda) { return -std::tanh(0.5 * lambda); }

IntensityModel make_intensity_model(const GaussianMixture& mixture, const InsideOptions& options) {
  if (mixture.size() == 0) detail::refuse("mixture", "empty", "at least one class");
  const auto classes = static_cast<std::size_t>(mixture.size());
  std::vector<bool> inside(classes, false);
  switch (options.inside) {
    case Inside::bright:
    case Inside::dark: {
      const auto split = static_cast<std::size_t>(best_split(mixture));
      for (std::size_t k = 0; k < classes; ++k)
        inside[k] = (k >= split) == (options.inside == Inside::bright);
      break;
    }
    case Inside::classes:
      for (const int k : options.classes) {
        detail::require(k >= 0 && k < mixture.size(), "class inside", k,
                        "a number from 0 to that of the last class");
        detail::require(!inside[static_cast<std::size_t>(k)], "class inside", k,
                        "each class to be named once");
        inside[static_cast<std::size_t>(k)] = true;
      }
      break;
  }
  return {mixture, inside};
}

}  // namespace shape3d::levelset
