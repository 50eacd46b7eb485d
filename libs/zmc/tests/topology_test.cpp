// Volumes that the dissertation shows: figures 1.2, 2.13, 2.16, 2.17 and 2.19.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "shape3d/zmc/extract.hpp"
#include "surface_set.hpp"

namespace {
using namespace shape3d::zmc;
using namespace shape3d::zmc::test;

using Dims = std::array<std::int64_t, 3>;
using Mesh = Surface<double, std::int32_t>;
using Field = std::function<double(double, double, double)>;

/// f at the lattice points of the box [lower, lower + h (dims - 1)].
struct Sampled {
  Dims dims;
  Eigen::Vector3d lower;
  double h;
  std::vector<double> samples;

  Sampled(const Dims& dimensions, const Eigen::Vector3d& origin, double spacing, const Field& f)
      : dims(dimensions), lower(origin), h(spacing) {
    for (std::int64_t k = 0; k < dims[2]; ++k) {
      for (std::int64_t j = 0; j < dims[1]; ++j) {
        for (std::int64_t i = 0; i < dims[0]; ++i) {
          samples.push_back(f(lower[0] + h * static_cast<double>(i),
                              lower[1] + h * static_cast<double>(j),
                              lower[2] + h * static_cast<double>(k)));
        }
      }
    }
  }
  [[nodiscard]] Sampled negated() const {
    Sampled result = *this;
    for (double& s : result.samples) s = -s;
    return result;
  }
  [[nodiscard]] VolumeView view() const {
    return make_view(samples.data(), dims, Eigen::Vector3d::Constant(h), lower);
  }
  [[nodiscard]] shape3d::test::Exempt border() const {
    Eigen::Vector3d upper;
    for (int axis = 0; axis < 3; ++axis) {
      upper[axis] = lower[axis] + h * static_cast<double>(dims[axis] - 1);
    }
    return shape3d::test::on_border(lower, upper);
  }
};

bool reversed(const Mesh& a, const Mesh& b) {
  if (a.positions != b.positions || a.indices.size() != b.indices.size()) return false;
  for (std::int64_t f = 0; f < a.triangle_count(); ++f) {
    const auto s = a.F().row(f), t = b.F().row(f);
    if (s[0] != t[0] || s[1] != t[2] || s[2] != t[1]) return false;
  }
  return true;
}

using Edge = std::pair<int, int>;

/// Edges with the number of triangles on them.
std::map<Edge, int> edge_degrees(const Mesh& mesh, std::int64_t first = 0, std::int64_t last = -1) {
  std::map<Edge, int> result;
  if (last < 0) last = mesh.triangle_count();
  for (std::int64_t f = first; f < last; ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.F()(f, k), b = mesh.F()(f, (k + 1) % 3);
      ++result[{std::min(a, b), std::max(a, b)}];
    }
  }
  return result;
}

/// The triangles whose vertices all satisfy the predicate.
template <class Predicate>
MeshProperties part(const Mesh& mesh, Predicate predicate) {
  std::vector<std::array<std::int64_t, 3>> kept;
  for (std::int64_t f = 0; f < mesh.triangle_count(); ++f) {
    bool all = true;
    for (int k = 0; k < 3; ++k) {
      all = all && predicate(Eigen::Vector3d(mesh.V().row(mesh.F()(f, k))));
    }
    if (all) kept.push_back({mesh.F()(f, 0), mesh.F()(f, 1), mesh.F()(f, 2)});
  }
  Triangles F(kept.size(), 3);
  for (std::size_t n = 0; n < kept.size(); ++n) F.row(n) << kept[n][0], kept[n][1], kept[n][2];
  return shape3d::test::mesh_properties(Points(mesh.V()), F);
}

