#include "shape3d/descriptors/hsh_basis.hpp"

#include <cmath>
#include <limits>

#include "gegenbauer.hpp"
#include "legendre.hpp"
#include "text.hpp"

namespace shape3d::descriptors {
namespace {

constexpr double kPi = 3.14159265358979323846;

void check_angle(const char* name, double angle) {
  detail::require(angle >= 0.0 && angle <= kPi, name, angle, "0 … π");
}

}  // namespace

Eigen::VectorXd hsh_radial(int K, double theta0) {
  detail::require_between("K", K, 0, kMaxHshDegree);
  check_angle("theta0", theta0);
  Eigen::VectorXd values(static_cast<Eigen::Index>(hsh_pair_count(K)));
  detail::Gegenbauer(K).evaluate(std::cos(theta0), std::sin(theta0), values.data());
  return values;
}

Eigen::VectorXcd hsh_basis(int K, double theta0, double theta, double phi) {
  const Eigen::VectorXd radial = hsh_radial(K, theta0);
  check_angle("theta", theta);
  detail::require(std::isfinite(phi), "phi", phi, "a finite angle");
  std::vector<double> polar(Legendre::count(K));
  Legendre(K).evaluate(std::cos(theta), std::sin(theta), polar.data());

  Eigen::VectorXcd values(static_cast<Eigen::Index>(hsh_count(K)));
  for (int m = 0; m <= K; ++m) {
    const std::complex<double> turn = std::polar(1.0, m * phi);
    const double sign = m % 2 == 0 ? 1.0 : -1.0;
    for (int l = m; l <= K; ++l) {
      const std::complex<double> y = polar[Legendre::index(l, m)] * turn;
      for (int lambda = l; lambda <= K; ++lambda) {
        const double r = radial[static_cast<Eigen::Index>(hsh_pair_index(lambda, l))];
        values[static_cast<Eigen::Index>(hsh_index(lambda, l, -m))] = sign * r * std::conj(y);
        values[static_cast<Eigen::Index>(hsh_index(lambda, l, m))] = r * y;
      }
    }
  }
  return values;
}

}  // namespace shape3d::descriptors
