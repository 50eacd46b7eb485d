#include "shape3d/levelset/mixture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "message.hpp"
#include "random.hpp"

namespace shape3d::levelset {
namespace {

constexpr double kSqrtTwoPi = 2.5066282746310002;

/// The occupied bins.
struct Sample {
  Eigen::ArrayXd values, counts;
  double total = 0.0, mean = 0.0, variance = 0.0, floor = 0.0;
};

Sample occupied_bins(const Histogram& histogram, double min_deviation) {
  Sample sample;
  sample.values.resize(histogram.occupied());
  sample.counts.resize(sample.values.size());
  Eigen::Index next = 0;
  for (int b = 0; b < histogram.bins(); ++b) {
    if (!(histogram.counts[b] > 0.0)) continue;
    sample.values[next] = histogram.center(b);
    sample.counts[next++] = histogram.counts[b];
  }
  sample.total = sample.counts.sum();
  if (next == 0) return sample;
  sample.mean = (sample.values * sample.counts).sum() / sample.total;
  sample.variance = ((sample.values - sample.mean).square() * sample.counts).sum() / sample.total;
  const double deviation = min_deviation * (histogram.maximum - histogram.minimum);
  sample.floor = std::max({deviation * deviation, histogram.bin_width * histogram.bin_width / 12.0,
                           std::numeric_limits<double>::min()});
  return sample;
}

void sort_by_mean(GaussianMixture& mixture) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(mixture.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return mixture.means[a] < mixture.means[b];
  });
  const GaussianMixture old = mixture;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto to = static_cast<Eigen::Index>(k);
    mixture.weights[to] = old.weights[order[k]];
    mixture.means[to] = old.means[order[k]];
    mixture.variances[to] = old.variances[order[k]];
  }
}

/// π_k N(u; μ_k, σ_k²) of all bins (rows) and classes (columns); returns Σ counts · ln P.
double evaluate(const Sample& sample, const GaussianMixture& mixture, Eigen::ArrayXXd& densities) {
  densities.resize(sample.values.size(), mixture.size());
  for (int k = 0; k < mixture.size(); ++k) {
    const double scale = mixture.weights[k] / (kSqrtTwoPi * std::sqrt(mixture.variances[k]));
    densities.col(k) =
        scale * (-0.5 / mixture.variances[k] * (sample.values - mixture.means[k]).square()).exp();
  }
  // Bins far from every class have density 0 in double; the least positive number stands for it.
  return (sample.counts * densities.rowwise().sum().max(std::numeric_limits<double>::min()).log())
      .sum();
}

/// Weights, means and variances of classes that hold `shares` (bins × classes) of the samples.
void update(const Sample& sample, const Eigen::ArrayXXd& shares, GaussianMixture& mixture) {
  for (int k = 0; k < mixture.size(); ++k) {
    const double count = shares.col(k).sum();
    mixture.weights[k] = std::max(count, 1.0) / sample.total;
    if (count < 2.0) continue;  // too few to estimate a variance: the class keeps its shape
    mixture.means[k] = (shares.col(k) * sample.values).sum() / count;
    const double variance =
        (shares.col(k) * (sample.values - mixture.means[k]).square()).sum() / count;
    mixture.variances[k] = std::max(variance, sample.floor);
  }
  mixture.weights /= mixture.weights.sum();
}

/// Bin that holds the q-quantile.
Eigen::Index quantile_bin(const Sample& sample, double q) {
  double below = 0.0;
  for (Eigen::Index b = 0; b < sample.values.size(); ++b) {
    below += sample.counts[b];
    if (below >= q * sample.total) return b;
  }
  return sample.values.size() - 1;
}

/// Means at the quantiles (k + ½)/n, moved by 20 steps of Lloyd's k-means.
GaussianMixture spread_start(const Sample& sample, int classes) {
  GaussianMixture start;
  start.means.resize(classes);
  for (int k = 0; k < classes; ++k)
    start.means[k] = sample.values[quantile_bin(sample, (k + 0.5) / classes)];
  Eigen::ArrayXXd shares(sample.values.size(), classes);
  start.weights = Eigen::ArrayXd::Constant(classes, 1.0 / classes);
  start.variances =
      Eigen::ArrayXd::Constant(classes, std::max(sample.variance / classes, sample.floor));
  for (int step = 0; step < 20; ++step) {
    shares.setZero();
    for (Eigen::Index b = 0; b < sample.values.size(); ++b) {
      Eigen::Index nearest = 0;
      (start.means - sample.values[b]).abs().minCoeff(&nearest);
      shares(b, nearest) = sample.counts[b];
    }
    update(sample, shares, start);
  }
  return start;
}

