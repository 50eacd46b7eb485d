#include "meshes.hpp"

#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace shape3d::descriptors::test {

using Eigen::Vector3d;

Soup box(const Vector3d& low, const Vector3d& high) {
  Soup soup;
  soup.V.resize(8, 3);
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      soup.V(corner, axis) = ((corner >> axis) & 1) != 0 ? high[axis] : low[axis];
    }
  }
  soup.F.resize(12, 3);
  soup.F << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6,  // z
      0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7,        // y
      0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5;        // x
  return soup;
}

Soup sphere(int n) {
  std::vector<Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  std::map<std::array<int, 3>, int> ids;
  const auto vertex = [&](const Eigen::Vector3i& p) {
    const auto [place, is_new] =
        ids.try_emplace({p[0], p[1], p[2]}, static_cast<int>(points.size()));
    if (is_new) points.push_back(p.cast<double>().normalized());
    return place->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3i sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
    const bool flip = sign.prod() < 0;
    const auto at = [&](int i, int j) {
      return vertex(sign.cwiseProduct(Eigen::Vector3i(i, j, n - i - j)));
    };
    const auto add = [&](int a, int b, int c) {
      triangles.push_back(flip ? Eigen::Vector3i(a, c, b) : Eigen::Vector3i(a, b, c));
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        add(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < n) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  Soup soup;
  soup.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    soup.V.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  }
  soup.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    soup.F.row(static_cast<Eigen::Index>(i)) = triangles[i].transpose();
  }
  return soup;
}

Soup bumpy(int n) {
  Soup soup = sphere(n);
  for (Eigen::Index i = 0; i < soup.V.rows(); ++i) {
    const double x = soup.V(i, 0), y = soup.V(i, 1), z = soup.V(i, 2);
    soup.V.row(i) *= 1.0 + 0.3 * x + 0.35 * x * y * z + 0.25 * (x * x - y * y) + 0.2 * z * z * z -
                     0.15 * y * z + 0.2 * x * x * x * y;
  }
  return soup;
}

Soup joined(const Soup& a, const Soup& b) {
  Soup soup;
  soup.V.resize(a.V.rows() + b.V.rows(), 3);
  soup.V << a.V, b.V;
  soup.F.resize(a.F.rows() + b.F.rows(), 3);
  soup.F << a.F, b.F.array() + static_cast<std::int32_t>(a.V.rows());
  return soup;
}

Soup transformed(const Soup& soup, const Eigen::Matrix3d& linear, const Vector3d& offset) {
  Soup result = soup;
  for (Eigen::Index i = 0; i < soup.V.rows(); ++i) {
    result.V.row(i) = (linear * soup.V.row(i).transpose() + offset).transpose();
  }
  return result;
}

Eigen::Matrix3d random_rotation(std::uint64_t count) {
  std::mt19937_64 generator(0x5eedULL + 977ULL * count);
  std::normal_distribution<double> normal;
  Eigen::Quaterniond q(normal(generator), normal(generator), normal(generator), normal(generator));
  return q.normalized().toRotationMatrix();
}

}  // namespace shape3d::descriptors::test
