#include "legendre.hpp"

#include <cassert>
#include <cmath>

namespace shape3d::descriptors {
Legendre::Legendre(int degree)
    : degree_(degree),
      sectoral_(static_cast<std::size_t>(degree) + 1, 0.0),
      first_(count(degree), 0.0),
      second_(count(degree), 0.0) {
  assert(degree >= 0 && degree <= kMaxDegree);
  for (int m = 1; m <= degree; ++m) {
    sectoral_[static_cast<std::size_t>(m)] = std::sqrt((2.0 * m + 1.0) / (2.0 * m));
  }
  for (int l = 1; l <= degree; ++l) {
    for (int m = 0; m < l; ++m) {
      const double squares = static_cast<double>(l - m) * (l + m);
      const double first = std::sqrt((2.0 * l - 1.0) * (2.0 * l + 1.0) / squares);
      first_[index(l, m)] = first;
      if (m + 1 < l) {
        second_[index(l, m)] = std::sqrt((2.0 * l + 1.0) * (l - 1.0 - m) * (l - 1.0 + m) /
                                         ((2.0 * l - 3.0) * squares));
      }
    }
  }
}

void Legendre::evaluate(double cos_theta, double sin_theta, double* values) const {
  values[0] = kFirst;
  for (int l = 1; l <= degree_; ++l) {
    const std::size_t row = index(l, 0), previous = index(l - 1, 0);
    const std::size_t before = l > 1 ? index(l - 2, 0) : 0;
    const auto n = static_cast<std::size_t>(l);
    for (std::size_t m = 0; m + 1 < n; ++m) {
      values[row + m] = first_[row + m] * cos_theta * values[previous + m] -
                        second_[row + m] * values[before + m];
    }
    values[row + n - 1] = first_[row + n - 1] * cos_theta * values[previous + n - 1];
    values[row + n] = -sectoral_[n] * sin_theta * values[previous + n - 1];
  }
}

}  // namespace shape3d::descriptors