TEST_CASE("Fig. 1.2: two V shapes touch along a line of zero edges", "[zmc][topology]") {
  const Sampled volume({3, 3, 4}, {-1, -1, 0}, 1.0,
                       [](double x, double y, double) { return x * x - y * y; });
  const auto triangulation = GENERATE(Triangulation::compact, Triangulation::centroid);
  const auto ties = GENERATE(TieRule::neutral, TieRule::positive);
  Options options;
  options.triangulation = triangulation;
  options.ties = ties;
  options.count_nonmanifold = true;
  const Mesh mesh = extract(volume.view(), 0.0, options);
  CHECK(mesh.counts.patches == 4 * 3);  // A diagonal quad in each cell.
  CHECK(mesh.counts.zero_vertices == 5 * 4);
  CHECK(mesh.vertex_count() - mesh.counts.centroids == 5 * 4);
  CHECK(mesh.counts.zero_faces == 0);
  CHECK(mesh.counts.nonmanifold_edges == 3);  // The middle line: each edge has four polygons.
  for (const auto& [edge, degree] : edge_degrees(mesh)) {
    const Eigen::Vector3d a = mesh.V().row(edge.first), b = mesh.V().row(edge.second);
    const bool middle = a.head<2>().isZero() && b.head<2>().isZero();
    CHECK((degree == 4) == middle);
  }
  const MeshProperties properties = properties_of(mesh, volume.border());
  CHECK(properties.is_clean());
  CHECK(properties.is_closed());
  CHECK(properties.area == Approx(4 * std::sqrt(2.0) * 3.0));
  CHECK(reversed(mesh, extract(volume.negated().view(), 0.0, options)));
}

TEST_CASE("Fig. 2.16: a zero face between equal signs", "[zmc][topology]") {
  const int axis = GENERATE(0, 1, 2);
  Dims dims{2, 2, 2};
  dims[axis] = 3;
  const Sampled volume(dims, {0, 0, 0}, 1.0, [&](double x, double y, double z) {
    return std::array{x, y, z}[axis] == 1.0 ? 0.0 : 1.0;
  });
  Mesh mesh;
  CHECK(extract(volume.view(), 0.0, {}, mesh) == Status::empty);
  CHECK(extract(volume.negated().view(), 0.0, {}, mesh) == Status::empty);
  Options options;
  options.zero_faces = ZeroFaces::mating;
  REQUIRE(extract(volume.view(), 0.0, options, mesh) == Status::ok);
  CHECK(mesh.counts.zero_faces == 1);
  CHECK(mesh.counts.patches == 0);
  CHECK(mesh.vertex_count() == 4);
  CHECK(mesh.triangle_count() == 2);
  CHECK(mesh.kind(0) == TriangleKind::zero_face);
  CHECK(properties_of(mesh).area == Approx(1.0));
  CHECK((mesh.V().col(axis).array() == 1.0).all());
  CHECK(reversed(mesh, extract(volume.negated().view(), 0.0, options)));
}

TEST_CASE("a zero face between different signs is kept once, facing the positive side",
          "[zmc][topology]") {
  const int axis = GENERATE(0, 1, 2);
  const auto mode = GENERATE(ZeroFaces::boundary, ZeroFaces::mating);
  Dims dims{2, 2, 2};
  dims[axis] = 3;
  const Sampled volume(dims, {0, 0, 0}, 1.0, [&](double x, double y, double z) {
    return std::array{x, y, z}[axis] - 1.0;
  });
  Options options;
  options.zero_faces = mode;
  const Mesh mesh = extract(volume.view(), 0.0, options);
  CHECK(mesh.counts.zero_faces == 1);
  REQUIRE(mesh.triangle_count() == 2);
  for (int f = 0; f < 2; ++f) {
    const Eigen::Vector3d a = mesh.V().row(mesh.F()(f, 0)), b = mesh.V().row(mesh.F()(f, 1)),
                          c = mesh.V().row(mesh.F()(f, 2));
    CHECK((b - a).cross(c - a).dot(Eigen::Vector3d::Unit(axis)) == 1.0);
  }
  CHECK(reversed(mesh, extract(volume.negated().view(), 0.0, options)));
}

