#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "parallel.hpp"
#include "random_numbers.hpp"
#include "shape3d/descriptors/shape_distribution.hpp"
#include "text.hpp"

namespace shape3d::descriptors {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kPairsOfBlock = 1 << 14;

// Draws points of a surface uniformly by area.
class SurfaceSampler {
 public:
  SurfaceSampler(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
                 const Frame& frame)
      : corners_(static_cast<std::size_t>(F.rows())), sums_(static_cast<std::size_t>(F.rows())) {
    double sum = 0.0;
    for (std::size_t t = 0; t < corners_.size(); ++t) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto vertex = F(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(corner));
        corners_[t][corner] = (V.row(vertex).transpose() - frame.centre) / frame.radius;
      }
      sum += 0.5 * (corners_[t][1] - corners_[t][0]).cross(corners_[t][2] - corners_[t][0]).norm();
      sums_[t] = sum;
    }
    // A table of equal parts of the area says where to begin to look.
    starts_.resize(corners_.size() + 1);
    std::size_t t = 0;
    for (std::size_t i = 0; i < starts_.size(); ++i) {
      const double share = sum * static_cast<double>(i) / static_cast<double>(corners_.size());
      while (t + 1 < sums_.size() && sums_[t] <= share) ++t;
      starts_[i] = t;
    }
  }

  [[nodiscard]] Vector3d draw(detail::RandomNumbers& numbers) const {
    const double share = numbers.uniform();
    auto t = starts_[static_cast<std::size_t>(share * static_cast<double>(corners_.size()))];
    const double area = share * sums_.back();
    while (t > 0 && sums_[t - 1] > area) --t;  // rounding of the table
    while (t + 1 < sums_.size() && sums_[t] <= area) ++t;
    const double root = std::sqrt(numbers.uniform()), v = numbers.uniform();
    return (1.0 - root) * corners_[t][0] + root * (1.0 - v) * corners_[t][1] +
           root * v * corners_[t][2];
  }

 private:
  std::vector<std::array<Vector3d, 3>> corners_;
  std::vector<double> sums_;  // of areas up to and with each triangle
  std::vector<std::size_t> starts_;
};

}  // namespace

Eigen::VectorXd d2_histogram(const Eigen::Ref<const Points>& V,
                             const Eigen::Ref<const Triangles>& F, const D2Options& options,
                             int threads) {
  detail::require_between("bins", options.bins, 2, 4096);
  detail::require_between("pairs", options.pairs, 1, 1000000000);
  detail::require(std::isfinite(options.range) && options.range > 0.0, "range", options.range,
                  "a positive finite number");
  threads = detail::resolve_threads(threads);
  const SurfaceSampler sampler(V, F, surface_frame(V, F));

  // The unit is the mean distance, known only at the end: distances are kept, in single precision.
  const std::int64_t pairs = options.pairs;
  std::vector<float> distances(static_cast<std::size_t>(pairs));
  const std::int64_t blocks = (pairs + kPairsOfBlock - 1) / kPairsOfBlock;
  std::vector<double> sums(static_cast<std::size_t>(blocks), 0.0);
  detail::parallel_blocks(
      pairs, kPairsOfBlock, threads, [&](std::int64_t first, std::int64_t last) {
        const auto block = static_cast<std::uint64_t>(first / kPairsOfBlock);
        detail::RandomNumbers numbers(detail::RandomNumbers::mix(options.seed) ^
                                      detail::RandomNumbers::mix(block + 0x632be59bd9b4e019ULL));
        double sum = 0.0;
        for (std::int64_t i = first; i < last; ++i) {
          const Vector3d p = sampler.draw(numbers), q = sampler.draw(numbers);
          const double distance = (p - q).norm();
          distances[static_cast<std::size_t>(i)] = static_cast<float>(distance);
          sum += distance;
        }
        sums[block] = sum;
      });
  double sum = 0.0;
  for (const double part : sums) sum += part;
  const double mean = sum / static_cast<double>(pairs);

  const double scale = options.bins / (options.range * mean);
  const std::size_t bins = static_cast<std::size_t>(options.bins);
  std::vector<std::int64_t> counts(bins, 0);
  for (const float distance : distances) {
    const auto bin = static_cast<std::size_t>(std::min(distance * scale, options.bins - 0.5));
    ++counts[bin];
  }
  Eigen::VectorXd histogram(options.bins);
  for (std::size_t b = 0; b < bins; ++b) {
    histogram[static_cast<Eigen::Index>(b)] =
        static_cast<double>(counts[b]) / static_cast<double>(pairs);
  }
  return histogram;
}

}  // namespace shape3d::descriptors