/// Means drawn from the samples, the first evenly, the others by the square of the distance to
/// those drawn before (k-means++): starts from one peak alone would never leave it.
GaussianMixture random_start(const Sample& sample, int classes, detail::Random& random) {
  GaussianMixture start;
  start.means.resize(classes);
  Eigen::ArrayXd chances = sample.counts;
  for (int k = 0; k < classes; ++k) {
    const double place = random.uniform() * chances.sum();
    double below = 0.0;
    Eigen::Index bin = 0;
    for (Eigen::Index b = 0; b < chances.size(); ++b) {
      if (chances[b] > 0.0) bin = b;
      below += chances[b];
      if (below > place) break;
    }
    start.means[k] = sample.values[bin];
    const Eigen::ArrayXd square = (sample.values - start.means[k]).square();
    chances = k == 0 ? (sample.counts * square).eval() : chances.min(sample.counts * square).eval();
  }
  start.weights = Eigen::ArrayXd::Constant(classes, 1.0 / classes);
  start.variances =
      Eigen::ArrayXd::Constant(classes, std::max(sample.variance / classes, sample.floor));
  return start;
}

MixtureFit run_em(const Sample& sample, int classes, const MixtureOptions& options) {
  MixtureFit fit;
  fit.mixture = spread_start(sample, classes);
  fit.stop = MixtureStop::iteration_limit;
  Eigen::ArrayXXd densities;
  double likelihood = evaluate(sample, fit.mixture, densities);
  while (fit.iterations < options.iterations) {
    const Eigen::ArrayXd sums = densities.rowwise().sum().max(std::numeric_limits<double>::min());
    update(sample, densities.colwise() * (sample.counts / sums), fit.mixture);
    ++fit.iterations;
    const double before = likelihood;
    likelihood = evaluate(sample, fit.mixture, densities);
    fit.log_likelihoods.push_back(likelihood);
    if (likelihood - before <= options.tolerance * sample.total) {
      fit.stop = MixtureStop::converged;
      break;
    }
  }
  sort_by_mean(fit.mixture);
  return fit;
}

/// Draws the class of every sample from the posteriors.
void draw_classes(const Sample& sample, const Eigen::ArrayXXd& densities, detail::Random& random,
                  Eigen::ArrayXXd& shares) {
  const Eigen::Index classes = densities.cols();
  shares.resize(densities.rows(), classes);
  for (Eigen::Index b = 0; b < densities.rows(); ++b) {
    double left = sample.counts[b], rest = densities.row(b).sum();
    for (Eigen::Index k = 0; k + 1 < classes; ++k) {
      const double p =
          rest > 0.0 ? std::min(densities(b, k) / rest, 1.0) : 1.0 / static_cast<double>(classes);
      const double drawn = random.binomial(left, p);
      shares(b, k) = drawn;
      left -= drawn;
      rest -= densities(b, k);
    }
    shares(b, classes - 1) = left;
  }
}

MixtureFit run_sem(const Sample& sample, int classes, int chain, std::uint64_t seed) {
  MixtureFit fit;
  fit.stop = MixtureStop::chain_complete;
  detail::Random random(seed);
  GaussianMixture state = random_start(sample, classes, random);
  GaussianMixture sum{Eigen::ArrayXd::Zero(classes), Eigen::ArrayXd::Zero(classes),
                      Eigen::ArrayXd::Zero(classes)};
  Eigen::ArrayXXd densities, shares;
  double averaged = 0.0;
  fit.log_likelihoods.push_back(evaluate(sample, state, densities));
  for (int step = 0; step < chain; ++step) {
    draw_classes(sample, densities, random, shares);
    update(sample, shares, state);
    fit.log_likelihoods.push_back(evaluate(sample, state, densities));
    if (step < chain / 2) continue;
    GaussianMixture sorted = state;
    sort_by_mean(sorted);
    sum.weights += sorted.weights;
    sum.means += sorted.means;
    sum.variances += sorted.variances;
    averaged += 1.0;
  }
  fit.log_likelihoods.erase(fit.log_likelihoods.begin());  // that of the start
  fit.iterations = chain;
  fit.mixture = {sum.weights / averaged, sum.means / averaged, sum.variances / averaged};
  return fit;
}

