#include "common/mesh_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "mesh_families.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::test;

MeshCheck check(const Mesh& mesh) { return check_mesh(view_of(mesh)); }

void require_faultless(const MeshCheck& c) {
  CHECK(c.boundary_edges == 0);
  CHECK(c.odd_edges == 0);
  CHECK(c.nonmanifold_edges == 0);
  CHECK(c.nonmanifold_vertices == 0);
  CHECK(c.inconsistent_edges == 0);
  CHECK(c.degenerate_triangles == 0);
  CHECK(c.zero_area_triangles == 0);
  CHECK(c.duplicate_triangles == 0);
  CHECK(c.unreferenced_vertices == 0);
  CHECK(c.coincident_vertices == 0);
  CHECK(c.closed);
  CHECK(c.oriented);
}

TEST_CASE("check of a tetrahedron", "[mesh_check]") {
  const MeshCheck c = check(tetrahedron());
  require_faultless(c);
  CHECK(c.vertices == 4);
  CHECK(c.edges == 6);
  CHECK(c.triangles == 4);
  CHECK(c.components == 1);
  CHECK(c.euler == 2);
  CHECK(c.genus == 0);
  CHECK(c.area == Approx(1.5 + std::sqrt(3.0) / 2).epsilon(1e-14));
  REQUIRE(c.volume);
  CHECK(*c.volume == Approx(1.0 / 6).epsilon(1e-14));
}

TEST_CASE("check of a cube, turned over too", "[mesh_check]") {
  const MeshCheck c = check(cube());
  require_faultless(c);
  CHECK(c.edges == 18);
  CHECK(c.genus == 0);
  CHECK(c.area == Approx(6.0).epsilon(1e-14));
  CHECK(*c.volume == Approx(1.0).epsilon(1e-14));
  const MeshCheck t = check(turned_over(cube()));
  require_faultless(t);
  CHECK(*t.volume == Approx(-1.0).epsilon(1e-14));
}

TEST_CASE("volume and area do not depend on the place", "[mesh_check][property]") {
  Mesh mesh = cube();
  mesh.V.rowwise() += Eigen::RowVector3d(1e6, -2e6, 3e6);
  const MeshCheck c = check(mesh);
  CHECK(*c.volume == Approx(1.0).epsilon(1e-9));
  CHECK(c.area == Approx(6.0).epsilon(1e-9));
  CHECK(c.zero_area_triangles == 0);
}

TEST_CASE("a torus has genus 1 and converges to its area and volume", "[mesh_check][analytic]") {
  constexpr double kPi = 3.141592653589793;
  double previous = 1e9;
  for (const int n : {16, 32, 64}) {
    const MeshCheck c = check(torus(2 * n, n));
    require_faultless(c);
    CHECK(c.vertices == 2 * n * n);
    CHECK(c.edges == 6 * n * n);
    CHECK(c.triangles == 4 * n * n);
    CHECK(c.euler == 0);
    CHECK(c.genus == 1);
    const double area_error = std::abs(c.area - 4 * kPi * kPi * 3),
                 volume_error = std::abs(*c.volume - 2 * kPi * kPi * 3);
    CHECK(area_error + volume_error < previous / 3.5);  // second order: a quarter each time
    previous = area_error + volume_error;
  }
}

TEST_CASE("two components add up", "[mesh_check]") {
  const MeshCheck c = check(together(torus(8, 6), cube(), {10, 0, 0}));
  require_faultless(c);
  CHECK(c.components == 2);
  CHECK(c.euler == 2);
  CHECK(c.genus == 1);
  REQUIRE(c.largest.size() == 2);
  CHECK(c.largest[0].triangles == 96);
  CHECK(c.largest[0].genus() == 1);
  CHECK(c.largest[1].triangles == 12);
  CHECK(c.largest[1].genus() == 0);
}

