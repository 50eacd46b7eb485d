#include "viewer/model/surface_data.hpp"

#include <cmath>
#include <map>
#include <vector>

#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <catch2/catch.hpp>
#include <shape3d/zmc/extract.hpp>

#include "common/mesh.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps::viewer;

Surface surface_of(const std::vector<std::int16_t>& samples,
                   const std::array<std::int64_t, 3>& dims) {
  zmc::Options options;
  options.normals = true;
  options.edges = true;
  options.count_nonmanifold = true;
  Surface surface;
  REQUIRE(zmc::extract(zmc::make_view(samples.data(), dims), 0.0, options, surface) ==
          zmc::Status::ok);
  return surface;
}

TEST_CASE("non-manifold edges are as many as ZMC counts, and as a count of all edges finds",
          "[viewer][data]") {
  // Values −1, 0, 1 at random: zeros everywhere.
  std::uint32_t state = 12345;
  for (int round = 0; round < 20; ++round) {
    std::vector<std::int16_t> samples(8 * 8 * 8);
    for (std::int16_t& sample : samples) {
      state = state * 1664525U + 1013904223U;
      sample = static_cast<std::int16_t>(static_cast<int>(state >> 16) % 3 - 1);
    }
    const Surface surface = surface_of(samples, {8, 8, 8});
    const std::vector<std::int32_t> found = nonmanifold_edges(surface);
    CHECK(static_cast<std::int64_t>(found.size() / 2) == surface.counts.nonmanifold_edges);
    std::map<std::pair<int, int>, int> uses;
    for (std::int64_t t = 0; t < surface.triangle_count(); ++t) {
      for (int side = 0; side < 3; ++side) {
        const int a = surface.F()(t, side), b = surface.F()(t, (side + 1) % 3);
        ++uses[{std::min(a, b), std::max(a, b)}];
      }
    }
    std::vector<std::int32_t> expected;
    for (const auto& [edge, count] : uses) {
      if (count > 2) expected.insert(expected.end(), {edge.first, edge.second});
    }
    CHECK(found == expected);
  }
}

TEST_CASE("zero faces are the flat squares of zeros alone", "[viewer][data]") {
  // Negative below k = 3, zero on it, positive above: 5 × 4 cell faces of zeros.
  std::vector<std::int16_t> samples;
  for (int k = 0; k < 7; ++k) {
    for (int n = 0; n < 6 * 5; ++n) samples.push_back(static_cast<std::int16_t>(k - 3));
  }
  const Surface surface = surface_of(samples, {6, 5, 7});
  const auto data = zero_faces(surface);
  REQUIRE(data);
  CHECK(data->GetNumberOfPolys() == 2 * 5 * 4);
  CHECK(data->GetNumberOfPoints() == 6 * 5);
  double bounds[6];
  data->GetBounds(bounds);
  CHECK(bounds[4] == 3.0);
  CHECK(bounds[5] == 3.0);
}

std::vector<std::int16_t> ball(int n, double radius) {
  std::vector<std::int16_t> samples;
  const double middle = (n - 1) / 2.0;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i)
        samples.push_back(static_cast<std::int16_t>(std::lround(
            100.0 * (Eigen::Vector3d(i - middle, j - middle, k - middle).norm() - radius) + 0.5)));
    }
  }
  return samples;
}

TEST_CASE("a surface is handed over whole", "[viewer][data]") {
  const auto samples = ball(24, 9.0);
  Surface surface = surface_of(samples, {24, 24, 24});
  CHECK_FALSE(line_data(surface, {}));
  CHECK_FALSE(zero_faces(surface));
  const auto V = surface.V().eval();
  const auto F = surface.F().eval();
  const auto data = surface_data(std::move(surface));
  REQUIRE(data->GetNumberOfPoints() == V.rows());
  REQUIRE(data->GetNumberOfPolys() == F.rows());
  for (vtkIdType v = 0; v < V.rows(); v += 17) {
    double p[3];
    data->GetPoint(v, p);
    CHECK(p[0] == V(v, 0));
    CHECK(p[2] == V(v, 2));
  }
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  data->GetCellPoints(F.rows() - 1, count, ids);
  REQUIRE(count == 3);
  CHECK(ids[1] == F(F.rows() - 1, 1));
  const auto twin = twin_of(data);
  CHECK(twin->GetNumberOfPolys() == F.rows());
  CHECK(twin->GetPoints() != data->GetPoints());
}

TEST_CASE("a level of detail has about as many triangles as wished, and the same shape",
          "[viewer][data]") {
  const auto samples = ball(96, 40.0);
  const auto data = surface_data(surface_of(samples, {96, 96, 96}));
  REQUIRE(data->GetNumberOfPolys() > 50'000);
  CHECK_FALSE(level_of_detail(data, 1'000'000));
  const auto coarse = level_of_detail(data, 8000);
  REQUIRE(coarse);
  CHECK(coarse->GetNumberOfPolys() > 4000);
  CHECK(coarse->GetNumberOfPolys() < 16'000);
  REQUIRE(coarse->GetPointData()->GetNormals() != nullptr);
  for (vtkIdType v = 0; v < coarse->GetNumberOfPoints(); ++v) {
    Eigen::Vector3d p;
    coarse->GetPoint(v, p.data());
    CHECK((p - Eigen::Vector3d::Constant(47.5)).norm() == Approx(40.0).margin(0.7));
  }
}

TEST_CASE("a mesh has the normals of its triangles by area", "[viewer][data]") {
  apps::Mesh mesh;
  mesh.V.resize(4, 3);
  mesh.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.F.resize(4, 3);
  mesh.F << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3;
  const auto data = mesh_data(mesh);
  CHECK(data->GetNumberOfPolys() == 4);
  double n[3];
  // At the corner of the three right angles: (−1, −1, −1)/√3; at (1, 0, 0): the faces z = 0 and
  // y = 0 of area 1/2 and the slanted one, (1, 1, 1)/2 as a vector of area.
  data->GetPointData()->GetNormals()->GetTuple(0, n);
  for (const double x : n) CHECK(x == Approx(-1.0 / std::sqrt(3.0)));
  data->GetPointData()->GetNormals()->GetTuple(1, n);
  CHECK(n[0] == Approx(1.0));
  CHECK(n[1] == Approx(0.0).margin(1e-6));
}

}  // namespace