TEST_CASE("Fig. 2.17: two cones touch in a zero vertex", "[zmc][topology]") {
  // Zero in the middle, positive above and below it: each of the eight cells holds the zero and one
  // of the two.
  const Sampled volume({3, 3, 3}, {-1, -1, -1}, 1.0, [](double x, double y, double z) {
    if (x != 0.0 || y != 0.0) return -1.0;
    return z == 0.0 ? 0.0 : 1.0;
  });
  for (const TieRule ties : {TieRule::neutral, TieRule::positive}) {
    Options options;
    options.ties = ties;
    const Mesh mesh = extract(volume.view(), 0.0, options);
    CHECK(mesh.counts.patches == 8);
    CHECK(mesh.triangle_count() == 8);
    CHECK(mesh.vertex_count() == 1 + 8);
    CHECK(mesh.counts.zero_vertices == 1);
    const MeshProperties properties = properties_of(mesh, volume.border());
    CHECK(properties.is_clean());
    CHECK(properties.is_closed());
    CHECK(properties.components == 1);
    CHECK(properties.edge_components == 2);
    CHECK(properties.nonmanifold_edges == 0);
    CHECK(reversed(mesh, extract(volume.negated().view(), 0.0, options)));
  }
  // The zero alone is an isolated point, in no patch.
  const Sampled isolated({3, 3, 3}, {-1, -1, -1}, 1.0, [](double x, double y, double z) {
    return x == 0.0 && y == 0.0 && z == 0.0 ? 0.0 : -1.0;
  });
  Mesh none;
  CHECK(extract(isolated.view(), 0.0, {}, none) == Status::empty);
  CHECK(extract(isolated.negated().view(), 0.0, {}, none) == Status::empty);
}

constexpr double kRadius = 5.3;
double sphere_field(double x, double y, double z) {
  return std::sqrt(x * x + y * y + z * z) - kRadius;
}

TEST_CASE("Fig. 2.13(a): sphere and square, four parts round their intersection",
          "[zmc][topology]") {
  const Sampled volume({17, 17, 17}, {-8, -8, -8}, 1.0,
                       [](double x, double y, double z) { return sphere_field(x, y, z) * z; });
  Options options;
  options.count_nonmanifold = true;
  const Mesh mesh = extract(volume.view(), 0.0, options);
  const MeshProperties properties = properties_of(mesh, volume.border());
  CHECK(properties.is_clean());
  CHECK(properties.is_closed());
  CHECK(mesh.counts.zero_faces == 16 * 16);  // The whole square.

  // The intersection: a closed line of edges with four triangles, in the plane of the square.
  std::map<int, int> line;
  for (const auto& [edge, degree] : edge_degrees(mesh)) {
    if (degree == 2) continue;
    const Eigen::Vector3d a = mesh.V().row(edge.first), b = mesh.V().row(edge.second);
    if (volume.border()(a, b)) continue;
    CHECK(degree == 4);
    CHECK(a[2] == 0.0);
    CHECK(b[2] == 0.0);
    CHECK(std::abs(a.norm() - kRadius) < 1.5);
    ++line[edge.first];
    ++line[edge.second];
  }
  CHECK(line.size() >= 24);
  for (const auto& [vertex, degree] : line) CHECK(degree == 2);
  CHECK(mesh.counts.nonmanifold_edges == static_cast<std::int64_t>(line.size()));

  // Above and below the square a half sphere each: a disk bounded by that line.
  for (const double side : {1.0, -1.0}) {
    std::vector<std::array<std::int64_t, 3>> kept;
    for (std::int64_t f = 0; f < mesh.triangle_count(); ++f) {
      if (mesh.kind(f) == TriangleKind::zero_face) continue;
      double z = 0.0;
      for (int k = 0; k < 3; ++k) z += mesh.V()(mesh.F()(f, k), 2);
      if (z * side > 0.0) kept.push_back({mesh.F()(f, 0), mesh.F()(f, 1), mesh.F()(f, 2)});
    }
    Triangles F(kept.size(), 3);
    for (std::size_t n = 0; n < kept.size(); ++n) F.row(n) << kept[n][0], kept[n][1], kept[n][2];
    const MeshProperties half = shape3d::test::mesh_properties(Points(mesh.V()), F);
    CHECK(half.components == 1);
    CHECK(half.euler == 1);
    CHECK(half.odd_edges == static_cast<std::int64_t>(line.size()));
    CHECK(half.area == Approx(2 * M_PI * kRadius * kRadius).epsilon(0.05));
  }
  CHECK(reversed(mesh, extract(volume.negated().view(), 0.0)));
}

