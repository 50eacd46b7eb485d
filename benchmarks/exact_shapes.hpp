#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace shape3d::benchmarks {

/// A surface known in closed form, and integers sampled on a cube of lattice points whose zero set
/// it is: where the surface passes through a lattice point, the sample is exactly 0.
struct ExactShape {
  std::string name;
  std::int64_t side = 0;  ///< Lattice points along each axis, spacing 1.
  /// f at lattice coordinates, an integer; negative inside.
  std::function<std::int64_t(std::int64_t, std::int64_t, std::int64_t)> field;
  /// Distance of a point to the surface.
  std::function<double(const Eigen::Vector3d&)> distance;
};

/// { p : n · (p − c) = 0 } through the middle c of the lattice, n in integers.
inline ExactShape plane(std::string name, std::int64_t side, std::array<std::int64_t, 3> n) {
  const std::int64_t c = side / 2;
  const Eigen::Vector3d normal(static_cast<double>(n[0]), static_cast<double>(n[1]),
                               static_cast<double>(n[2]));
  const Eigen::Vector3d centre = Eigen::Vector3d::Constant(static_cast<double>(c));
  return {
      std::move(name), side,
      [=](auto x, auto y, auto z) { return n[0] * (x - c) + n[1] * (y - c) + n[2] * (z - c); },
      [=](const Eigen::Vector3d& p) { return std::abs(normal.dot(p - centre)) / normal.norm(); }};
}

/// { p : |p − c|² = r² }, c a lattice point, two samples of margin.
inline ExactShape sphere(std::int64_t r) {
  const std::int64_t c = r + 2;
  const Eigen::Vector3d centre = Eigen::Vector3d::Constant(static_cast<double>(c));
  return {"sphere, r = " + std::to_string(r), 2 * c + 1,
          [=](auto x, auto y, auto z) {
            return (x - c) * (x - c) + (y - c) * (y - c) + (z - c) * (z - c) - r * r;
          },
          [=](const Eigen::Vector3d& p) {
            return std::abs((p - centre).norm() - static_cast<double>(r));
          }};
}

/// { p : (|q|² + R² − r²)² = 4 R² (q_x² + q_y²) }, q = p − c: a torus about the z axis.
inline ExactShape torus(std::int64_t R, std::int64_t r) {
  const std::int64_t c = R + r + 2;
  const Eigen::Vector3d centre = Eigen::Vector3d::Constant(static_cast<double>(c));
  return {"torus, R = " + std::to_string(R) + ", r = " + std::to_string(r), 2 * c + 1,
          [=](auto x, auto y, auto z) {
            const std::int64_t across = (x - c) * (x - c) + (y - c) * (y - c);
            const std::int64_t sum = across + (z - c) * (z - c) + R * R - r * r;
            return sum * sum - 4 * R * R * across;
          },
          [=](const Eigen::Vector3d& p) {
            const Eigen::Vector3d q = p - centre;
            return std::abs(std::hypot(std::hypot(q[0], q[1]) - static_cast<double>(R), q[2]) -
                            static_cast<double>(r));
          }};
}

}  // namespace shape3d::benchmarks
