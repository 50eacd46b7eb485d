#include "sphere_map.hpp"

#include <algorithm>
#include <cmath>

#include "text.hpp"

namespace shape3d::descriptors {
namespace {

constexpr double kPi = 3.14159265358979323846;

// 2 ∫_0^θ0 sin² = θ0 − sin θ0 cos θ0, without cancellation at 0.
double twice_measure(double theta0) {
  if (theta0 < 0.02) {
    const double square = theta0 * theta0;  // the next term is below 1e-16 of the first
    return theta0 * square *
           (2.0 / 3.0 - square * (2.0 / 15.0 - square * (4.0 / 315.0 - square * 2.0 / 2835.0)));
  }
  return theta0 - 0.5 * std::sin(2.0 * theta0);
}

// The angle of twice_measure(angle) = target, in [0, π/2]: Newton's method within a bracket.
double angle_of_measure(double target) {
  if (target <= 0.0) return 0.0;
  double low = 0.0, high = 0.5 * kPi + 1e-9, angle = std::min(high, std::cbrt(1.5 * target));
  for (int step = 0; step < 100; ++step) {
    const double excess = twice_measure(angle) - target;
    (excess > 0.0 ? high : low) = angle;
    const double change = excess / (2.0 * std::sin(angle) * std::sin(angle));
    if (std::abs(change) <= 2e-16 * angle) break;
    const double next = angle - change;
    angle = next > low && next < high ? next : 0.5 * (low + high);
  }
  return angle;
}

// θ0 − sin θ0 cos θ0 = πρ³, from the nearer pole.
double equal_volume_angle(double rho) {
  const double measure = kPi * rho * rho * rho;
  if (measure <= 0.5 * kPi) return angle_of_measure(measure);
  return kPi - angle_of_measure(kPi * (1.0 - rho) * (1.0 + rho + rho * rho));
}

void check_stretch(double stretch) {
  detail::require(stretch >= 0.1 && stretch <= 100.0, "stretch", stretch, "0.1 … 100");
}

}  // namespace

double hsh_angle(SphereMap map, double stretch, double rho) {
  detail::require(rho >= 0.0 && rho <= 1.0, "rho", rho, "0 … 1");
  switch (map) {
    case SphereMap::two_sided:
      return std::asin(rho);
    case SphereMap::equal_volume:
      return equal_volume_angle(rho);
    case SphereMap::stereographic:
      break;
  }
  check_stretch(stretch);
  return 2.0 * std::atan(stretch * rho);
}

namespace detail {

double ball_radius(SphereMap map, double stretch, double theta0) {
  switch (map) {
    case SphereMap::two_sided:
      return std::sin(theta0);
    case SphereMap::equal_volume:
      return std::cbrt(twice_measure(theta0) / kPi);
    case SphereMap::stereographic:
      break;
  }
  return std::tan(0.5 * theta0) / stretch;
}

double mean_density(SphereMap map, double stretch, double low, double high) {
  if (map == SphereMap::equal_volume) return 1.5 * kPi;
  low = std::clamp(low, 0.0, 1.0);
  high = std::clamp(high, 0.0, 1.0);
  const double volume = (high - low) * (high * high + high * low + low * low) / 3.0;
  if (volume <= 0.0) return 0.0;
  return 0.5 *
         (twice_measure(hsh_angle(map, stretch, high)) -
          twice_measure(hsh_angle(map, stretch, low))) /
         volume;
}

void check_options(const HshOptions& options) {
  require_between("K", options.K, 0, kMaxHshDegree);
  if (options.map == SphereMap::stereographic) check_stretch(options.stretch);
}

}  // namespace detail
}  // namespace shape3d::descriptors