TEST_CASE("Fig. 2.13(b): sphere and mating square, three parts round their intersection",
          "[zmc][topology]") {
  const Sampled volume({17, 17, 17}, {-8, -8, -8}, 1.0, [](double x, double y, double z) {
    const double s = sphere_field(x, y, z);
    return z == 0.0 && s > 0.0 ? 0.0 : s;
  });
  // The faces of the square outside the sphere and their rim, from the samples.
  const auto is_zero = [&](std::int64_t i, std::int64_t j) {
    return volume.samples[i + 17 * (j + 17 * 8)] == 0.0;
  };
  const auto is_square = [&](std::int64_t i, std::int64_t j) {
    return is_zero(i, j) && is_zero(i + 1, j) && is_zero(i, j + 1) && is_zero(i + 1, j + 1);
  };
  std::int64_t squares = 0, rim = 0;
  for (std::int64_t j = 0; j < 16; ++j) {
    for (std::int64_t i = 0; i < 16; ++i) {
      squares += is_square(i, j);
      if (i > 0) rim += is_square(i, j) != is_square(i - 1, j);
      if (j > 0) rim += is_square(i, j) != is_square(i, j - 1);
    }
  }
  REQUIRE(rim > 0);

  const Mesh whole = extract(volume.view(), 0.0);
  const MeshProperties sphere = properties_of(whole);
  CHECK(whole.counts.zero_faces == 0);
  CHECK(sphere.is_clean());
  CHECK(sphere.is_closed());
  CHECK(sphere.nonmanifold_edges == 0);
  CHECK(sphere.components == 1);
  CHECK(sphere.genus() == 0);

  Options options;
  options.zero_faces = ZeroFaces::mating;
  const Mesh mesh = extract(volume.view(), 0.0, options);
  CHECK(mesh.counts.zero_faces == squares);
  CHECK(mesh.counts.patches == whole.counts.patches);
  CHECK(mesh.first_zero_face == whole.triangle_count());
  // The sphere is as before; where the square ends on it, edges have three triangles.
  const MeshProperties properties = properties_of(mesh, volume.border());
  CHECK(properties.is_clean());
  CHECK(properties.odd_edges == rim);
  CHECK(properties.components == 1);
  std::int64_t three = 0;
  for (const auto& [edge, degree] : edge_degrees(mesh)) three += degree == 3;
  CHECK(three == rim);
  CHECK(reversed(mesh, extract(volume.negated().view(), 0.0, options)));
}

/// Area and volume of the surface of a field at three spacings, each half of the one before: the
/// errors must fall as the square of the spacing. The factor is 16 over two halvings; 10 leaves
/// room for the scatter that the place of the lattice causes.
void check_second_order(const std::function<std::pair<double, double>(int)>& measure, double area,
                        double volume, double tolerance) {
  std::vector<std::pair<double, double>> errors;
  for (const int n : {1, 2, 4}) {
    const auto [a, v] = measure(n);
    errors.emplace_back(std::abs(a - area) / area, std::abs(v - volume) / volume);
  }
  INFO("area errors " << errors[0].first << ' ' << errors[1].first << ' ' << errors[2].first);
  INFO("volume errors " << errors[0].second << ' ' << errors[1].second << ' ' << errors[2].second);
  CHECK(errors[2].first < errors[0].first / 10.0);
  CHECK(errors[2].second < errors[0].second / 10.0);
  CHECK(errors[2].first < tolerance);
  CHECK(errors[2].second < tolerance);
}

TEST_CASE("a sphere through lattice points converges at second order", "[zmc][topology]") {
  const auto triangulation = GENERATE(Triangulation::compact, Triangulation::centroid);
  Options options;
  options.triangulation = triangulation;
  check_second_order(
      [&](int n) {
        const double h = 0.125 / n;
        const std::int64_t size = 24 * n + 1;
        const Sampled volume(
            {size, size, size}, Eigen::Vector3d::Constant(-12 * 0.125), h,
            [](double x, double y, double z) { return x * x + y * y + z * z - 1.0; });
        const Mesh mesh = extract(volume.view(), 0.0, options);
        CHECK(mesh.counts.zero_vertices >= 6);
        const MeshProperties properties = properties_of(mesh);
        CHECK(properties.is_clean());
        CHECK(properties.is_closed());
        CHECK(properties.nonmanifold_edges == 0);
        CHECK(properties.components == 1);
        CHECK(properties.genus() == 0);
        return std::pair{properties.area, properties.volume};
      },
      4.0 * M_PI, 4.0 * M_PI / 3.0, 2e-3);
}

