#include "gegenbauer.hpp"

#include <cmath>

#include "shape3d/descriptors/hsh_basis.hpp"

namespace shape3d::descriptors::detail {
namespace {

constexpr double kRootTwoOverPi = 0.79788456080286535588;  // R_{0,0} = √(2/π)

}  // namespace

Gegenbauer::Gegenbauer(int degree)
    : degree_(degree),
      sectoral_(static_cast<std::size_t>(degree) + 1, 1.0),
      step_(hsh_pair_count(degree), 0.0) {
  for (int l = 1; l <= degree; ++l) {
    sectoral_[static_cast<std::size_t>(l)] = std::sqrt((2.0 * l + 2.0) / (2.0 * l + 1.0));
  }
  for (int lambda = 1; lambda <= degree; ++lambda) {
    for (int l = 0; l < lambda; ++l) {
      step_[hsh_pair_index(lambda, l)] =
          std::sqrt((lambda - l) * (lambda + l + 1.0) / (4.0 * lambda * (lambda + 1.0)));
    }
  }
}

void Gegenbauer::evaluate(double cos_theta0, double sin_theta0, double* values) const {
  values[0] = kRootTwoOverPi;
  for (int lambda = 1; lambda <= degree_; ++lambda) {
    const std::size_t row = hsh_pair_index(lambda, 0), previous = hsh_pair_index(lambda - 1, 0);
    const auto n = static_cast<std::size_t>(lambda);
    for (std::size_t l = 0; l < n; ++l) {
      double value = -cos_theta0 * values[previous + l];
      if (l + 1 < n) {
        value -= step_[previous + l] * values[hsh_pair_index(lambda - 2, static_cast<int>(l))];
      }
      values[row + l] = value / step_[row + l];
    }
    values[row + n] = sectoral_[n] * sin_theta0 * values[previous + n - 1];
  }
}

}  // namespace shape3d::descriptors::detail
