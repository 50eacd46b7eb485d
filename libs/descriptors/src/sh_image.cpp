#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <string>
#include <vector>

#include <unsupported/Eigen/FFT>

#include "legendre.hpp"
#include "sh_checks.hpp"
#include "shape3d/descriptors/sh.hpp"
#include "text.hpp"

namespace shape3d::descriptors {

using Complex = std::complex<double>;

Eigen::Vector3d image_direction(int size, int row, int column) {
  const double theta = detail::kPi * (2.0 * row + 1.0) / (2.0 * size);
  const double phi = detail::kPi * column / size;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

Eigen::VectorXd image_weights(int size) {
  detail::check_image_size(size);
  // ∫ p over [−1, 1] = ∫ p(cos θ) sin θ dθ, the integrand's cosine series taken term by term:
  // ∫ cos(2kθ) sin θ dθ = −2/(4k² − 1).
  Eigen::VectorXd weights(size);
  for (int j = 0; j < size; ++j) {
    const double theta = detail::kPi * (2.0 * j + 1.0) / (2.0 * size);
    double sum = 0.0;
    for (int k = size / 2 - 1; k >= 1; --k) {
      sum += std::cos(2.0 * k * theta) / (4.0 * k * k - 1.0);
    }
    // cos(nθ_j) = 0: the term of 2k = n has no weight.
    weights[j] = 2.0 / size * (1.0 - 2.0 * sum);
  }
  return weights;
}

Eigen::MatrixXd sh_reconstruct(const Eigen::Ref<const Eigen::MatrixXcd>& coefficients, int size) {
  detail::check_image_size(size);
  const int K = detail::degree_of(coefficients);
  detail::check_degree_of_image(K, size);
  const Legendre legendre(K);
  const auto columns = static_cast<std::size_t>(2 * size);
  std::vector<double> P(Legendre::count(K));
  std::vector<Complex> spectrum(columns / 2 + 1);
  std::vector<double> row(columns);
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::MatrixXd samples(Eigen::Index{2} * size * size, coefficients.cols());
  for (int j = 0; j < size; ++j) {
    const double theta = detail::kPi * (2.0 * j + 1.0) / (2.0 * size);
    legendre.evaluate(std::cos(theta), std::sin(theta), P.data());
    for (Eigen::Index c = 0; c < coefficients.cols(); ++c) {
      std::fill(spectrum.begin(), spectrum.end(), Complex(0.0));
      for (int l = 0; l <= K; ++l) {
        for (int m = 0; m <= l; ++m) {
          spectrum[static_cast<std::size_t>(m)] +=
              coefficients(sh_index(l, m), c) * P[Legendre::index(l, m)];
        }
      }
      for (Complex& value : spectrum) value *= 2.0 * size;  // inv() divides by the length
      fft.inv(row.data(), spectrum.data(), static_cast<Eigen::Index>(columns));
      samples.col(c).segment(Eigen::Index{2} * size * j, 2 * size) =
          Eigen::Map<const Eigen::VectorXd>(row.data(), 2 * size);
    }
  }
  return samples;
}

double sh_residual(const Eigen::Ref<const Eigen::MatrixXcd>& coefficients,
                   const Eigen::Ref<const Eigen::MatrixXd>& samples, int size) {
  const Eigen::MatrixXd series = sh_reconstruct(coefficients, size);
  detail::check_samples(samples, series.rows());
  if (samples.cols() != series.cols()) {
    throw std::invalid_argument("samples has " + std::to_string(samples.cols()) +
                                " components, expected those of coefficients, " +
                                std::to_string(series.cols()));
  }
  const Eigen::VectorXd weights = image_weights(size);
  double rest = 0.0, whole = 0.0;
  for (int j = 0; j < size; ++j) {
    const auto rows = Eigen::seqN(Eigen::Index{2} * size * j, 2 * size);
    rest += weights[j] * (samples(rows, Eigen::all) - series(rows, Eigen::all)).squaredNorm();
    whole += weights[j] * samples(rows, Eigen::all).squaredNorm();
  }
  return whole > 0.0 ? std::sqrt(rest / whole) : 0.0;
}

namespace detail {

void check_image_size(int size) {
  if (size % 2 != 0) {
    throw std::invalid_argument("size is " + std::to_string(size) +
                                ", expected an even number of rows");
  }
  require_between("size", size, kMinImageSize, kMaxImageSize);
}

void check_degree_of_image(int K, int size) {
  if (K < 0 || K > sh_largest_degree(size)) {
    throw std::invalid_argument("K is " + std::to_string(K) + ", expected 0 … " +
                                std::to_string(sh_largest_degree(size)) + ", the bandwidth of " +
                                std::to_string(size) + " rows");
  }
}

void check_samples(const Eigen::Ref<const Eigen::MatrixXd>& samples, Eigen::Index rows) {
  if (samples.rows() != rows) {
    throw std::invalid_argument("samples has " + std::to_string(samples.rows()) +
                                " rows, expected " + std::to_string(rows));
  }
  for (Eigen::Index c = 0; c < samples.cols(); ++c) {
    for (Eigen::Index i = 0; i < samples.rows(); ++i) {
      if (!std::isfinite(samples(i, c))) {
        throw std::invalid_argument("samples(" + std::to_string(i) + ", " + std::to_string(c) +
                                    ") is " + number(samples(i, c)) + ", expected finite numbers");
      }
    }
  }
}

int degree_of(const Eigen::Ref<const Eigen::MatrixXcd>& coefficients) {
  const int K = static_cast<int>(std::lround(std::sqrt(double(coefficients.rows())))) - 1;
  if (K < 0 || sh_count(K) != coefficients.rows()) {
    throw std::invalid_argument("coefficients has " + std::to_string(coefficients.rows()) +
                                " rows, expected (K + 1)², a square");
  }
  return K;
}

}  // namespace detail
}  // namespace shape3d::descriptors
