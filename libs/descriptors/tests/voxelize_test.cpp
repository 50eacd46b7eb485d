#include "shape3d/descriptors/voxelize.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "meshes.hpp"

namespace {
using namespace shape3d::descriptors;
using namespace shape3d::descriptors::test;
using Eigen::Vector3d;

// Separating axes of a triangle and the cube [p, p + 1], all thirteen, each by projecting all
// corners: independent of the half-plane form that the library uses.
bool meets(const Vector3d* t, const Vector3d& p) {
  const Vector3d edges[3] = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  std::vector<Vector3d> axes{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ(),
                             edges[0].cross(edges[1])};
  for (const Vector3d& edge : edges) {
    for (int axis = 0; axis < 3; ++axis) axes.push_back(edge.cross(Vector3d::Unit(axis)));
  }
  const double longest =
      std::max({edges[0].squaredNorm(), edges[1].squaredNorm(), edges[2].squaredNorm()});
  if (axes[3].norm() < 1e-8 * longest) axes.erase(axes.begin() + 3);  // no plane: a segment
  for (const Vector3d& axis : axes) {
    double low = 1e300, high = -1e300, cube_low = 1e300, cube_high = -1e300;
    for (int i = 0; i < 3; ++i) {
      low = std::min(low, axis.dot(t[i]));
      high = std::max(high, axis.dot(t[i]));
    }
    for (int corner = 0; corner < 8; ++corner) {
      const double at = axis.dot(p + Vector3d(corner & 1, (corner >> 1) & 1, corner >> 2));
      cube_low = std::min(cube_low, at);
      cube_high = std::max(cube_high, at);
    }
    if (low > cube_high || high < cube_low) return false;
  }
  return true;
}

// Distance from a point to a triangle by the regions of its plane (Ericson), in double.
double distance(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const auto to_segment = [&](const Vector3d& from, const Vector3d& to) {
    const double square = (to - from).squaredNorm();
    const double s = square > 0 ? std::clamp((p - from).dot(to - from) / square, 0.0, 1.0) : 0.0;
    return (p - from - s * (to - from)).norm();
  };
  double best = std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
  const Vector3d normal = (b - a).cross(c - a);
  if (normal.norm() > 1e-9) {
    const double height = (p - a).dot(normal.normalized());
    const Vector3d q = p - height * normal.normalized();
    if ((b - a).cross(q - a).dot(normal) >= 0 && (c - b).cross(q - b).dot(normal) >= 0 &&
        (a - c).cross(q - c).dot(normal) >= 0) {
      best = std::min(best, std::abs(height));
    }
  }
  return best;
}

// A soup with everything in it: small, large and outreaching triangles, needles, points, segments,
// duplicates, in both orientations; coordinates of a grid of `side` voxels.
Soup nasty(int side, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vector3d> points;
  const auto somewhere = [&]() -> Vector3d {
    return Vector3d(uniform(generator), uniform(generator), uniform(generator)) * side;
  };
  const auto near = [&](const Vector3d& p, double size) -> Vector3d {
    return Vector3d(p +
                    size * (Vector3d(uniform(generator), uniform(generator), uniform(generator)) -
                            Vector3d::Constant(0.5)));
  };
  for (const double size : {0.01, 0.8, 3.0, 20.0, 500.0}) {
    for (int i = 0; i < 3; ++i) {
      const Vector3d a = somewhere();
      points.insert(points.end(), {a, near(a, size), near(a, size)});
    }
  }
  const Vector3d a = somewhere(), b = somewhere();
  points.insert(points.end(), {a, b, 0.3 * a + 0.7 * b});  // a segment
  points.insert(points.end(), {a, b, 0.3 * a + 0.7 * b + Vector3d(1e-3, 0, 0)});
  points.insert(points.end(), {b, b, b});  // a point
  points.insert(points.end(), {points[3], points[5], points[4]});
  Soup soup;
  soup.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  soup.F.resize(soup.V.rows() / 3, 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    soup.V.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    soup.F(static_cast<Eigen::Index>(i) / 3, static_cast<Eigen::Index>(i % 3)) =
        static_cast<std::int32_t>(i);
  }
  return soup;
}

// The frame in which grid coordinates are the coordinates themselves.
Frame grid_frame(int side) { return {Vector3d::Constant(0.5 * side), 0.5 * side}; }

Voxels voxels_of(const Soup& soup, int side, Fill fill, int threads = 1, double sigma = 2.8) {
  VoxelizeOptions options;
  options.side = side;
  options.fill = fill;
  options.threads = threads;
  options.sigma = sigma;
  return voxelize(soup.V, soup.F, grid_frame(side), options);
}

TEST_CASE("binary voxels are those that separating axes leave", "[descriptors][analytic]") {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const int side = seed % 2 == 0 ? 16 : 11;
    const Soup soup = nasty(side, seed);
    const Voxels voxels = voxels_of(soup, side, Fill::binary);
    int wrong = 0, set = 0;
    for (int k = 0; k < side; ++k) {
      for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
          bool expected = false;
          for (Eigen::Index t = 0; t < soup.F.rows() && !expected; ++t) {
            const Vector3d corners[3] = {soup.V.row(3 * t), soup.V.row(3 * t + 1),
                                         soup.V.row(3 * t + 2)};
            expected = meets(corners, Vector3d(i, j, k));
          }
          wrong += (voxels.at(i, j, k) != 0) != expected ? 1 : 0;
          set += expected ? 1 : 0;
        }
      }
    }
    INFO("seed " << seed << ", " << set << " voxels");
    CHECK(wrong == 0);
    CHECK(set > 100);
  }
}

