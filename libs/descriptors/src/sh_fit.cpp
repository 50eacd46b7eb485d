#include <cmath>
#include <complex>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "legendre.hpp"
#include "sh_checks.hpp"
#include "shape3d/descriptors/sh.hpp"
#include "text.hpp"

namespace shape3d::descriptors {
namespace {

using Complex = std::complex<double>;

constexpr int kMaxFitDegree = 32;
constexpr Eigen::Index kMaxFitNumbers = Eigen::Index{1} << 26;
constexpr double kZeroSingularValue = 1e-12;  // of the largest
constexpr double kRootHalf = 0.70710678118654752440;

void check_directions(const Eigen::Ref<const Points>& directions) {
  if (directions.rows() == 0) throw std::invalid_argument("directions has no rows");
  for (Eigen::Index i = 0; i < directions.rows(); ++i) {
    const double length = directions.row(i).norm();
    if (!(std::abs(length - 1.0) <= 1e-6)) {
      throw std::invalid_argument("directions: row " + std::to_string(i) + " has the length " +
                                  detail::number(length) + ", expected unit vectors");
    }
  }
}

// Calls visit(i, l, m, P̄_l^m(θ_i), e^{imφ_i}) for each direction i and 0 ≤ m ≤ l ≤ K.
template <class Visitor>
void for_each_harmonic(const Eigen::Ref<const Points>& directions, int K, Visitor&& visit) {
  const Legendre legendre(K);
  std::vector<double> P(Legendre::count(K));
  std::vector<Complex> powers(static_cast<std::size_t>(K) + 1, 1.0);
  for (Eigen::Index i = 0; i < directions.rows(); ++i) {
    const double x = directions(i, 0), y = directions(i, 1);
    const double r = std::hypot(x, y), length = std::hypot(r, directions(i, 2));
    legendre.evaluate(directions(i, 2) / length, r / length, P.data());
    const Complex turn = r > 0.0 ? Complex(x / r, y / r) : Complex(1.0);
    for (std::size_t m = 1; m < powers.size(); ++m) powers[m] = powers[m - 1] * turn;
    for (int l = 0; l <= K; ++l) {
      for (int m = 0; m <= l; ++m) {
        visit(i, l, m, P[Legendre::index(l, m)], powers[static_cast<std::size_t>(m)]);
      }
    }
  }
}

}  // namespace

Eigen::MatrixXcd spherical_harmonics(const Eigen::Ref<const Points>& directions, int K) {
  check_directions(directions);
  detail::require_between("K", K, 0, Legendre::kMaxDegree);
  Eigen::MatrixXcd Y(directions.rows(), sh_count(K));
  for_each_harmonic(directions, K, [&Y](Eigen::Index i, int l, int m, double P, Complex turn) {
    Y(i, sh_index(l, m)) = P * turn;
    if (m > 0) Y(i, sh_index(l, -m)) = (m % 2 == 0 ? P : -P) * std::conj(turn);
  });
  return Y;
}

// In the real orthonormal basis, √2 P̄_l^m cos mφ in the column of (l, m) and √2 P̄_l^m sin mφ in
// that of (l, −m): half of the arithmetic of (C.1), and the singular values are the same, since the
// step between the two bases is unitary.
struct ShFit::Plan {
  int K;
  Eigen::MatrixXd inverse;
  Eigen::Index rank;
  double condition;
};

ShFit::ShFit(const Eigen::Ref<const Points>& directions, int K) {
  check_directions(directions);
  detail::require_between("K", K, 0, kMaxFitDegree);
  if (directions.rows() > kMaxFitNumbers / sh_count(K)) {
    throw std::invalid_argument(
        "directions has " + std::to_string(directions.rows()) + " rows, expected at most " +
        std::to_string(kMaxFitNumbers / sh_count(K)) + " for K = " + std::to_string(K));
  }
  Eigen::MatrixXd Y(directions.rows(), sh_count(K));
  for_each_harmonic(directions, K, [&Y](Eigen::Index i, int l, int m, double P, Complex turn) {
    Y(i, sh_index(l, m)) = m == 0 ? P : P * turn.real() / kRootHalf;
    if (m > 0) Y(i, sh_index(l, -m)) = P * turn.imag() / kRootHalf;
  });

  // A tall matrix is first reduced to its triangle: Y = QR, R = UΣVᵀ.
  const bool tall = Y.rows() > Y.cols();
  Eigen::HouseholderQR<Eigen::MatrixXd> qr;
  if (tall) {
    qr.compute(Y);
    Y = qr.matrixQR().topRows(Y.cols()).triangularView<Eigen::Upper>();
  }
  Eigen::BDCSVD<Eigen::MatrixXd> svd(Y, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(kZeroSingularValue);
  const Eigen::Index rank = svd.rank();
  const Eigen::VectorXd& sigma = svd.singularValues();
  Eigen::MatrixXd left = svd.matrixU().leftCols(rank);
  if (tall) {
    Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(directions.rows(), rank);
    padded.topRows(left.rows()) = left;
    left = qr.householderQ() * padded;
  }
  const Eigen::MatrixXd right =
      svd.matrixV().leftCols(rank) * sigma.head(rank).cwiseInverse().asDiagonal();
  plan_ = std::make_unique<const Plan>(
      Plan{K, right * left.transpose(), rank, sigma[0] / sigma[rank - 1]});
}

ShFit::~ShFit() = default;
ShFit::ShFit(ShFit&&) noexcept = default;
ShFit& ShFit::operator=(ShFit&&) noexcept = default;

Eigen::Index ShFit::rank() const { return plan_->rank; }
double ShFit::condition() const { return plan_->condition; }

Eigen::MatrixXcd ShFit::operator()(const Eigen::Ref<const Eigen::MatrixXd>& samples) const {
  detail::check_samples(samples, plan_->inverse.cols());
  const Eigen::MatrixXd real = plan_->inverse * samples;
  Eigen::MatrixXcd coefficients(real.rows(), real.cols());
  for (Eigen::Index c = 0; c < real.cols(); ++c) {
    for (int l = 0; l <= plan_->K; ++l) {
      coefficients(sh_index(l, 0), c) = real(sh_index(l, 0), c);
      for (int m = 1; m <= l; ++m) {
        coefficients(sh_index(l, m), c) =
            kRootHalf * Complex(real(sh_index(l, m), c), -real(sh_index(l, -m), c));
      }
    }
  }
  detail::fill_negative_orders(coefficients, plan_->K);
  return coefficients;
}

}  // namespace shape3d::descriptors
