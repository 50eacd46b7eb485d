#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include <Eigen/Geometry>

#include "legendre.hpp"
#include "parallel.hpp"
#include "shape3d/descriptors/shape_distribution.hpp"
#include "text.hpp"

namespace shape3d::descriptors {
namespace {

constexpr std::int64_t kParts = 32;  // partial sums, whatever the number of threads

}  // namespace

Eigen::VectorXcd extended_gaussian_image(const Eigen::Ref<const Points>& V,
                                         const Eigen::Ref<const Triangles>& F, int K, int threads) {
  detail::require_between("K", K, 0, Legendre::kMaxDegree);
  threads = detail::resolve_threads(threads);
  const Frame frame = surface_frame(V, F);
  const Legendre legendre(K);
  const std::size_t pairs = Legendre::count(K);
  const std::int64_t count = F.rows(),
                     grain = std::max<std::int64_t>(1, (count + kParts - 1) / kParts);
  struct Part {
    std::vector<std::complex<double>> sums;
    double area = 0.0;
  };
  std::vector<Part> parts(static_cast<std::size_t>((count + grain - 1) / grain));
  detail::parallel_blocks(count, grain, threads, [&](std::int64_t first, std::int64_t last) {
    Part& part = parts[static_cast<std::size_t>(first / grain)];
    part.sums.assign(pairs, 0.0);
    std::vector<double> polar(pairs);
    std::vector<std::complex<double>> turns(static_cast<std::size_t>(K) + 1);
    for (std::int64_t t = first; t < last; ++t) {
      const auto corner = [&](int c) {
        return Eigen::Vector3d((V.row(F(t, c)).transpose() - frame.centre) / frame.radius);
      };
      const Eigen::Vector3d a = corner(0);
      const Eigen::Vector3d cross = (corner(1) - a).cross(corner(2) - a);
      const double twice_area = cross.norm();
      if (twice_area == 0.0) continue;
      const Eigen::Vector3d normal = cross / twice_area;
      part.area += twice_area;
      const double flat = std::hypot(normal[0], normal[1]);
      legendre.evaluate(normal[2], flat, polar.data());
      const std::complex<double> turn =
          flat > 0.0 ? std::complex<double>(normal[0] / flat, -normal[1] / flat) : 1.0;
      turns[0] = twice_area;
      for (std::size_t m = 1; m < turns.size(); ++m) turns[m] = turns[m - 1] * turn;
      for (int l = 0; l <= K; ++l) {
        for (int m = 0; m <= l; ++m) {
          const std::size_t place = Legendre::index(l, m);
          part.sums[place] += polar[place] * turns[static_cast<std::size_t>(m)];
        }
      }
    }
  });
  std::vector<std::complex<double>> total(pairs, 0.0);
  double area = 0.0;
  for (const Part& part : parts) {
    area += part.area;
    for (std::size_t i = 0; i < pairs; ++i) total[i] += part.sums[i];
  }
  Eigen::VectorXcd image(static_cast<Eigen::Index>(K + 1) * (K + 1));
  for (int l = 0; l <= K; ++l) {
    for (int m = 0; m <= l; ++m) {
      const std::complex<double> value = total[Legendre::index(l, m)] / area;
      image[l * l + l - m] = (m % 2 == 0 ? 1.0 : -1.0) * std::conj(value);
      image[l * l + l + m] = value;
    }
  }
  return image;
}

Eigen::VectorXd egi_power(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
                          int K, int threads) {
  const Eigen::VectorXcd image = extended_gaussian_image(V, F, K, threads);
  Eigen::VectorXd power(K + 1);
  for (int l = 0; l <= K; ++l) power[l] = image.segment(l * l, 2 * l + 1).norm();
  return power;
}

}  // namespace shape3d::descriptors