TEST_CASE("a Moebius strip is neither closed nor orientable", "[mesh_check]") {
  const MeshCheck c = check(moebius_strip(12));
  CHECK(c.vertices == 24);
  CHECK(c.triangles == 24);
  CHECK(c.edges == 48);
  CHECK(c.boundary_edges == 24);
  CHECK(c.nonmanifold_edges == 0);
  CHECK(c.inconsistent_edges == 1);
  CHECK(c.euler == 0);
  CHECK_FALSE(c.genus);
  CHECK_FALSE(c.closed);
  CHECK_FALSE(c.volume);
  CHECK(c.largest.at(0).manifold);
  CHECK_FALSE(c.largest.at(0).orientable);
}

TEST_CASE("a Klein bottle is closed and has no genus", "[mesh_check]") {
  const MeshCheck c = check(torus(12, 8, 3.0, 1.0, true));
  CHECK(c.closed);
  CHECK(c.boundary_edges == 0);
  CHECK(c.euler == 0);
  CHECK(c.inconsistent_edges > 0);
  CHECK_FALSE(c.largest.at(0).orientable);
  CHECK_FALSE(c.genus);
  CHECK_FALSE(c.volume);
}

TEST_CASE("one turned triangle makes its edges inconsistent, not the mesh unorientable",
          "[mesh_check]") {
  Mesh mesh = torus(8, 6);
  std::swap(mesh.F(17, 1), mesh.F(17, 2));
  const MeshCheck c = check(mesh);
  CHECK(c.inconsistent_edges == 3);
  CHECK(c.closed);
  CHECK_FALSE(c.oriented);
  CHECK_FALSE(c.volume);
  CHECK(c.largest.at(0).orientable);
  CHECK(c.genus == 1);
}

TEST_CASE("an edge of four triangles", "[mesh_check]") {
  // Two tetrahedra on opposite sides of a common edge.
  const Mesh mesh = make_mesh(
      {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
      {{0, 3, 2}, {0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 5, 4}, {0, 4, 1}, {0, 1, 5}, {1, 4, 5}});
  const MeshCheck c = check(mesh);
  CHECK(c.nonmanifold_edges == 1);
  CHECK(c.odd_edges == 0);
  CHECK(c.boundary_edges == 0);
  CHECK(c.closed);
  CHECK(c.oriented);
  CHECK(c.components == 1);
  CHECK_FALSE(c.genus);
  CHECK(*c.volume == Approx(1.0 / 3).epsilon(1e-14));
}

TEST_CASE("two cubes that share a vertex", "[mesh_check]") {
  Mesh mesh = together(cube(), cube(), {1, 1, 1});
  // Vertex 6 of the first is at (1,1,1), where vertex 8 + 0 of the second is.
  for (Eigen::Index i = 0; i < mesh.F.size(); ++i) {
    if (mesh.F.data()[i] == 8) mesh.F.data()[i] = 6;
  }
  const MeshCheck c = check(mesh);
  CHECK(c.nonmanifold_edges == 0);
  CHECK(c.nonmanifold_vertices == 1);
  CHECK(c.components == 1);
  CHECK(c.unreferenced_vertices == 1);
  CHECK(c.coincident_vertices == 1);
  CHECK(c.euler == 3);
  CHECK_FALSE(c.genus);
  CHECK(*c.volume == Approx(2.0).epsilon(1e-14));
}

TEST_CASE("degenerate, duplicate and flat triangles", "[mesh_check]") {
  Mesh mesh = make_mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {5, 5, 5}},
                        {{0, 1, 3}, {0, 0, 1}, {3, 1, 0}, {0, 1, 2}, {1, 3, 0}, {2, 2, 2}});
  const MeshCheck c = check(mesh);
  CHECK(c.degenerate_triangles == 2);
  CHECK(c.duplicate_triangles == 2);
  CHECK(c.zero_area_triangles == 1);
  CHECK(c.unreferenced_vertices == 1);
  CHECK(c.area == Approx(1.5).epsilon(1e-14));
}

