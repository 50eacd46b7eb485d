#pragma once

#include <Eigen/Core>

#include "shape3d/descriptors/sh.hpp"

// What the parts of sh.hpp share.
namespace shape3d::descriptors::detail {

inline constexpr double kPi = 3.14159265358979323846;

/// Throws std::invalid_argument unless size is even and within its limits.
void check_image_size(int size);
/// Throws std::invalid_argument unless 0 ≤ K ≤ sh_largest_degree(size).
void check_degree_of_image(int K, int size);
/// Throws std::invalid_argument unless there are `rows` rows of finite numbers.
void check_samples(const Eigen::Ref<const Eigen::MatrixXd>& samples, Eigen::Index rows);
/// K from the number of rows. Throws std::invalid_argument when it is not (K + 1)².
int degree_of(const Eigen::Ref<const Eigen::MatrixXcd>& coefficients);

/// The rows of C_l^{−m} from those of C_l^m.
inline void fill_negative_orders(Eigen::MatrixXcd& coefficients, int K) {
  for (int l = 1; l <= K; ++l) {
    for (int m = 1; m <= l; ++m) {
      const double sign = m % 2 == 0 ? 1.0 : -1.0;
      coefficients.row(sh_index(l, -m)) = sign * coefficients.row(sh_index(l, m)).conjugate();
    }
  }
}

}  // namespace shape3d::descriptors::detail
