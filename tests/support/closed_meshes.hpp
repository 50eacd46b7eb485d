#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace shape3d::test {

/// Closed genus-zero meshes, counter-clockwise seen from outside.
struct ClosedMesh {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> V;
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor> F;
};

/// Each triangle in four; new vertices are the middles of edges.
inline ClosedMesh subdivided(const ClosedMesh& mesh) {
  ClosedMesh fine;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  std::vector<Eigen::RowVector3d> points;
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) points.emplace_back(mesh.V.row(i));
  const auto middle = [&](std::int32_t a, std::int32_t b) {
    const auto [place, added] = middles.try_emplace(std::minmax(a, b), points.size());
    if (added) points.emplace_back(0.5 * (mesh.V.row(a) + mesh.V.row(b)));
    return place->second;
  };
  fine.F.resize(4 * mesh.F.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const std::int32_t a = mesh.F(t, 0), b = mesh.F(t, 1), c = mesh.F(t, 2);
    const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.F.row(4 * t) << a, ab, ca;
    fine.F.row(4 * t + 1) << ab, b, bc;
    fine.F.row(4 * t + 2) << ca, bc, c;
    fine.F.row(4 * t + 3) << ab, bc, ca;
  }
  fine.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) fine.V.row(i) = points[i];
  return fine;
}

/// The icosahedron subdivided `levels` times, on the unit sphere: 20 · 4^levels triangles.
inline ClosedMesh icosphere(int levels) {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  ClosedMesh mesh;
  mesh.V.resize(12, 3);
  mesh.V << -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, 0, 0, -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, g, 0,
      -1, g, 0, 1, -g, 0, -1, -g, 0, 1;
  mesh.F.resize(20, 3);
  mesh.F << 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6,
      7, 1, 8, 3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9,
      8, 1;
  mesh.V.rowwise().normalize();
  for (int level = 0; level < levels; ++level) {
    mesh = subdivided(mesh);
    mesh.V.rowwise().normalize();
  }
  return mesh;
}

/// A sphere of radius 1 swept along `length` of the x axis: a cylinder with round ends, of `around`
/// vertices on each ring and triangles about as long as wide.
inline ClosedMesh capsule(double length, int around) {
  const double pi = 3.14159265358979323846, step = 2 * pi / around;
  std::vector<std::array<double, 2>> profile;  // x, radius, between the poles
  const int cap = std::max(2, around / 4), rings = std::max(1, int(std::lround(length / step)));
  for (int i = 1; i <= cap; ++i) {
    const double angle = 0.5 * pi * i / cap;
    profile.push_back({-0.5 * length - std::cos(angle), std::sin(angle)});
  }
  for (int i = 1; i < rings; ++i) profile.push_back({length * (double(i) / rings - 0.5), 1});
  for (int i = cap; i >= 1; --i) {
    const double angle = 0.5 * pi * i / cap;
    profile.push_back({0.5 * length + std::cos(angle), std::sin(angle)});
  }
  const int n = int(profile.size());
  ClosedMesh mesh;
  mesh.V.resize(n * around + 2, 3);
  std::vector<std::array<std::int32_t, 3>> triangles;
  const auto at = [&](int ring, int k) { return ring * around + k % around; };
  for (int ring = 0; ring < n; ++ring) {
    for (int k = 0; k < around; ++k) {
      const double angle = step * (k + 0.5 * (ring % 2));
      mesh.V.row(at(ring, k)) << profile[ring][0], profile[ring][1] * std::cos(angle),
          profile[ring][1] * std::sin(angle);
      if (ring + 1 == n) continue;
      const bool odd = ring % 2 == 1;
      if (odd) {
        triangles.push_back({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)});
        triangles.push_back({at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)});
      } else {
        triangles.push_back({at(ring, k), at(ring + 1, k), at(ring, k + 1)});
        triangles.push_back({at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1)});
      }
    }
  }
  const int low = n * around, high = low + 1;
  mesh.V.row(low) << -0.5 * length - 1, 0, 0;
  mesh.V.row(high) << 0.5 * length + 1, 0, 0;
  for (int k = 0; k < around; ++k) {
    triangles.push_back({low, at(0, k), at(0, k + 1)});
    triangles.push_back({high, at(n - 1, k + 1), at(n - 1, k)});
  }
  mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    // Written for an axis that points the other way round.
    mesh.F.row(t) << triangles[t][0], triangles[t][2], triangles[t][1];
  }
  return mesh;
}

/// Random real spherical harmonics of degrees 1 … degree, of variance falling as 1 / l², at unit
/// vectors; the same for the same seed on all machines.
class RandomHarmonics {
 public:
  RandomHarmonics(int degree, unsigned seed) : degree_(degree) {
    std::mt19937 random(seed);
    // Two uniforms for a normal deviate: std::normal_distribution is not the same everywhere.
    const auto uniform = [&random] { return (double(random()) + 0.5) / 4294967296.0; };
    for (int l = 1; l <= degree; ++l) {
      for (int m = -l; m <= l; ++m) {
        const double normal =
            std::sqrt(-2 * std::log(uniform())) * std::cos(6.283185307179586 * uniform());
        coefficients_.push_back(normal / l);
      }
    }
  }

  [[nodiscard]] double operator()(const Eigen::RowVector3d& p) const {
    const double theta = std::acos(std::clamp(p.z(), -1.0, 1.0)), phi = std::atan2(p.y(), p.x());
    double sum = 0;
    std::size_t next = 0;
    for (int l = 1; l <= degree_; ++l) {
      for (int m = -l; m <= l; ++m) {
        const double legendre = std::sph_legendre(unsigned(l), unsigned(std::abs(m)), theta);
        sum += coefficients_[next++] * legendre * (m < 0 ? std::sin(m * phi) : std::cos(m * phi));
      }
    }
    return sum;
  }

 private:
  int degree_;
  std::vector<double> coefficients_;
};

/// Radius exp(amplitude · harmonics) over the unit sphere.
inline ClosedMesh star_shaped(int levels, unsigned seed, double amplitude = 0.6) {
  ClosedMesh mesh = icosphere(levels);
  const RandomHarmonics radius(8, seed);
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    const Eigen::RowVector3d p = mesh.V.row(i);
    mesh.V.row(i) = std::exp(amplitude * radius(p)) * p;
  }
  return mesh;
}

/// Each coordinate an expansion in spherical harmonics (Brechbühler, Gerig, Kübler 1995): the
/// sphere and a random part. Such bodies overhang and may cut through themselves.
inline ClosedMesh spharm_body(int levels, unsigned seed, double amplitude = 0.5) {
  ClosedMesh mesh = icosphere(levels);
  const std::array<RandomHarmonics, 3> parts{RandomHarmonics(6, 3 * seed + 1),
                                             RandomHarmonics(6, 3 * seed + 2),
                                             RandomHarmonics(6, 3 * seed + 3)};
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    const Eigen::RowVector3d p = mesh.V.row(i);
    for (int k = 0; k < 3; ++k) mesh.V(i, k) += amplitude * parts[k](p);
  }
  return mesh;
}

}  // namespace shape3d::test
