#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "coefficients.hpp"
#include "gegenbauer.hpp"
#include "legendre.hpp"
#include "parallel.hpp"
#include "shape3d/descriptors/hsh.hpp"
#include "sphere_map.hpp"
#include "text.hpp"

namespace shape3d::descriptors {
namespace {

constexpr std::int64_t kParts = 32;  // partial sums, whatever the number of threads

// Adds w R_{λ,l} conj(Y_l^m) of one point: for each (λ, l) real parts of m = 0 … l, then imaginary.
class PointSum {
 public:
  explicit PointSum(const HshOptions& options)
      : options_(options),
        gegenbauer_(options.K),
        legendre_(options.K),
        radial_(hsh_pair_count(options.K)),
        polar_(Legendre::count(options.K)),
        turns_(static_cast<std::size_t>(options.K) + 1) {}

  void add(const Eigen::Vector3d& x, double weight, std::complex<double>* sums) {
    const double rho = x.norm();
    if (rho > 1.0) return;
    const double theta0 = hsh_angle(options_.map, options_.stretch, rho);
    gegenbauer_.evaluate(std::cos(theta0), std::sin(theta0), radial_.data());
    const double flat = std::hypot(x[0], x[1]);
    legendre_.evaluate(rho > 0.0 ? x[2] / rho : 1.0, rho > 0.0 ? flat / rho : 0.0, polar_.data());
    const std::complex<double> turn =
        flat > 0.0 ? std::complex<double>(x[0] / flat, -x[1] / flat) : 1.0;
    turns_[0] = weight;
    for (std::size_t m = 1; m < turns_.size(); ++m) turns_[m] = turns_[m - 1] * turn;
    const bool both = options_.map == SphereMap::two_sided;
    for (int lambda = 0; lambda <= options_.K; ++lambda) {
      for (int l = 0; l <= lambda; ++l) {
        double r = radial_[hsh_pair_index(lambda, l)];
        // A point of the ball is two on S³, each with half of its weight.
        if (both && (lambda - l) % 2 != 0) r = 0.0;
        for (int m = 0; m <= l; ++m) {
          *sums++ += r * polar_[Legendre::index(l, m)] * turns_[static_cast<std::size_t>(m)];
        }
      }
    }
  }

 private:
  HshOptions options_;
  detail::Gegenbauer gegenbauer_;
  Legendre legendre_;
  std::vector<double> radial_, polar_;
  std::vector<std::complex<double>> turns_;
};

// Where (λ, l, 0) stands in the sums of PointSum.
std::size_t half_index(int lambda, int l) {
  const auto a = static_cast<std::size_t>(lambda), b = static_cast<std::size_t>(l);
  return a * (a + 1) * (a + 2) / 6 + b * (b + 1) / 2;
}

}  // namespace

HshCoefficients hsh_of_points(const SurfacePoints& points, const Frame& frame,
                              const HshOptions& options, int threads) {
  detail::check_options(options);
  threads = detail::resolve_threads(threads);
  if (points.weights.size() != points.points.rows()) {
    throw std::invalid_argument("weights has " + std::to_string(points.weights.size()) +
                                " numbers, expected " + std::to_string(points.points.rows()) +
                                ", one a point");
  }
  const std::int64_t count = points.points.rows();
  const std::size_t half = half_index(options.K + 1, 0);
  const std::int64_t grain = std::max<std::int64_t>(1, (count + kParts - 1) / kParts);
  std::vector<std::vector<std::complex<double>>> parts(
      static_cast<std::size_t>((count + grain - 1) / grain));
  detail::parallel_blocks(count, grain, threads, [&](std::int64_t first, std::int64_t last) {
    auto& sums = parts[static_cast<std::size_t>(first / grain)];
    sums.assign(half, 0.0);
    PointSum point_sum(options);
    for (std::int64_t i = first; i < last; ++i) {
      const Eigen::Vector3d x = (points.points.row(i).transpose() - frame.centre) / frame.radius;
      point_sum.add(x, points.weights[i] / (frame.radius * frame.radius), sums.data());
    }
  });
  std::vector<std::complex<double>> total(half, 0.0);
  for (const auto& sums : parts) {
    for (std::size_t i = 0; i < half; ++i) total[i] += sums[i];
  }
  HshCoefficients result;
  result.K = options.K;
  result.map = options.map;
  result.stretch = options.stretch;
  result.values = detail::complete(options.K, [&](int lambda, int l, int m) {
    return total[half_index(lambda, l) + static_cast<std::size_t>(m)];
  });
  return result;
}

}  // namespace shape3d::descriptors