TEST_CASE("voxels are closed cubes", "[descriptors][analytic]") {
  // A square in the plane between two layers touches both; a corner in a voxel corner touches
  // eight.
  Soup square;
  square.V.resize(4, 3);
  square.V << 4, 4, 5, 8, 4, 5, 8, 8, 5, 4, 8, 5;
  square.F.resize(2, 3);
  square.F << 0, 1, 2, 0, 2, 3;
  const Voxels voxels = voxels_of(square, 12, Fill::binary);
  float sum = 0;
  for (const float value : voxels.values) sum += value;
  CHECK(sum == 6 * 6 * 2);
  for (int k = 4; k <= 5; ++k) {
    for (int j = 3; j <= 8; ++j) {
      for (int i = 3; i <= 8; ++i) CHECK(voxels.at(i, j, k) == 1);
    }
  }
}

TEST_CASE("area voxels hold the area and its first moment", "[descriptors][analytic]") {
  // Tents sum to 1 and reproduce x: exact for any surface within the outermost centres.
  for (const int side : {12, 17, 64}) {
    Soup body = bumpy(side == 64 ? 40 : 5);  // triangles smaller and larger than a voxel
    body.V *= 0.2 * side;
    body.V.rowwise() += Eigen::RowVector3d(0.47, 0.52, 0.5) * side;
    const Voxels voxels = voxels_of(body, side, Fill::area);
    double area = 0, exact = surface_area(body.V, body.F);
    Vector3d moment = Vector3d::Zero();
    for (int k = 0; k < side; ++k) {
      for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
          area += voxels.at(i, j, k);
          moment += voxels.at(i, j, k) * Vector3d(i + 0.5, j + 0.5, k + 0.5);
        }
      }
    }
    CHECK(area == Approx(exact).epsilon(1e-6));
    CHECK((moment / area - surface_frame(body.V, body.F).centre).norm() < 1e-5);
  }
}