TEST_CASE("coincident vertices, exact and as floats", "[mesh_check]") {
  Mesh mesh = tetrahedron();
  CHECK(coincident_as_float(view_of(mesh)) == 0);
  mesh.V(1, 0) = 0.0;
  mesh.V(1, 1) = -0.0;
  CHECK(check(mesh).coincident_vertices == 1);  // (0, −0, 0) is (0, 0, 0)
  mesh.V(1, 0) = 1e-50;
  CHECK(check(mesh).coincident_vertices == 0);
  CHECK(coincident_as_float(view_of(mesh)) == 1);
  mesh.V.row(1) << 0, 1 + 1e-12, 0;
  CHECK(check(mesh).coincident_vertices == 0);
  CHECK(coincident_as_float(view_of(mesh)) == 1);
}

TEST_CASE("a mesh without triangles, and without vertices", "[mesh_check]") {
  const MeshCheck c = check(Mesh{});
  CHECK(c.components == 0);
  CHECK(c.euler == 0);
  CHECK_FALSE(c.closed);
  CHECK_FALSE(c.genus);
  CHECK_FALSE(c.volume);
  const MeshCheck points = check(make_mesh({{0, 0, 0}, {1, 1, 1}}, {}));
  CHECK(points.unreferenced_vertices == 2);
  CHECK(points.components == 0);
}

TEST_CASE("odd edges in a border plane of the volume are not interior", "[mesh_check]") {
  // A square over the whole section of a box of 4 × 3 × 3 samples, rotated and moved: its four
  // sides are in border planes, the diagonal is shared.
  zmc::VolumeView volume;
  volume.dims = {4, 3, 3};
  volume.spacing = {0.7, 1.1, 1.3};
  volume.origin = {100, -200, 300};
  volume.direction = (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()) *
                      Eigen::AngleAxisd(-1.1, Eigen::Vector3d::UnitZ()))
                         .toRotationMatrix();
  const auto square = [&](double y_high) {
    std::vector<std::array<double, 3>> points;
    for (const auto& [y, z] : {std::pair{0.0, 0.0}, {y_high, 0.0}, {y_high, 2.0}, {0.0, 2.0}}) {
      const Eigen::Vector3d p = volume.world({1.5, y, z});
      points.push_back({p[0], p[1], p[2]});
    }
    return make_mesh(points, {{0, 1, 2}, {0, 2, 3}});
  };
  MeshCheckOptions options;
  options.volume = &volume;
  const Mesh whole = square(2.0), short_one = square(2.0 - 1.0 / 1048576);
  const MeshCheck c = check_mesh(view_of(whole), options);
  CHECK(c.odd_edges == 4);
  CHECK(c.odd_interior_edges == 0);
  // One side ends 2⁻²⁰ before the border.
  CHECK(check_mesh(view_of(short_one), options).odd_interior_edges == 1);
  CHECK_FALSE(check(whole).odd_interior_edges);
}

// The same counts by other means: maps of sorted ids, flood fill.
struct Naive {
  std::map<std::pair<int, int>, std::array<int, 2>> edges;  // by direction
  std::map<std::array<int, 3>, int> sets;
  int degenerate = 0, components = 0, fans_over_one = 0;

