#include "shape3d/levelset/local_mixture.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "message.hpp"
#include "samples.hpp"
#include "shape3d/levelset/gradient.hpp"

namespace shape3d::levelset {
namespace {

double median_in_ball(const ImageView& image, const Eigen::Vector3d& seed, double radius) {
  std::array<std::int64_t, 3> nearest{}, lower{}, upper{};
  for (int axis = 0; axis < 3; ++axis) {
    const double reach = radius / image.spacing[axis];
    const std::int64_t last = image.dims[axis] - 1;
    nearest[axis] = std::lround(seed[axis]);
    lower[axis] = std::max<std::int64_t>(
        0, std::min(nearest[axis], static_cast<std::int64_t>(std::ceil(seed[axis] - reach))));
    upper[axis] = std::min(
        last, std::max(nearest[axis], static_cast<std::int64_t>(std::floor(seed[axis] + reach))));
  }
  std::vector<float> row(static_cast<std::size_t>(image.dims[0])), values;
  for (std::int64_t k = lower[2]; k <= upper[2]; ++k) {
    for (std::int64_t j = lower[1]; j <= upper[1]; ++j) {
      detail::load_row(image, j, k, row.data());
      for (std::int64_t i = lower[0]; i <= upper[0]; ++i) {
        const Eigen::Vector3d p(static_cast<double>(i), static_cast<double>(j),
                                static_cast<double>(k));
        if ((p - seed).cwiseProduct(image.spacing).norm() <= radius ||
            nearest == std::array<std::int64_t, 3>{i, j, k})
          values.push_back(row[static_cast<std::size_t>(i)]);
      }
    }
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

/// Counts under a Gaussian; what lies beyond the ends is empty.
Eigen::ArrayXd smoothed(const Eigen::ArrayXd& counts, double sigma) {
  if (!(sigma > 0.0)) return counts;
  const auto reach = static_cast<Eigen::Index>(std::ceil(3.0 * sigma));
  Eigen::ArrayXd result = Eigen::ArrayXd::Zero(counts.size());
  for (Eigen::Index t = -reach; t <= reach; ++t) {
    const double weight = std::exp(-0.5 * static_cast<double>(t * t) / (sigma * sigma));
    const Eigen::Index begin = std::max<Eigen::Index>(0, -t);
    const Eigen::Index length = counts.size() - std::abs(t);
    if (length > 0) result.segment(begin, length) += weight * counts.segment(begin + t, length);
  }
  return result;
}

/// The intensity round an object: see local_mixture().
double surroundings(const Histogram& histogram, double object, bool dark, double noise) {
  const Eigen::ArrayXd counts = smoothed(histogram.counts, noise / histogram.bin_width);
  double around = dark ? histogram.maximum : histogram.minimum;
  constexpr int kSteps = 32;
  for (int step = 0; step < kSteps; ++step) {
    const double half_way = 0.5 * (object + around), before = around;
    double most = -1.0;
    for (int bin = 0; bin < histogram.bins(); ++bin) {
      const double u = histogram.center(bin);
      if ((dark ? u > half_way : u < half_way) && counts[bin] > most) {
        most = counts[bin];
        around = u;
      }
    }
    if (around == before) break;
  }
  return around;
}

}  // namespace

GaussianMixture local_mixture(const ImageView& image, const Eigen::Vector3d& seed,
                              const LocalMixtureOptions& options) {
  validate(image);
  for (int axis = 0; axis < 3; ++axis) {
    const auto last = static_cast<double>(image.dims[axis] - 1);
    if (!(seed[axis] >= 0.0 && seed[axis] <= last)) {
      detail::refuse("seed[" + std::to_string(axis) + "]", detail::text(seed[axis]),
                     "0 to " + detail::text(last));
    }
  }
  detail::require(std::isfinite(options.radius) && options.radius >= 0.0, "radius", options.radius,
                  "a finite number of mm that is not negative");
  HistogramOptions histogram_options = options.histogram;
  histogram_options.threads = options.threads;
  const Histogram counts = histogram(image, histogram_options);
  if (counts.bins() == 0) return {};
  const double noise = noise_deviation(image, options.threads);
  const double object = median_in_ball(
      image, seed, options.radius > 0.0 ? options.radius : 2.0 * std::cbrt(image.spacing.prod()));
  const double around = surroundings(counts, object, options.dark, noise);
  const double contrast = options.dark ? around - object : object - around;
  if (!(contrast > noise)) return {};
  const double deviation = std::max({noise, contrast / 16.0, counts.bin_width / std::sqrt(12.0)});
  GaussianMixture mixture;
  mixture.weights = Eigen::ArrayXd::Constant(2, 0.5);
  mixture.means.resize(2);
  mixture.means << std::min(object, around), std::max(object, around);
  mixture.variances = Eigen::ArrayXd::Constant(2, deviation * deviation);
  return mixture;
}

}  // namespace shape3d::levelset