TEST_CASE("area voxels are integrals of tents", "[descriptors][analytic]") {
  const int side = 16;
  const Soup soup = nasty(side, 4);
  const Voxels voxels = voxels_of(soup, side, Fill::area);
  // By many points instead; large triangles are cut at the grid by the tents themselves.
  Soup inside = soup;
  inside.F = soup.F.topRows(12);  // up to 20 voxel edges
  const Voxels part = voxels_of(inside, side, Fill::area);
  const SurfacePoints points = surface_points(inside.V, inside.F, 0.02);
  std::vector<double> sums(voxels.values.size(), 0.0);
  for (Eigen::Index p = 0; p < points.weights.size(); ++p) {
    const Vector3d at = points.points.row(p).transpose() - Vector3d::Constant(0.5);
    for (int corner = 0; corner < 8; ++corner) {
      int cell[3];
      double weight = points.weights[p];
      bool within = true;
      for (int axis = 0; axis < 3; ++axis) {
        const double base = std::floor(at[axis]);
        cell[axis] = static_cast<int>(base) + ((corner >> axis) & 1);
        weight *= 1 - std::abs(at[axis] - cell[axis]);
        within = within && cell[axis] >= 0 && cell[axis] < side;
      }
      if (within) sums[voxels.index(cell[0], cell[1], cell[2])] += weight;
    }
  }
  double worst = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    worst = std::max(worst, std::abs(sums[i] - part.values[i]));
  }
  CHECK(worst < 2e-4);
  double total = 0;
  for (const float value : voxels.values) {
    REQUIRE(value >= 0);
    total += value;
  }
  CHECK(total > 100);
}

TEST_CASE("the distance transform is exact", "[descriptors][analytic]") {
  for (const int side : {9, 14}) {
    const Soup soup = nasty(side, 3);
    Soup few = soup;
    few.F = soup.F.topRows(7);
    const Voxels binary = voxels_of(few, side, Fill::binary);
    const double sigma = 1.7;
    const Voxels gedt = voxels_of(few, side, Fill::gedt, 1, sigma);
    double worst = 0;
    for (int k = 0; k < side; ++k) {
      for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
          int best = std::numeric_limits<int>::max();
          for (int c = 0; c < side; ++c) {
            for (int b = 0; b < side; ++b) {
              for (int a = 0; a < side; ++a) {
                if (binary.at(a, b, c) == 0) continue;
                best = std::min(best, (a - i) * (a - i) + (b - j) * (b - j) + (c - k) * (c - k));
              }
            }
          }
          const double d = std::sqrt(best);
          const double expected =
              d <= kGaussianReach * sigma ? std::exp(-best / (2 * sigma * sigma)) : 0.0;
          worst = std::max(worst, std::abs(gedt.at(i, j, k) - expected));
        }
      }
    }
    CHECK(worst < 1e-6);
  }
}

TEST_CASE("distances to the surface are exact", "[descriptors][analytic]") {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const int side = seed % 2 == 0 ? 16 : 19;
    Soup soup = nasty(side, seed);
    if (seed == 5) {
      soup = bumpy(8);
      soup.V *= 0.3 * side;
      soup.V.array() += 0.5 * side;
    }
    const double sigma = 1.5;
    const Voxels voxels = voxels_of(soup, side, Fill::distance, 1, sigma);
    double worst = 0;
    for (int k = 0; k < side; ++k) {
      for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
          const Vector3d p(i + 0.5, j + 0.5, k + 0.5);
          if ((p - Vector3d::Constant(0.5 * side)).norm() > 0.5 * side + 0.87) continue;
          double best = 1e300;
          for (Eigen::Index t = 0; t < soup.F.rows(); ++t) {
            best = std::min(best, distance(p, soup.V.row(soup.F(t, 0)), soup.V.row(soup.F(t, 1)),
                                           soup.V.row(soup.F(t, 2))));
          }
          if (best > kGaussianReach * sigma - 1e-3) continue;
          const double found = sigma * std::sqrt(-2 * std::log(std::min(1.0F, voxels.at(i, j, k))));
          // Near d = 0 the logarithm of a float loses: its square is known to 1e-7.
          worst = std::max(worst, std::abs(found * found - best * best) / (1 + best));
        }
      }
    }
    INFO("seed " << seed);
    CHECK(worst < 1e-4);  // exp at the reach has 4e-6 left, whose last digit is 3e-13
  }
}

TEST_CASE("voxels do not depend on the number of threads", "[descriptors][property]") {
  const Soup soup = joined(
      nasty(33, 8), transformed(bumpy(30), Eigen::Matrix3d::Identity() * 11, Vector3d(16, 17, 15)));
  for (const Fill fill : {Fill::binary, Fill::area, Fill::gedt, Fill::distance}) {
    const Voxels one = voxels_of(soup, 33, fill, 1);
    CHECK(voxels_of(soup, 33, fill, 2).values == one.values);
    CHECK(voxels_of(soup, 33, fill, 5).values == one.values);
  }
}

