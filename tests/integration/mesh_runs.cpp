#include "mesh_runs.hpp"

#include <array>
#include <cmath>

#include <catch2/catch.hpp>

namespace shape3d::test {

using apps::Mesh;

Run run_in(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
  RunOptions options;
  options.folder = folder.path();
  const Run run = run_shape3d(arguments, options);
  CHECK(run.err.find("ERR|") == std::string::npos);  // VTK's log
  return run;
}

Mesh mesh_in(const TemporaryFolder& folder, const std::string& name) {
  return apps::read_mesh((folder / name).string()).mesh;
}

bool is_png(const std::string& bytes) { return bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n"; }

Mesh pear(int n) {
  Mesh mesh;
  constexpr double kPi = 3.141592653589793;
  mesh.V.resize(n * (n - 1) + 2, 3);
  const auto place = [](const Eigen::RowVector3d& u) -> Eigen::RowVector3d {
    const double x = u[0], y = u[1], z = u[2];
    return {x + 0.42 * x * x + 0.1 * y * z, 1.4 * y - 0.49 * y * y, 2.1 * z + 0.84 * z * z};
  };
  for (int j = 1; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double theta = kPi * j / n, phi = 2 * kPi * (i + 0.5 * (j % 2)) / n;
      mesh.V.row(i + n * (j - 1)) = place(Eigen::RowVector3d(
          std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
    }
  }
  const int north = n * (n - 1), south = north + 1;
  mesh.V.row(north) = place({0, 0, 1});
  mesh.V.row(south) = place({0, 0, -1});
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n, last = n * (n - 2);
    triangles.push_back({north, i, next});
    triangles.push_back({south, last + next, last + i});
    for (int j = 1; j + 1 < n; ++j) {
      const int a = i + n * (j - 1), b = next + n * (j - 1), c = i + n * j, d = next + n * j;
      if (j % 2 == 1) {
        triangles.push_back({a, c, d});
        triangles.push_back({a, d, b});
      } else {
        triangles.push_back({a, c, b});
        triangles.push_back({b, c, d});
      }
    }
  }
  mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    mesh.F.row(static_cast<Eigen::Index>(t)) << triangles[t][0], triangles[t][1], triangles[t][2];
  return mesh;
}

void save(const TemporaryFolder& folder, const std::string& name, const Mesh& mesh) {
  apps::write_mesh((folder / name).string(), view_of(mesh));
}

Mesh without(const Mesh& mesh, Eigen::Index first, Eigen::Index count) {
  Mesh rest = mesh;
  rest.F.resize(mesh.F.rows() - count, 3);
  rest.F << mesh.F.topRows(first), mesh.F.bottomRows(mesh.F.rows() - first - count);
  return rest;
}

}  // namespace shape3d::test
