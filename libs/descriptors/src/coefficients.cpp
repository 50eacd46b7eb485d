#include "coefficients.hpp"

namespace shape3d::descriptors::detail {

Eigen::VectorXcd radial_transform(int K, const Eigen::Ref<const Eigen::MatrixXd>& radial,
                                  const Eigen::Ref<const Eigen::MatrixXd>& spheres) {
  const auto pairs = static_cast<Eigen::Index>(Legendre::count(K));
  const Eigen::Index count = spheres.cols();
  Eigen::MatrixXd real(static_cast<Eigen::Index>(hsh_pair_count(K)), K + 1);
  Eigen::MatrixXd imaginary(real.rows(), K + 1);
  Eigen::MatrixXd of_degree(K + 1, count);
  for (int l = 0; l <= K; ++l) {
    const int radials = K + 1 - l;
    for (int lambda = l; lambda <= K; ++lambda) {
      of_degree.row(lambda - l) = radial.row(static_cast<Eigen::Index>(hsh_pair_index(lambda, l)));
    }
    const auto first = static_cast<Eigen::Index>(Legendre::index(l, 0));
    const Eigen::MatrixXd re =
        of_degree.topRows(radials) * spheres.middleRows(first, l + 1).transpose();
    const Eigen::MatrixXd im =
        of_degree.topRows(radials) * spheres.middleRows(pairs + first, l + 1).transpose();
    for (int lambda = l; lambda <= K; ++lambda) {
      const auto place = static_cast<Eigen::Index>(hsh_pair_index(lambda, l));
      real.row(place).head(l + 1) = re.row(lambda - l);
      imaginary.row(place).head(l + 1) = im.row(lambda - l);
    }
  }
  return complete(K, [&](int lambda, int l, int m) {
    const auto place = static_cast<Eigen::Index>(hsh_pair_index(lambda, l));
    return std::complex<double>(real(place, m), imaginary(place, m));
  });
}

}  // namespace shape3d::descriptors::detail