TEST_CASE("voxels follow offset and scale of the mesh", "[descriptors][property]") {
  const Soup body = bumpy(8);
  for (const Fill fill : {Fill::area, Fill::distance}) {
    VoxelizeOptions options;
    options.side = 32;
    options.fill = fill;
    const Voxels base = voxelize(body.V, body.F, options);
    for (const double size : {1e-9, 1e9}) {
      const Soup moved =
          transformed(body, size * Eigen::Matrix3d::Identity(), size * Vector3d(5, -7, 2));
      const Voxels other = voxelize(moved.V, moved.F, options);
      double worst = 0;
      for (std::size_t i = 0; i < base.values.size(); ++i) {
        worst = std::max(worst, std::abs(double{base.values[i]} - other.values[i]));
      }
      CHECK(worst < 1e-5);
      CHECK(other.spacing() == Approx(size * base.spacing()));
    }
    const Soup far = transformed(body, Eigen::Matrix3d::Identity(), Vector3d::Constant(1e9));
    const Voxels other = voxelize(far.V, far.F, options);
    double worst = 0;
    for (std::size_t i = 0; i < base.values.size(); ++i) {
      worst = std::max(worst, std::abs(double{base.values[i]} - other.values[i]));
    }
    CHECK(worst < 1e-4);  // a coordinate of 1e9 is known to 1.2e-7
  }
}

TEST_CASE("one triangle and duplicate triangles are surfaces", "[descriptors][property]") {
  Soup one;
  one.V.resize(3, 3);
  one.V << 0, 0, 0, 3, 0, 0, 0, 4, 1;
  one.F.resize(1, 3);
  one.F << 0, 1, 2;
  for (const Fill fill : {Fill::binary, Fill::area, Fill::gedt, Fill::distance}) {
    VoxelizeOptions options;
    options.fill = fill;
    const Voxels voxels = voxelize(one.V, one.F, options);
    CHECK(*std::max_element(voxels.values.begin(), voxels.values.end()) > 0.5F);
    const Voxels single = voxelize(one.V, one.F, voxels.frame, options);
    Soup twice = one;
    twice.F.resize(2, 3);
    twice.F << 0, 1, 2, 2, 1, 0;
    const Voxels again = voxelize(twice.V, twice.F, voxels.frame, options);
    double worst = 0;
    for (std::size_t i = 0; i < again.values.size(); ++i) {
      const double copies = fill == Fill::area ? 2 : 1;
      worst = std::max(worst, std::abs(again.values[i] - copies * single.values[i]));
    }
    CHECK(worst < 1e-5);
  }
}

TEST_CASE("wrong options of voxelize are refused", "[descriptors][contract]") {
  const Soup cube = box({0, 0, 0}, {1, 1, 1});
  VoxelizeOptions options;
  options.side = 7;
  CHECK_THROWS_WITH(voxelize(cube.V, cube.F, options), "side is 7, expected 8 … 256");
  options.side = 512;
  CHECK_THROWS_WITH(voxelize(cube.V, cube.F, options), "side is 512, expected 8 … 256");
  options.side = 16;
  options.sigma = 0;
  CHECK_THROWS_WITH(voxelize(cube.V, cube.F, options), "sigma is 0, expected 0.25 … 16");
  options.sigma = 2;
  options.factor = -1;
  CHECK_THROWS_WITH(voxelize(cube.V, cube.F, options),
                    "factor is -1, expected a positive finite number");
  options.factor = 1;
  options.threads = -1;
  CHECK_THROWS_WITH(voxelize(cube.V, cube.F, options),
                    "threads is -1, expected 0 for all processors, or more");
  options.threads = 0;
  CHECK_THROWS_WITH(voxelize(cube.V, cube.F, Frame{Vector3d::Zero(), 0.0}, options),
                    "the frame has radius 0, expected a positive finite one and a finite centre");
  CHECK_THROWS_WITH(voxelize(cube.V, Triangles(0, 3), options), "the mesh has no triangles");
}

}  // namespace
