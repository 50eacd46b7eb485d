#pragma once

#include <cstddef>
#include <vector>

namespace shape3d::descriptors {

/// Associated Legendre functions, normalised and with the Condon–Shortley phase, so that
///   Y_l^m(θ, φ) = P̄_l^m(cos θ) e^{imφ},  P̄_l^m = √((2l+1)/4π · (l−m)!/(l+m)!) P_l^m,  m ≥ 0,
/// are orthonormal on the sphere. Negative orders: P̄_l^{−m} = (−1)^m P̄_l^m.
///
/// Three-term recurrence in the degree at fixed order, started from the sectoral P̄_m^m. It runs
/// forward from where |P̄| is least, which is the stable direction, and the normalised values are
/// below √((2l+1)/4π), so nothing overflows. P̄_m^m ∝ sin^m θ may underflow to 0 near the poles;
/// up to kMaxDegree all P̄_l^m that rest on it are then below 1e-30 themselves.
class Legendre {
 public:
  static constexpr int kMaxDegree = 1000;

  /// Tabulates the coefficients of the recurrence, O(degree²).
  /// @param degree  Largest degree, 0 … kMaxDegree; out of range is an error of the caller.
  explicit Legendre(int degree);

  [[nodiscard]] int degree() const { return degree_; }

  /// P̄_0^0 = 1/(2√π), where the recurrences start:
  ///   P̄_m^m = −sectoral(m) sin θ P̄_{m−1}^{m−1},
  ///   P̄_l^m = first(l, m) cos θ P̄_{l−1}^m − second(l, m) P̄_{l−2}^m,  m < l.
  static constexpr double kFirst = 0.28209479177387814347;
  [[nodiscard]] double sectoral(int m) const { return sectoral_[static_cast<std::size_t>(m)]; }
  [[nodiscard]] double first(int l, int m) const { return first_[index(l, m)]; }
  [[nodiscard]] double second(int l, int m) const { return second_[index(l, m)]; }

  /// Number of pairs 0 ≤ m ≤ l ≤ degree.
  [[nodiscard]] static constexpr std::size_t count(int degree) {
    const auto k = static_cast<std::size_t>(degree);
    return (k + 1) * (k + 2) / 2;
  }
  /// Where (l, m), 0 ≤ m ≤ l, stands: degrees one after another.
  [[nodiscard]] static constexpr std::size_t index(int l, int m) {
    return static_cast<std::size_t>(l) * (static_cast<std::size_t>(l) + 1) / 2 +
           static_cast<std::size_t>(m);
  }

  /// Writes count(degree()) values P̄_l^m(cos θ) in the order of index().
  /// @param cos_theta, sin_theta  of the same θ in [0, π]; both, since sin θ from cos θ would lose
  /// half of the digits near the poles.
  void evaluate(double cos_theta, double sin_theta, double* values) const;

 private:
  int degree_;
  std::vector<double> sectoral_;  // √((2m+1)/2m), by m
  std::vector<double> first_, second_;  // of P̄_l^m = first x P̄_{l−1}^m − second P̄_{l−2}^m, by index
};

}  // namespace shape3d::descriptors
