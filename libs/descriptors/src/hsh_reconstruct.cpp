#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "ball_voxels.hpp"
#include "gegenbauer.hpp"
#include "legendre.hpp"
#include "parallel.hpp"
#include "shape3d/descriptors/hsh.hpp"
#include "sphere_map.hpp"
#include "text.hpp"
#include "voxel_check.hpp"

namespace shape3d::descriptors {
namespace {

void check_coefficients(const HshCoefficients& coefficients) {
  detail::require_between("K", coefficients.K, 0, kMaxHshDegree);
  const auto expected = static_cast<Eigen::Index>(hsh_count(coefficients.K));
  if (coefficients.values.size() != expected) {
    throw std::invalid_argument(
        "the coefficients are " + std::to_string(coefficients.values.size()) + ", expected " +
        std::to_string(expected) + " for K = " + std::to_string(coefficients.K));
  }
}

// Calls use(index, value, octant voxel, shell) for each voxel of the ball with the series' value.
// The harmonics of an octant voxel serve its eight mirror images by their signs.
template <class Use>
void evaluate_series(const HshCoefficients& coefficients, const detail::BallVoxels& ball,
                     int threads, Use&& use) {
  const int K = coefficients.K;
  const detail::Gegenbauer gegenbauer(K);
  const Legendre legendre(K);
  const auto n = static_cast<std::size_t>(ball.side);
  detail::parallel_blocks(
      static_cast<std::int64_t>(ball.shells()), 4, threads,
      [&](std::int64_t first, std::int64_t last) {
        std::vector<double> radial(hsh_pair_count(K)), polar(Legendre::count(K));
        std::vector<std::complex<double>> sphere(Legendre::count(K));
        for (auto s = static_cast<std::size_t>(first); s < static_cast<std::size_t>(last); ++s) {
          const double theta0 =
              hsh_angle(coefficients.map, coefficients.stretch, std::min(1.0, ball.shell_rho[s]));
          gegenbauer.evaluate(std::cos(theta0), std::sin(theta0), radial.data());
          for (int l = 0; l <= K; ++l) {
            for (int m = 0; m <= l; ++m) {
              std::complex<double> sum = 0.0;
              for (int lambda = l; lambda <= K; ++lambda) {
                sum += radial[hsh_pair_index(lambda, l)] * coefficients.at(lambda, l, m);
              }
              sphere[Legendre::index(l, m)] = (m == 0 ? 1.0 : 2.0) * sum;
            }
          }
          for (std::size_t v = ball.shell_begin[s]; v < ball.shell_begin[s + 1]; ++v) {
            legendre.evaluate(ball.cos_theta[v], ball.sin_theta[v], polar.data());
            // Sums by parity in x, y, z: of Re C cos mφ and of −Im C sin mφ.
            std::array<double, 8> part{};
            std::complex<double> turn = 1.0;
            for (int m = 0; m <= K; ++m) {
              const std::size_t cos_class = m % 2 != 0 ? 4 : 0, sin_class = m % 2 != 0 ? 2 : 6;
              for (int l = m; l <= K; ++l) {
                const std::size_t z = static_cast<std::size_t>((l - m) % 2);
                const std::size_t place = Legendre::index(l, m);
                part[cos_class + z] += polar[place] * turn.real() * sphere[place].real();
                part[sin_class + z] -= polar[place] * turn.imag() * sphere[place].imag();
              }
              turn *= std::complex<double>(ball.cos_phi[v], ball.sin_phi[v]);
            }
            const std::size_t x[2] = {ball.column[v], n - 1 - ball.column[v]};
            const std::size_t y[2] = {n * ball.row[v], n * (n - 1 - ball.row[v])};
            const std::size_t z[2] = {n * n * ball.plane[v], n * n * (n - 1 - ball.plane[v])};
            for (std::size_t image = 0; image < 8; ++image) {
              double value = 0.0;
              for (std::size_t parity = 0; parity < 8; ++parity) {
                const std::size_t common = image & parity;
                const bool negative = ((common >> 2) ^ (common >> 1) ^ common) & 1;
                value += negative ? -part[parity] : part[parity];
              }
              use(x[(image >> 2) & 1] + y[(image >> 1) & 1] + z[image & 1], value, v, s);
            }
          }
        }
      });
}

}  // namespace

Voxels reconstruct(const HshCoefficients& coefficients, int side, int threads) {
  check_coefficients(coefficients);
  detail::check_side(side);
  threads = detail::resolve_threads(threads);
  const detail::BallVoxels ball(side);
  Voxels voxels;
  voxels.side = side;
  const auto n = static_cast<std::size_t>(side);
  voxels.values.assign(n * n * n, 0.0F);
  evaluate_series(coefficients, ball, threads,
                  [&](std::size_t index, double value, std::size_t, std::size_t) {
                    voxels.values[index] = static_cast<float>(value);
                  });
  return voxels;
}

double hsh_residual(const HshCoefficients& coefficients, const Voxels& voxels, int threads) {
  check_coefficients(coefficients);
  detail::check_side(voxels.side);
  detail::check_voxels(voxels, voxels.side);
  threads = detail::resolve_threads(threads);
  const detail::BallVoxels ball(voxels.side);
  const double edge = 2.0 / voxels.side;
  std::vector<double> rest(ball.shells(), 0.0), all(ball.shells(), 0.0);
  evaluate_series(coefficients, ball, threads,
                  [&](std::size_t index, double value, std::size_t v, std::size_t s) {
                    const double f = voxels.values[index];
                    rest[s] += ball.share[v] * (f - value) * (f - value);
                    all[s] += ball.share[v] * f * f;
                  });
  double rest_sum = 0.0, all_sum = 0.0;
  for (std::size_t s = 0; s < ball.shells(); ++s) {
    const double density =
        detail::mean_density(coefficients.map, coefficients.stretch, ball.shell_rho[s] - 0.5 * edge,
                             ball.shell_rho[s] + 0.5 * edge);
    rest_sum += density * rest[s];
    all_sum += density * all[s];
  }
  return all_sum > 0.0 ? std::sqrt(rest_sum / all_sum) : 0.0;
}

}  // namespace shape3d::descriptors
