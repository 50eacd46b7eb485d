#include "shape3d/descriptors/hsh_sampling.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "coefficients.hpp"
#include "gegenbauer.hpp"
#include "pseudo_inverse.hpp"
#include "sphere_grid.hpp"
#include "text.hpp"

namespace shape3d::descriptors {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

struct HshSampling::Plan {
  Plan(int degree, Quadrature kind, int nodes)
      : K(degree), quadrature(kind), n(nodes), columns(kind == Quadrature::svd ? n : 2 * n) {}

  int K;
  Quadrature quadrature;
  int n, columns;
  std::unique_ptr<detail::SphereGrid> sphere;  // separable
  Eigen::MatrixXd radial;                      // separable: R times weight, pairs by n
  Eigen::MatrixXd pseudo_inverse;              // svd: 2 · pairs of (l, m) by λ …, by node

  [[nodiscard]] double theta0(int i) const {
    return quadrature == Quadrature::svd ? kPi * (i + 0.5) / n : kPi * (i + 1) / (n + 1);
  }
  [[nodiscard]] double theta(int j) const {
    return quadrature == Quadrature::svd ? kPi * (j + 0.5) / n : std::acos(sphere->cos_theta(j));
  }
};

HshSampling::HshSampling(int K, Quadrature quadrature, int n) {
  detail::require_between("K", K, 0, kMaxHshDegree);
  auto plan = std::make_unique<Plan>(K, quadrature, n);
  const auto pairs = static_cast<Eigen::Index>(hsh_pair_count(K));
  if (quadrature == Quadrature::separable) {
    detail::require_between("grid", n, K + 1, 512);
    plan->sphere = std::make_unique<detail::SphereGrid>(K, n, 2 * n);
    plan->radial.resize(pairs, n);
    const detail::Gegenbauer gegenbauer(K);
    for (int i = 0; i < n; ++i) {
      const double angle = plan->theta0(i), sine = std::sin(angle);
      gegenbauer.evaluate(std::cos(angle), sine, plan->radial.col(i).data());
      plan->radial.col(i) *= kPi / (n + 1) * sine * sine;
    }
  } else if (quadrature == Quadrature::svd) {
    detail::require_between("grid", n, 2 * K + 2, 40);
    // Real functions: columns R P̄ (1 or 2 cos mφ, −2 sin mφ) times the real and imaginary parts of
    // C^m, m ≥ 0, since f = Σ_m C^m Y^m = C^0 Y^0 + Σ_{m>0} 2 Re(C^m Y^m).
    const auto count = static_cast<Eigen::Index>(hsh_count(K));
    const Eigen::Index rows = static_cast<Eigen::Index>(n) * n * n;
    Eigen::MatrixXd matrix(rows, count);
    for (Eigen::Index r = 0; r < rows; ++r) {
      const int i = static_cast<int>(r / (n * n)), j = static_cast<int>(r / n % n),
                k = static_cast<int>(r % n);
      const Eigen::VectorXcd basis =
          hsh_basis(K, plan->theta0(i), plan->theta(j), 2.0 * kPi * k / n);
      for (int lambda = 0; lambda <= K; ++lambda) {
        for (int l = 0; l <= lambda; ++l) {
          for (int m = 0; m <= l; ++m) {
            const std::complex<double> y =
                basis[static_cast<Eigen::Index>(hsh_index(lambda, l, m))];
            matrix(r, static_cast<Eigen::Index>(hsh_index(lambda, l, m))) =
                (m == 0 ? 1.0 : 2.0) * y.real();
            if (m > 0) {
              matrix(r, static_cast<Eigen::Index>(hsh_index(lambda, l, -m))) = -2.0 * y.imag();
            }
          }
        }
      }
    }
    plan->pseudo_inverse = detail::pseudo_inverse(matrix);
  } else {
    throw std::invalid_argument("quadrature is voxels, expected separable or svd");
  }
  plan_ = std::move(plan);
}

HshSampling::~HshSampling() = default;
HshSampling::HshSampling(HshSampling&&) noexcept = default;
HshSampling& HshSampling::operator=(HshSampling&&) noexcept = default;

Eigen::Index HshSampling::size() const {
  return static_cast<Eigen::Index>(plan_->n) * plan_->n * plan_->columns;
}

Eigen::Vector3d HshSampling::node(Eigen::Index i) const {
  const Eigen::Index columns = plan_->columns, n = plan_->n;
  return {plan_->theta0(static_cast<int>(i / (n * columns))),
          plan_->theta(static_cast<int>(i / columns % n)),
          2.0 * kPi * static_cast<double>(i % columns) / static_cast<double>(columns)};
}

Eigen::VectorXcd HshSampling::coefficients(const Eigen::Ref<const Eigen::VectorXd>& values) const {
  if (values.size() != size()) {
    throw std::invalid_argument("values has " + std::to_string(values.size()) +
                                " numbers, expected " + std::to_string(size()));
  }
  const int K = plan_->K;
  if (plan_->quadrature == Quadrature::svd) {
    const Eigen::VectorXd solution = plan_->pseudo_inverse * values;
    return detail::complete(K, [&](int lambda, int l, int m) {
      const double real = solution[static_cast<Eigen::Index>(hsh_index(lambda, l, m))];
      const double imaginary =
          m == 0 ? 0.0 : solution[static_cast<Eigen::Index>(hsh_index(lambda, l, -m))];
      return std::complex<double>(real, imaginary);
    });
  }
  const auto pairs = static_cast<Eigen::Index>(Legendre::count(K));
  Eigen::MatrixXd circles(2 * pairs, plan_->n);
  const Eigen::Index circle = static_cast<Eigen::Index>(plan_->n) * plan_->columns;
  using Samples = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (int i = 0; i < plan_->n; ++i) {
    const Eigen::Map<const Samples> samples(values.data() + i * circle, plan_->n, plan_->columns);
    plan_->sphere->transform(samples, circles.col(i).data());
  }
  return detail::radial_transform(K, plan_->radial, circles);
}

}  // namespace shape3d::descriptors
