#include <cmath>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "common/mesh_io.hpp"
#include "common/surface_distance.hpp"
#include "mesh_families.hpp"
#include "program_run.hpp"
#include "support/test_data.hpp"

namespace {
using namespace shape3d::test;
namespace apps = shape3d::apps;
using Catch::Matchers::Contains;

double point_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const auto inside = [&](const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    return n.dot((v - u).cross(p - u)) >= 0.0;
  };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(n.dot(p - a)) / n.norm();
  const auto to_edge = [&](const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    const double t = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
    return (u + t * (v - u) - p).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

TEST_CASE("distances of parallel squares are those of the plane", "[distance]") {
  const apps::Mesh a =
      make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  apps::Mesh b = a;
  b.V.col(2).array() += 0.25;
  const apps::SurfaceDistance flat = apps::surface_distance(a, b, 1000);
  CHECK(flat.vertices == 4);
  CHECK(flat.sum_of_squares == Approx(4 * 0.0625));
  CHECK(flat.mean_square == Approx(0.0625));
  CHECK(flat.largest == Approx(0.25));
  // Moved along x: points of a with x < 1/2 are 1/2 − x away.
  b = a;
  b.V.col(0).array() += 0.5;
  for (const std::int64_t samples : {100, 1000, 10000, 100000}) {
    const apps::SurfaceDistance moved = apps::surface_distance(a, b, samples);
    CHECK(moved.sum_of_squares == Approx(2 * 0.25));
    // ∫ (1/2 − x)² over 0 … 1/2 is 1/24; the centroids' error is of second order in the side.
    CHECK(moved.mean_square == Approx(1.0 / 24).margin(4.0 / static_cast<double>(samples)));
    CHECK(moved.largest == Approx(0.5));
    CHECK(static_cast<double>(moved.samples) > 0.5 * static_cast<double>(samples));
  }
}

TEST_CASE("distances to a mesh are the least over its triangles", "[distance]") {
  const apps::Mesh b = torus(12, 8);
  apps::Mesh a = torus(9, 7, 2.5, 1.3);
  a.V.rowwise() += Eigen::RowVector3d(0.3, -0.2, 0.5);
  const apps::SurfaceDistance measured = apps::surface_distance(a, b, 500);
  double sum = 0.0;
  for (Eigen::Index v = 0; v < a.V.rows(); ++v) {
    double least = 1e300;
    for (Eigen::Index t = 0; t < b.F.rows(); ++t) {
      least = std::min(least, point_triangle(a.V.row(v), b.V.row(b.F(t, 0)), b.V.row(b.F(t, 1)),
                                             b.V.row(b.F(t, 2))));
    }
    sum += least * least;
  }
  CHECK(measured.sum_of_squares == Approx(sum).epsilon(1e-9));
}

TEST_CASE("the interval holds the Hausdorff distance, and the number of threads is no matter",
          "[distance]") {
  // A sphere-like body in a larger one of the same mesh: each vertex goes outwards by 10 %, and the
  // largest distance is that of a vertex seen from within.
  const apps::Mesh a = torus(40, 20, 3.0, 1.0), b = torus(40, 20, 3.0, 1.1);
  const apps::SurfaceDistance coarse = apps::surface_distance(b, a, 2000, 1),
                              fine = apps::surface_distance(b, a, 200000, 2);
  CHECK(coarse.largest <= fine.largest + 1e-12);
  CHECK(coarse.largest + coarse.spacing >= fine.largest);
  CHECK(fine.largest == Approx(0.1).epsilon(0.05));
  const apps::SurfaceDistance again = apps::surface_distance(b, a, 2000, 3);
  CHECK(again.mean_square == coarse.mean_square);
  CHECK(again.sum_of_squares == coarse.sum_of_squares);
  CHECK(apps::surface_distance(a, a, 1000).largest < 1e-7);
}

TEST_CASE("a surface without area has no distance", "[distance][error]") {
  const apps::Mesh flat = make_mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}});
  CHECK_THROWS_WITH(apps::surface_distance(flat, cube()), "A has no triangle with an area");
  CHECK_THROWS_WITH(apps::surface_distance(cube(), flat), "B has no triangle with an area");
  CHECK_THROWS_WITH(apps::surface_distance(cube(), cube(), 0), Contains("samples is 0"));
}

