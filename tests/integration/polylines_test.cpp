#include "common/polylines.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d;
using namespace shape3d::apps;

zmc::Contour contour_of(Eigen::Index vertices, const std::vector<std::pair<int, int>>& edges) {
  zmc::Contour contour;
  contour.V.setRandom(vertices, 3);
  contour.E.resize(static_cast<Eigen::Index>(edges.size()), 2);
  for (std::size_t e = 0; e < edges.size(); ++e)
    contour.E.row(static_cast<Eigen::Index>(e)) << edges[e].first, edges[e].second;
  return contour;
}

using EdgeCount = std::map<std::pair<int, int>, int>;

EdgeCount edges_of(const std::vector<Polyline>& lines) {
  EdgeCount count;
  for (const Polyline& line : lines) {
    const std::size_t n = line.vertices.size();
    for (std::size_t i = 0; i + (line.closed ? 0 : 1) < n; ++i) {
      ++count[std::minmax({line.vertices[i], line.vertices[(i + 1) % n]})];
    }
  }
  return count;
}

TEST_CASE("two loops and an open line", "[polylines]") {
  const std::vector<Polyline> lines =
      join_edges(contour_of(9, {{0, 1}, {2, 0}, {1, 2}, {3, 4}, {5, 3}, {4, 5}, {7, 8}, {6, 7}}));
  REQUIRE(lines.size() == 3);
  CHECK_FALSE(lines[0].closed);
  CHECK(lines[0].vertices == std::vector<std::int32_t>{6, 7, 8});
  CHECK(lines[1].closed);
  CHECK(lines[1].vertices == std::vector<std::int32_t>{0, 1, 2});
  CHECK(lines[2].closed);
}

TEST_CASE("loops that touch in a vertex come apart", "[polylines]") {
  const std::vector<Polyline> lines =
      join_edges(contour_of(5, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}}));
  REQUIRE(lines.size() == 2);
  for (const Polyline& line : lines) {
    CHECK(line.closed);
    CHECK(line.vertices.size() == 3);
  }
}

TEST_CASE("no edges give no lines", "[polylines]") { CHECK(join_edges(contour_of(3, {})).empty()); }

TEST_CASE("random edges: each is used once, closed lines pass a vertex once, odd vertices are ends",
          "[polylines][property]") {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    const int n = 3 + static_cast<int>(random() % 12);
    std::vector<std::pair<int, int>> edges;
    EdgeCount expected;
    std::map<int, int> degree;
    for (unsigned i = 0; i < random() % 40; ++i) {
      const int a = static_cast<int>(random() % n), b = static_cast<int>(random() % n);
      if (a == b || expected.count(std::minmax({a, b})) != 0) continue;
      edges.emplace_back(a, b);
      ++expected[std::minmax({a, b})];
      ++degree[a];
      ++degree[b];
    }
    const std::vector<Polyline> lines = join_edges(contour_of(n, edges));
    REQUIRE(edges_of(lines) == expected);
    std::multiset<int> ends;
    for (const Polyline& line : lines) {
      const std::set<int> distinct(line.vertices.begin(), line.vertices.end());
      REQUIRE(distinct.size() == line.vertices.size());
      if (!line.closed) ends.insert({line.vertices.front(), line.vertices.back()});
    }
    std::multiset<int> odd;
    for (const auto& [v, d] : degree) {
      if (d % 2 == 1) odd.insert(v);
    }
    REQUIRE(ends == odd);
  }
}

TEST_CASE("a slice is drawn as it is looked at", "[polylines]") {
  zmc::VolumeView volume;
  volume.dims = {11, 21, 31};
  volume.spacing = {1, 2, 3};
  volume.origin = {5, 6, 7};
  // Axial: the patient's left to the right, posterior down.
  const SlicePlane axial(volume, 2);
  CHECK(axial.size() == std::array<double, 2>{10, 40});
  CHECK(axial.project(volume.world({2, 3, 0})) == std::array<double, 2>{2, 6});
  // Coronal and sagittal: superior up.
  CHECK(SlicePlane(volume, 1).project(volume.world({2, 0, 4})) ==
        std::array<double, 2>{2, 90 - 12});
  CHECK(SlicePlane(volume, 0).project(volume.world({0, 3, 4})) ==
        std::array<double, 2>{6, 90 - 12});
  // An axis that runs the other way is flipped.
  volume.direction.col(1) *= -1.0;
  CHECK(SlicePlane(volume, 2).project(volume.world({2, 3, 0})) == std::array<double, 2>{2, 40 - 6});
}

}  // namespace