MixtureFit best_sem(const Histogram& histogram, const Sample& sample, int classes,
                    const MixtureOptions& options) {
  MixtureFit best;
  std::vector<double> misfits;
  detail::Random seeds(options.seed);
  for (int run = 0; run < options.runs; ++run) {
    const auto seed = static_cast<std::uint64_t>(seeds.uniform() * 0x1p53);
    MixtureFit fit = run_sem(sample, classes, options.chain, seed);
    misfits.push_back(misfit(histogram, fit.mixture));
    if (run > 0 && !(misfits.back() < misfits[static_cast<std::size_t>(best.run)])) continue;
    best = std::move(fit);
    best.run = run;
  }
  best.run_misfits = std::move(misfits);
  return best;
}

double bayesian_criterion(double likelihood, int classes, double total) {
  return (3.0 * classes - 1.0) * std::log(total) - 2.0 * likelihood;
}

void check(const MixtureOptions& options) {
  using detail::require;
  require(options.classes >= 0 && options.classes <= 8, "classes", options.classes,
          "1 to 8, or 0 (automatic)");
  require(options.max_classes >= 1 && options.max_classes <= 8, "max_classes", options.max_classes,
          "1 to 8");
  require(options.iterations >= 1, "iterations", options.iterations, "at least 1");
  require(std::isfinite(options.tolerance) && options.tolerance >= 0.0, "tolerance",
          options.tolerance, "a finite number that is not negative");
  require(options.chain >= 2, "chain", options.chain, "at least 2");
  require(options.runs >= 1, "runs", options.runs, "at least 1");
  require(options.min_deviation >= 0.0 && options.min_deviation < 1.0, "min_deviation",
          options.min_deviation, "a share of the range, 0 to 1");
}

}  // namespace

double GaussianMixture::component(int k, double u) const {
  const double d = u - means[k];
  return weights[k] / (kSqrtTwoPi * std::sqrt(variances[k])) *
         std::exp(-0.5 * d * d / variances[k]);
}

double GaussianMixture::density(double u) const {
  double sum = 0.0;
  for (int k = 0; k < size(); ++k) sum += component(k, u);
  return sum;
}

std::string_view to_string(MixtureStop stop) {
  switch (stop) {
    case MixtureStop::converged:
      return "converged";
    case MixtureStop::iteration_limit:
      return "iteration_limit";
    case MixtureStop::chain_complete:
      return "chain_complete";
    case MixtureStop::given:
      return "given";
    case MixtureStop::too_few_bins:
      return "too_few_bins";
  }
  return "unknown";
}

MixtureFit fit_mixture(const Histogram& histogram, const MixtureOptions& options) {
  check(options);
  const Sample sample = occupied_bins(histogram, options.min_deviation);
  std::vector<double> criteria;
  int classes = options.classes;
  if (classes == 0) {
    for (int n = 1; n <= options.max_classes; ++n) {
      if (sample.values.size() < n) {
        criteria.push_back(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      const MixtureFit trial = run_em(sample, n, options);
      Eigen::ArrayXXd densities;
      criteria.push_back(
          bayesian_criterion(evaluate(sample, trial.mixture, densities), n, sample.total));
      if (classes == 0 || criteria.back() < criteria[static_cast<std::size_t>(classes - 1)])
        classes = n;
    }
    classes = std::max(classes, 1);
  }

  MixtureFit fit;
  if (sample.values.size() >= classes) {
    fit = options.method == MixtureMethod::em ? run_em(sample, classes, options)
                                              : best_sem(histogram, sample, classes, options);
    Eigen::ArrayXXd densities;
    fit.log_likelihood = evaluate(sample, fit.mixture, densities);
    fit.bic = bayesian_criterion(fit.log_likelihood, classes, sample.total);
    fit.misfit = misfit(histogram, fit.mixture);
  }
  fit.bic_by_classes = std::move(criteria);
  return fit;
}

double misfit(const Histogram& histogram, const GaussianMixture& mixture) {
  const Eigen::ArrayXd density = histogram.density();
  double sum = 0.0;
  for (int b = 0; b < histogram.bins(); ++b) {
    if (!(density[b] > 0.0)) continue;
    const double difference = mixture.density(histogram.center(b)) - density[b];
    sum += difference * difference / density[b] * histogram.bin_width;
  }
  return sum;
}

}  // namespace shape3d::levelset