TEST_CASE("Fig. 2.19(a): three tori", "[zmc][topology]") {
  // A chain of three linked rings, the middle one at right angles to the others.
  const double R = 0.5, r = 0.1;
  const auto ring = [=](double u, double v, double w) {
    const double d = std::hypot(u, v) - R;
    return d * d + w * w - r * r;
  };
  const auto field = [=](double x, double y, double z) {
    return std::min({ring(x + 0.7, y, z), ring(x, z, y), ring(x - 0.7, y, z)});
  };
  check_second_order(
      [&](int n) {
        const double h = 0.05 / n;
        const Sampled volume({60 * n + 1, 30 * n + 1, 30 * n + 1}, {-1.5, -0.75, -0.75}, h, field);
        const Mesh mesh = extract(volume.view(), 0.0);
        const MeshProperties properties = properties_of(mesh);
        CHECK(properties.is_clean());
        CHECK(properties.is_closed());
        CHECK(properties.nonmanifold_edges == 0);
        CHECK(properties.components == 3);
        CHECK(properties.edge_components == 3);
        CHECK(properties.genus() == 3);
        return std::pair{properties.area, properties.volume};
      },
      3.0 * 4.0 * M_PI * M_PI * R * r, 3.0 * 2.0 * M_PI * M_PI * R * r * r, 0.03);
}

TEST_CASE("Fig. 2.19(b): four spheres", "[zmc][topology]") {
  const auto spheres = [](double radius) {
    return [=](double x, double y, double z) {
      double result = 1e9;
      for (const double cx : {-1.0, 1.0}) {
        for (const double cy : {-1.0, 1.0}) {
          result =
              std::min(result, (x - cx) * (x - cx) + (y - cy) * (y - cy) + z * z - radius * radius);
        }
      }
      return result;
    };
  };
  SECTION("apart") {
    check_second_order(
        [&](int n) {
          const double h = 0.125 / n;
          const Sampled volume({32 * n + 1, 32 * n + 1, 16 * n + 1}, {-2, -2, -1}, h,
                               spheres(0.75));
          const MeshProperties properties = properties_of(extract(volume.view(), 0.0));
          CHECK(properties.is_clean());
          CHECK(properties.is_closed());
          CHECK(properties.components == 4);
          CHECK(properties.genus() == 0);
          return std::pair{properties.area, properties.volume};
        },
        16.0 * M_PI * 0.75 * 0.75, 16.0 / 3.0 * M_PI * 0.75 * 0.75 * 0.75, 3e-3);
  }
  SECTION("each touching two others in a lattice point") {
    check_second_order(
        [&](int n) {
          const double h = 0.125 / n;
          const std::int64_t size = 36 * n + 1;
          const Sampled volume({size, size, size}, Eigen::Vector3d::Constant(-18 * 0.125), h,
                               spheres(1.0));
          const Mesh mesh = extract(volume.view(), 0.0);
          const MeshProperties properties = properties_of(mesh);
          CHECK(properties.is_clean());
          CHECK(properties.is_closed());
          CHECK(properties.nonmanifold_edges == 0);
          CHECK(properties.components == 1);
          CHECK(properties.edge_components == 4);
          // Four spheres (8) with four pairs of points identified.
          CHECK(properties.euler == 8 - 4);
          CHECK(reversed(mesh, extract(volume.negated().view(), 0.0)));
          return std::pair{properties.area, properties.volume};
        },
        16.0 * M_PI, 16.0 / 3.0 * M_PI, 3e-3);
  }
}

