#pragma once

#include <vector>

namespace shape3d::descriptors::detail {

/// The functions R_{λ,l}(θ0) of hsh_radial(), tabulated recurrence.
///
/// With n = λ − l and the normalised Gegenbauer polynomials p_n of index l + 1,
///   b_n p_n = u p_{n−1} − b_{n−1} p_{n−2},  b_n² = (λ−l)(λ+l+1) / (4λ(λ+1)),
/// and R_{l,l} = R_{l−1,l−1} sin θ0 √((2l+2)/(2l+1)), R_{0,0} = √(2/π). The sign (−1)^{λ+l} of
/// (5.8) is that of u → −u.
class Gegenbauer {
 public:
  explicit Gegenbauer(int degree);

  [[nodiscard]] int degree() const { return degree_; }

  /// Writes hsh_pair_count(degree) values at hsh_pair_index(λ, l).
  /// @param cos_theta0, sin_theta0  of the same θ0 in [0, π].
  void evaluate(double cos_theta0, double sin_theta0, double* values) const;

 private:
  int degree_;
  std::vector<double> sectoral_;  // √((2l+2)/(2l+1)), by l
  std::vector<double> step_;      // b_{λ−l}, by (λ, l)
};

}  // namespace shape3d::descriptors::detail
