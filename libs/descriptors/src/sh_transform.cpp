#include <cmath>
#include <complex>
#include <optional>
#include <vector>

#include <unsupported/Eigen/FFT>

#include "legendre.hpp"
#include "sh_checks.hpp"
#include "shape3d/descriptors/sh.hpp"

namespace shape3d::descriptors {
namespace {

using Complex = std::complex<double>;

Points image_directions(int size) {
  Points directions(Eigen::Index{2} * size * size, 3);
  for (int j = 0; j < size; ++j) {
    for (int k = 0; k < 2 * size; ++k) {
      directions.row(Eigen::Index{2} * size * j + k) = image_direction(size, j, k);
    }
  }
  return directions;
}

}  // namespace

struct ShTransform::Plan {
  int size;
  ShRoute route;
  Legendre legendre;
  Eigen::VectorXd weights;    // a_j π/n: of a pixel of row j in an integral over the sphere
  std::vector<Complex> turn;  // e^{−iφ_k}
  std::optional<ShFit> fit;   // of ShRoute::svd

  Plan(int n, int K, ShRoute r) : size(n), route(r), legendre(K) {
    weights = image_weights(n) * (detail::kPi / n);
    for (int k = 0; k < 2 * n; ++k) turn.push_back(std::polar(1.0, -detail::kPi * k / n));
    if (r == ShRoute::svd) fit.emplace(image_directions(n), K);
  }

  // Both write the rows of m ≥ 0 for one component.
  void by_quadrature(const double* samples, Eigen::Ref<Eigen::VectorXcd> result) const;
  void by_fft(const double* samples, Eigen::Ref<Eigen::VectorXcd> result) const;

  // P̄_l^m(cos θ_j)
  void evaluate_row(int j, std::vector<double>& P) const {
    const double theta = detail::kPi * (2.0 * j + 1.0) / (2.0 * size);
    legendre.evaluate(std::cos(theta), std::sin(theta), P.data());
  }
};

void ShTransform::Plan::by_quadrature(const double* samples,
                                      Eigen::Ref<Eigen::VectorXcd> result) const {
  const int K = legendre.degree(), columns = 2 * size;
  std::vector<double> P(Legendre::count(K));
  for (int j = 0; j < size; ++j) {
    evaluate_row(j, P);
    for (int k = 0; k < columns; ++k) {
      const double sample = weights[j] * samples[static_cast<std::ptrdiff_t>(columns) * j + k];
      for (int l = 0; l <= K; ++l) {
        for (int m = 0; m <= l; ++m) {
          const auto angle = static_cast<std::size_t>(m) * static_cast<std::size_t>(k) %
                             static_cast<std::size_t>(columns);
          result[sh_index(l, m)] += sample * P[Legendre::index(l, m)] * turn[angle];
        }
      }
    }
  }
}

void ShTransform::Plan::by_fft(const double* samples, Eigen::Ref<Eigen::VectorXcd> result) const {
  const int K = legendre.degree(), columns = 2 * size;
  Eigen::FFT<double> fft;  // holds tables that it makes when used: one for each call
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<double> P(Legendre::count(K));
  std::vector<Complex> spectrum(static_cast<std::size_t>(size) + 1);
  for (int j = 0; j < size; ++j) {
    evaluate_row(j, P);
    fft.fwd(spectrum.data(), samples + static_cast<std::ptrdiff_t>(columns) * j, columns);
    for (int m = 0; m <= K; ++m) spectrum[static_cast<std::size_t>(m)] *= weights[j];
    for (int l = 0; l <= K; ++l) {
      for (int m = 0; m <= l; ++m) {
        result[sh_index(l, m)] += P[Legendre::index(l, m)] * spectrum[static_cast<std::size_t>(m)];
      }
    }
  }
}

ShTransform::ShTransform(int size, int K, ShRoute route) {
  detail::check_image_size(size);
  detail::check_degree_of_image(K, size);
  plan_ = std::make_unique<const Plan>(size, K, route);
}

ShTransform::~ShTransform() = default;
ShTransform::ShTransform(ShTransform&&) noexcept = default;
ShTransform& ShTransform::operator=(ShTransform&&) noexcept = default;

int ShTransform::size() const { return plan_->size; }
int ShTransform::K() const { return plan_->legendre.degree(); }

Eigen::MatrixXcd ShTransform::operator()(const Eigen::Ref<const Eigen::MatrixXd>& samples) const {
  detail::check_samples(samples, Eigen::Index{2} * plan_->size * plan_->size);
  if (plan_->route == ShRoute::svd) return (*plan_->fit)(samples);
  Eigen::MatrixXcd coefficients = Eigen::MatrixXcd::Zero(sh_count(K()), samples.cols());
  for (Eigen::Index c = 0; c < samples.cols(); ++c) {
    if (plan_->route == ShRoute::fft) {
      plan_->by_fft(samples.col(c).data(), coefficients.col(c));
    } else {
      plan_->by_quadrature(samples.col(c).data(), coefficients.col(c));
    }
  }
  detail::fill_negative_orders(coefficients, K());
  return coefficients;
}

}  // namespace shape3d::descriptors