TEST_CASE("Fig. 2.19(c): a drip, hanging from its funnel by one zero vertex", "[zmc][topology]") {
  // x^2 + y^2 = z^2 (1 - z) / 2: a drop for 0 < z < 1 and a funnel for z < 0, cones at the origin.
  const auto field = [](double x, double y, double z) {
    return x * x + y * y - z * z * (1.0 - z) / 2.0;
  };
  // Surface of revolution with radius p(z): area 2 pi times the integral of sqrt(p^2 + (p p')^2).
  const auto integrand = [](double z) {
    const double squared = z * z * (1.0 - z) / 2.0, slope = (2.0 * z - 3.0 * z * z) / 4.0;
    return std::sqrt(squared + slope * slope);
  };
  double area = 0.0;
  constexpr int kSteps = 20000;  // Simpson
  for (int n = 0; n < kSteps; ++n) {
    const double a = static_cast<double>(n) / kSteps, b = static_cast<double>(n + 1) / kSteps;
    area += (integrand(a) + 4.0 * integrand((a + b) / 2.0) + integrand(b)) / (6.0 * kSteps);
  }
  area *= 2.0 * M_PI;
  check_second_order(
      [&](int n) {
        const double h = 0.0625 / n;
        const Sampled volume({20 * n + 1, 20 * n + 1, 24 * n + 1}, {-0.625, -0.625, -0.375}, h,
                             field);
        const Mesh mesh = extract(volume.view(), 0.0);
        const MeshProperties all = properties_of(mesh, volume.border());
        CHECK(all.is_clean());
        CHECK(all.is_closed());
        CHECK(all.nonmanifold_edges == 0);
        CHECK(all.components == 1);
        CHECK(all.edge_components == 2);
        const MeshProperties drop =
            part(mesh, [](const Eigen::Vector3d& p) { return p[2] >= 0.0; });
        CHECK(drop.is_closed());
        CHECK(drop.components == 1);
        CHECK(drop.genus() == 0);
        CHECK(reversed(mesh, extract(volume.negated().view(), 0.0)));
        return std::pair{drop.area, drop.volume};
      },
      area, M_PI / 24.0, 0.01);
}

TEST_CASE("Fig. 2.19(d): a case of eight parts round one zero vertex", "[zmc][topology]") {
  const Sampled volume({9, 9, 9}, {-4, -4, -4}, 1.0,
                       [](double x, double y, double z) { return x * y * z; });
  const Mesh mesh = extract(volume.view(), 0.0);
  CHECK(mesh.counts.patches == 0);
  CHECK(mesh.counts.zero_faces == 3 * 8 * 8);
  CHECK(mesh.counts.zero_vertices == 3 * 81 - 3 * 9 + 1);
  const MeshProperties properties = properties_of(mesh, volume.border());
  CHECK(properties.is_clean());
  CHECK(properties.is_closed());
  CHECK(properties.components == 1);
  CHECK(properties.area == Approx(3 * 64.0));
  CHECK(reversed(mesh, extract(volume.negated().view(), 0.0)));

  // Twelve quads meet in the origin: their corners there add up to twelve right angles.
  double angle = 0.0;
  std::set<int> neighbours;
  for (std::int64_t f = 0; f < mesh.triangle_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d a = mesh.V().row(mesh.F()(f, k));
      if (!a.isZero()) continue;
      const int second = mesh.F()(f, (k + 1) % 3), third = mesh.F()(f, (k + 2) % 3);
      const Eigen::Vector3d b = mesh.V().row(second), c = mesh.V().row(third);
      angle += std::acos(b.dot(c) / (b.norm() * c.norm()));
      for (const int v : {second, third}) {
        if (mesh.V().row(v).norm() == 1.0) neighbours.insert(v);
      }
    }
  }
  CHECK(angle == Approx(12.0 * M_PI / 2.0));
  CHECK(neighbours.size() == 6);
  // Each of the six edges at the origin has four quads.
  for (const auto& [edge, degree] : edge_degrees(mesh)) {
    const Eigen::Vector3d a = mesh.V().row(edge.first), b = mesh.V().row(edge.second);
    if ((a.isZero() && b.norm() == 1.0) || (b.isZero() && a.norm() == 1.0)) CHECK(degree == 4);
  }
  // Eight parts: the connected groups of samples that are not zero.
  std::vector<int> part_of(volume.samples.size(), -1);
  int parts = 0;
  for (std::size_t start = 0; start < part_of.size(); ++start) {
    if (volume.samples[start] == 0.0 || part_of[start] >= 0) continue;
    std::vector<std::int64_t> open{static_cast<std::int64_t>(start)};
    part_of[start] = parts;
    while (!open.empty()) {
      const std::int64_t n = open.back();
      open.pop_back();
      const Dims at{n % 9, n / 9 % 9, n / 81};
      const Dims strides{1, 9, 81};
      for (int axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
          if (at[axis] + step < 0 || at[axis] + step > 8) continue;
          const std::int64_t m = n + step * strides[axis];
          if (volume.samples[m] * volume.samples[n] <= 0.0 || part_of[m] >= 0) continue;
          part_of[m] = parts;
          open.push_back(m);
        }
      }
    }
    ++parts;
  }
  CHECK(parts == 8);
}
}  // namespace
