#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "shape3d/levelset/export.hpp"
#include "shape3d/levelset/histogram.hpp"

namespace shape3d::levelset {

/// P(u) = Σ_k π_k N(u; μ_k, σ_k²), k = 1 … n (dissertation, 3.3). Classes are sorted by mean.
struct GaussianMixture {
  Eigen::ArrayXd weights;    ///< π_k ≥ 0, of sum 1.
  Eigen::ArrayXd means;      ///< μ_k, ascending.
  Eigen::ArrayXd variances;  ///< σ_k² > 0 (3.3 as printed calls σ_k the variance).

  [[nodiscard]] int size() const { return static_cast<int>(means.size()); }
  /// π_k N(u; μ_k, σ_k²).
  [[nodiscard]] SHAPE3D_LEVELSET_EXPORT double component(int k, double u) const;
  /// P(u).
  [[nodiscard]] SHAPE3D_LEVELSET_EXPORT double density(double u) const;
};

/// How the mixture is estimated.
enum class MixtureMethod {
  em,            ///< Expectation-maximisation from means at quantiles of H: no randomness.
  stochastic_em  ///< The class of each sample is drawn (Masson and Pieczynski); several runs from
                 ///< random starts, the one of least misfit() is kept.
};

/// Settings of fit_mixture().
struct MixtureOptions {
  MixtureMethod method = MixtureMethod::stochastic_em;
  int classes = 3;          ///< n, 1 … 8; 0: the number up to max_classes of least BIC, by EM.
  int max_classes = 5;      ///< For classes = 0; 1 … 8.
  int iterations = 200;     ///< EM: at most; at least 1.
  double tolerance = 1e-7;  ///< EM stops when the log-likelihood per sample rises by less.
  int chain = 60;          ///< SEM: iterations of one run; at least 2. The second half is averaged.
  int runs = 5;            ///< SEM: runs with different random numbers; at least 1.
  std::uint64_t seed = 1;  ///< SEM. The same seed gives the same result.
  /// No σ_k² falls under (min_deviation · range of H)², nor under a twelfth of the squared bin
  /// width.
  double min_deviation = 0.002;
};

/// Why an estimation stopped.
enum class MixtureStop {
  converged,        ///< EM: the likelihood rose by less than the tolerance.
  iteration_limit,  ///< EM: all iterations done.
  chain_complete,   ///< SEM.
  given,            ///< Nothing was estimated: SegmentOptions::known_mixture.
  too_few_bins      ///< H has fewer occupied bins than classes; the mixture is empty.
};

/// "converged", "iteration_limit" … as spelled in the enumeration.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT std::string_view to_string(MixtureStop stop);

/// Outcome of fit_mixture().
struct MixtureFit {
  GaussianMixture mixture;
  MixtureStop stop = MixtureStop::too_few_bins;
  int iterations = 0;               ///< Done in the run kept.
  double log_likelihood = 0.0;      ///< Σ_u H(u) ln P(u) over samples, of the mixture returned.
  double bic = 0.0;                 ///< (3n − 1) ln N − 2 log_likelihood; least is best.
  double misfit = 0.0;              ///< misfit(histogram, mixture).
  int run = 0;                      ///< SEM: the run kept.
  std::vector<double> run_misfits;  ///< SEM: of each run.
  std::vector<double> log_likelihoods;  ///< After each iteration of the run kept.
  std::vector<double> bic_by_classes;  ///< With classes = 0: [n − 1]: of n classes (NaN: no fit).
};

/// Fits a mixture of Gaussians to a histogram, each sample at the centre of its bin.
///
/// EM raises the likelihood at every step (but where the variance floor holds it back). SEM draws
/// the classes of the samples of each bin by the posterior, multinomially, which is the same as
/// drawing them one by one; parameters of a class that got fewer than two samples are kept. Means
/// are sorted at the end of each run, so that classes have the same number in all runs.
///
/// @throws std::invalid_argument  an option is outside its range; the message names it.
/// O(iterations · bins · n). Deterministic for a seed.
/// @cite dissertation (3.3); Dempster et al. 1977; Masson and Pieczynski 1993.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT MixtureFit fit_mixture(const Histogram& histogram,
                                                             const MixtureOptions& options = {});

/// ∫ (P − H)² / H du over the occupied bins, H of integral 1: the integral of (3.10), weighted by H
/// so that a bin of one sample does not count as much as the peak. 0: the histogram is the mixture.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT double misfit(const Histogram& histogram,
                                                    const GaussianMixture& mixture);

}  // namespace shape3d::levelset
