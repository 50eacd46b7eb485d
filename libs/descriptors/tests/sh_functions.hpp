#pragma once

#include <complex>
#include <cstdint>
#include <random>

#include <Eigen/Core>

#include "shape3d/descriptors/sh.hpp"

// Functions on the sphere for tests, summed without the transforms that are tested.
namespace shape3d::descriptors::test {

/// Coefficients of real functions, normally distributed.
inline Eigen::MatrixXcd random_coefficients(int K, int components, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXcd C(sh_count(K), components);
  for (int c = 0; c < components; ++c) {
    for (int l = 0; l <= K; ++l) {
      C(sh_index(l, 0), c) = normal(random);
      for (int m = 1; m <= l; ++m) {
        const double real = normal(random), imaginary = normal(random);
        C(sh_index(l, m), c) = {real, imaginary};
        C(sh_index(l, -m), c) = (m % 2 == 0 ? 1.0 : -1.0) * std::conj(C(sh_index(l, m), c));
      }
    }
  }
  return C;
}

inline Points image_points(int size) {
  Points points(Eigen::Index{2} * size * size, 3);
  for (int j = 0; j < size; ++j) {
    for (int k = 0; k < 2 * size; ++k) {
      points.row(Eigen::Index{2} * size * j + k) = image_direction(size, j, k);
    }
  }
  return points;
}

inline Points random_directions(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Points points(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) points(i, axis) = normal(random);
    points.row(i).normalize();
  }
  return points;
}

/// The series (4.9), term by term, in blocks of directions.
inline Eigen::MatrixXd values_at(const Eigen::MatrixXcd& C, const Points& points) {
  int K = 0;
  while (sh_count(K) < C.rows()) ++K;
  Eigen::MatrixXd values(points.rows(), C.cols());
  for (Eigen::Index first = 0; first < points.rows(); first += 512) {
    const Eigen::Index count = std::min<Eigen::Index>(512, points.rows() - first);
    values.middleRows(first, count) =
        (spherical_harmonics(points.middleRows(first, count), K) * C).real();
  }
  return values;
}

}  // namespace shape3d::descriptors::test