TEST_CASE("distances of descriptors do not exceed those of the functions", "[distance]") {
  // (5.18), for pairs of meshes and poses; both sides of the program's report.
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  const auto write = [&](const std::string& name, const apps::Mesh& mesh) {
    apps::write_mesh((folder / name).string(), apps::view_of(mesh));
  };
  apps::Mesh turned = torus(30, 15, 3.0, 1.0);
  turned.V = turned.V *
             Eigen::Quaterniond(0.4, -0.3, 0.8, 0.2).normalized().toRotationMatrix().transpose();
  apps::Mesh box = cube();
  box.V.col(0) *= 3.0;
  write("torus.off", torus(30, 15, 3.0, 1.0));
  write("turned.off", turned);
  write("thin.off", torus(30, 15, 3.0, 0.4));
  write("box.off", box);
  write("tetrahedron.off", tetrahedron());
  const std::vector<std::string> names{"torus.off", "turned.off", "thin.off", "box.off",
                                       "tetrahedron.off"};
  double closest = 0.0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      const Run run =
          run_shape3d({"distance", names[i], names[j], "--samples", "500", "--descriptor",
                       "hsh:K=8,voxels=32", "--descriptor", "hsh:K=5,map=two_sided,voxels=32",
                       "--descriptor", "egi", "--json", "d.json"},
                      options);
      INFO(names[i] << " " << names[j] << "\n" << run.out << run.err);
      REQUIRE(run.status == 0);
      const nlohmann::json report = read_json(folder / "d.json");
      for (std::size_t k = 0; k < 2; ++k) {
        const double vectors = report["descriptors"][k]["L2_squared"],
                     functions = report["descriptors"][k]["function_L2_squared"];
        CHECK(vectors <= functions * (1 + 1e-12));
        CHECK(vectors == Approx(std::pow(report["descriptors"][k]["L2"].get<double>(), 2)));
        closest = std::max(closest, vectors / functions);
      }
      CHECK_FALSE(report["descriptors"][2].contains("function_L2_squared"));
      CHECK(report["hausdorff"][0] <= report["hausdorff"][1]);
    }
  }
  CHECK(closest > 0.01);  // the two are numbers of one size
  // The same body turned: nearly nothing between the vectors, much between the functions.
  const Run run = run_shape3d({"distance", "torus.off", "turned.off", "--json", "d.json"}, options);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, Contains("SSD A to B") && Contains("which is not less (5.18)"));
  nlohmann::json report = read_json(folder / "d.json");
  CHECK(report["descriptors"][0]["L2_squared"].get<double>() <
        0.01 * report["descriptors"][0]["function_L2_squared"].get<double>());
  // Aligned, the two are one.
  REQUIRE(run_shape3d({"distance", "thin.off", "thin.off", "--align", "--json", "d.json"}, options)
              .status == 0);
  report = read_json(folder / "d.json");
  CHECK(report["a_to_b"]["sum_of_squares"].get<double>() < 1e-12);
}

TEST_CASE("distance refuses what it cannot measure", "[distance][error]") {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  apps::write_mesh((folder / "cube.off").string(), apps::view_of(cube()));
  apps::write_mesh((folder / "flat.off").string(),
                   apps::view_of(make_mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}})));
  const auto refuses = [&](int status, const std::vector<std::string>& arguments,
                           const std::string& sentence) {
    const Run run = run_shape3d(arguments, options);
    INFO(run.out << run.err);
    CHECK(run.status == status);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(sentence));
  };
  refuses(2, {"distance", "cube.off"}, "B is required");
  refuses(1, {"distance", "cube.off", "none.off"}, "none.off: cannot be opened: No such file");
  refuses(1, {"distance", "flat.off", "cube.off"}, "flat.off: ");
  refuses(2, {"distance", "cube.off", "cube.off", "--descriptor", "x"}, "--descriptor x: ");
  refuses(2, {"distance", "cube.off", "cube.off", "--samples", "0"}, "0");
}

}  // namespace