  explicit Naive(const Mesh& mesh) {
    std::map<int, std::set<int>> neighbours;
    std::map<int, std::vector<std::array<int, 3>>> stars;
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
      std::array<int, 3> f{mesh.F(t, 0), mesh.F(t, 1), mesh.F(t, 2)};
      if (std::set<int>(f.begin(), f.end()).size() < 3) {
        ++degenerate;
        continue;
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const int a = f[c], b = f[(c + 1) % 3];
        ++edges[std::minmax(a, b)][a < b ? 0 : 1];
        neighbours[a].insert(b);
        neighbours[b].insert(a);
        stars[a].push_back(f);
      }
      std::sort(f.begin(), f.end());
      ++sets[f];
    }
    std::set<int> seen;
    for (const auto& [v, unused] : neighbours) {
      if (seen.count(v) != 0) continue;
      ++components;
      std::vector<int> queue{v};
      while (!queue.empty()) {
        const int a = queue.back();
        queue.pop_back();
        if (!seen.insert(a).second) continue;
        queue.insert(queue.end(), neighbours[a].begin(), neighbours[a].end());
      }
    }
    for (const auto& [v, star] : stars) fans_over_one += fans(v, star) > 1;
  }

  // Triangles round v, joined where they share an edge at v that has two triangles in all.
  int fans(int v, const std::vector<std::array<int, 3>>& star) {
    std::vector<int> label(star.size());
    for (std::size_t i = 0; i < star.size(); ++i) label[i] = static_cast<int>(i);
    for (std::size_t i = 0; i < star.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        for (const int a : star[i]) {
          if (a == v || std::find(star[j].begin(), star[j].end(), a) == star[j].end()) continue;
          const auto& count = edges[std::minmax(a, v)];
          if (count[0] + count[1] != 2) continue;
          const int from = label[i], to = label[j];
          for (int& l : label) l = l == from ? to : l;
        }
      }
    }
    return static_cast<int>(std::set<int>(label.begin(), label.end()).size());
  }
};

TEST_CASE("counts of random triangles agree with a naive second count", "[mesh_check][property]") {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    const int n = 4 + static_cast<int>(random() % 12), m = static_cast<int>(random() % 40);
    std::vector<std::array<double, 3>> points;
    std::vector<std::array<std::int32_t, 3>> triangles;
    for (int i = 0; i < n; ++i) {
      points.push_back({static_cast<double>(random() % 3), static_cast<double>(random() % 3),
                        static_cast<double>(i)});
    }
    for (int i = 0; i < m; ++i) {
      triangles.push_back({static_cast<std::int32_t>(random() % n),
                           static_cast<std::int32_t>(random() % n),
                           static_cast<std::int32_t>(random() % n)});
    }
    const Mesh mesh = make_mesh(points, triangles);
    const MeshCheck c = check(mesh);
    const Naive naive(mesh);
    std::int64_t boundary = 0, odd = 0, nonmanifold = 0, inconsistent = 0, duplicates = 0;
    for (const auto& [edge, count] : naive.edges) {
      const int all = count[0] + count[1];
      boundary += all == 1;
      odd += all % 2;
      nonmanifold += all > 2;
      inconsistent += all == 2 && count[0] != 1;
    }
    for (const auto& [ids, count] : naive.sets) duplicates += count - 1;
    REQUIRE(c.edges == static_cast<std::int64_t>(naive.edges.size()));
    REQUIRE(c.boundary_edges == boundary);
    REQUIRE(c.odd_edges == odd);
    REQUIRE(c.nonmanifold_edges == nonmanifold);
    REQUIRE(c.inconsistent_edges == inconsistent);
    REQUIRE(c.duplicate_triangles == duplicates);
    REQUIRE(c.degenerate_triangles == naive.degenerate);
    REQUIRE(c.components == naive.components);
    REQUIRE(c.nonmanifold_vertices == naive.fans_over_one);
    // 64-bit ids give the same.
    MeshView wide = view_of(mesh);
    const std::vector<std::int64_t> ids(mesh.F.data(), mesh.F.data() + mesh.F.size());
    wide.indices = ids.data();
    const MeshCheck w = check_mesh(wide);
    REQUIRE(w.components == c.components);
    REQUIRE(w.nonmanifold_vertices == c.nonmanifold_vertices);
    REQUIRE(w.odd_edges == c.odd_edges);
    REQUIRE(w.duplicate_triangles == c.duplicate_triangles);
    REQUIRE(w.euler == c.euler);
  }
}

}  // namespace
