// Prints one table in Markdown: how far surfaces of zmc and of VTK's extractors are from the truth,
// and what is wrong with their triangles.
//
//   shape3d_zmc_accuracy [DATA]
//
// DATA, or the environment variable SHAPE3D_DATA: a folder with classic/engine_256x256x128.mhd,
// classic/bonsai_256x256x256.mhd and classic/tooth_103x94x161.mhd. Without it their rows are left
// out.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/mesh_check.hpp"
#include "common/volume_io.hpp"
#include "exact_shapes.hpp"
#include "shape3d/extractors.hpp"
#include "support/random_volume.hpp"

namespace shape3d::benchmarks {
namespace {

struct Contestant {
  const char* name;
  apps::Extractor extractor;
  zmc::Triangulation triangulation;
};
constexpr Contestant kContestants[] = {
    {"zmc, compact", apps::Extractor::zmc, zmc::Triangulation::compact},
    {"zmc, centroid", apps::Extractor::zmc, zmc::Triangulation::centroid},
    {"vtkFlyingEdges3D", apps::Extractor::vtk_flying_edges, zmc::Triangulation::compact},
    {"vtkMarchingCubes", apps::Extractor::vtk_marching_cubes, zmc::Triangulation::compact}};

using Distance = std::function<double(const Eigen::Vector3d&)>;

struct Deviation {
  double vertex_max = 0.0, vertex_mean = 0.0;
  double surface_max = 0.0, surface_mean = 0.0;  // the mean is by area
};

/// Over the vertices, and over the 36 points of each triangle whose barycentric coordinates are
/// multiples of 1/7: the corners, the sides and 15 points within.
Deviation deviation(const apps::Mesh& mesh, const Distance& distance) {
  Deviation result;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    const double d = distance(mesh.V.row(v).transpose());
    result.vertex_max = std::max(result.vertex_max, d);
    result.vertex_mean += d / static_cast<double>(mesh.V.rows());
  }
  constexpr int kParts = 7;
  constexpr int kPoints = (kParts + 1) * (kParts + 2) / 2;
  double total = 0.0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Eigen::Vector3d a = mesh.V.row(mesh.F(t, 0)), b = mesh.V.row(mesh.F(t, 1)),
                          c = mesh.V.row(mesh.F(t, 2));
    const double area = 0.5 * (b - a).cross(c - a).norm();
    double sum = 0.0;
    for (int i = 0; i <= kParts; ++i) {
      for (int j = 0; i + j <= kParts; ++j) {
        const double d = distance((i * a + j * b + (kParts - i - j) * c) / kParts);
        result.surface_max = std::max(result.surface_max, d);
        sum += d;
      }
    }
    total += area;
    result.surface_mean += area * sum / kPoints;
  }
  if (total > 0.0) result.surface_mean /= total;
  return result;
}

std::string scientific(const std::optional<Deviation>& deviation, double Deviation::*member) {
  if (!deviation) return "";
  const double value = *deviation.*member;
  if (value == 0.0) return "0";
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

/// One row for each extractor. The samples are restored afterwards.
void print_rows(const std::string& name, apps::NegatableVolume& volume, double isovalue,
                const Distance& distance = {}) {
  for (const Contestant& contestant : kContestants) {
    zmc::Options options;
    options.triangulation = contestant.triangulation;
    options.threads = 1;
    apps::Mesh mesh = run_extractor(contestant.extractor, volume.view(), isovalue, options).mesh;
    apps::merge_coincident(mesh);
    apps::MeshCheckOptions check_options;
    check_options.volume = &volume.view();
    const apps::MeshCheck check = check_mesh(view_of(mesh), check_options);
    std::optional<Deviation> measured;
    if (distance) measured = deviation(mesh, distance);
    volume.negate();
    apps::Mesh negated =
        run_extractor(contestant.extractor, volume.view(), -isovalue, options).mesh;
    volume.negate();
    const std::int64_t changed = apps::triangles_in_one_only(mesh, negated);
    apps::merge_coincident(negated);
    const std::int64_t euler_of_negated = check_mesh(view_of(negated)).euler;
    const auto count = [](std::int64_t n) { return std::to_string(n); };
    std::string row;
    for (const std::string& cell :
         {name, std::string(contestant.name), count(check.vertices), count(check.triangles),
          scientific(measured, &Deviation::vertex_max),
          scientific(measured, &Deviation::vertex_mean),
          scientific(measured, &Deviation::surface_max),
          scientific(measured, &Deviation::surface_mean), count(check.degenerate_triangles),
          count(check.zero_area_triangles), count(check.duplicate_triangles),
          count(check.odd_interior_edges.value_or(0)), count(check.euler), count(euler_of_negated),
          changed == 0 ? std::string("yes") : "no: " + count(changed)}) {
      row += "| " + cell + " ";
    }
    std::printf("%s|\n", row.c_str());
    std::fflush(stdout);
  }
}

void print_shape(const ExactShape& shape) {
  std::vector<std::int32_t> samples;
  samples.reserve(static_cast<std::size_t>(shape.side * shape.side * shape.side));
  std::int64_t zeros = 0;
  for (std::int64_t z = 0; z < shape.side; ++z) {
    for (std::int64_t y = 0; y < shape.side; ++y) {
      for (std::int64_t x = 0; x < shape.side; ++x) {
        samples.push_back(static_cast<std::int32_t>(shape.field(x, y, z)));
        zeros += samples.back() == 0 ? 1 : 0;
      }
    }
  }
  apps::NegatableVolume volume(
      zmc::make_view(samples.data(), {shape.side, shape.side, shape.side}));
  print_rows(shape.name + " (" + std::to_string(zeros) + " zeros)", volume, 0.0, shape.distance);
}

void print_random(int zero_percent) {
  constexpr std::int64_t kSide = 48;
  const std::vector<int> drawn =
      test::random_samples({kSide, kSide, kSide}, 1, zero_percent, 20240 + zero_percent);
  const std::vector<std::int8_t> samples(drawn.begin(), drawn.end());
  apps::NegatableVolume volume(zmc::make_view(samples.data(), {kSide, kSide, kSide}));
  print_rows("random −1, 0, 1; " + std::to_string(zero_percent) + " % zeros", volume, 0.0);
}

void print_measured(const std::filesystem::path& folder, const std::string& file,
                    const std::string& name, double isovalue) {
  const apps::Volume read = apps::read_volume(folder / "classic" / file);
  apps::NegatableVolume volume(read.view);
  char text[32];
  std::snprintf(text, sizeof text, ", isovalue %g", isovalue);
  print_rows(name + text, volume, isovalue);
}

void print_table(const std::filesystem::path& data) {
  std::printf(
      "| volume | extractor | vertices | triangles | vertex max | vertex mean | surface max | "
      "surface mean | repeated id | zero area | duplicates | odd edges | χ | χ negated | neutral "
      "|\n"
      "| --- | --- | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: | --- "
      "|\n");
  print_shape(plane("plane x = c", 33, {1, 0, 0}));
  print_shape(plane("plane x + y = c", 33, {1, 1, 0}));
  print_shape(plane("plane x + y + z = c", 33, {1, 1, 1}));
  print_shape(plane("plane x + 2y + 2z = c", 33, {1, 2, 2}));
  for (const std::int64_t r : {9, 18, 36}) print_shape(sphere(r));
  for (const std::int64_t r : {5, 10, 20}) print_shape(torus(2 * r, r));
  for (const int percent : {5, 30, 60, 90}) print_random(percent);
  if (data.empty()) {
    std::fputs("no data folder is given: measured volumes are left out\n", stderr);
    return;
  }
  print_measured(data, "engine_256x256x128.mhd", "engine", 128);
  print_measured(data, "bonsai_256x256x256.mhd", "bonsai", 40);
  print_measured(data, "tooth_103x94x161.mhd", "tooth", 150);
}

}  // namespace
}  // namespace shape3d::benchmarks

int main(int argc, char** argv) {
  if (argc > 2) {
    std::fputs("usage: shape3d_zmc_accuracy [DATA]\n", stderr);
    return 2;
  }
  const char* environment = std::getenv("SHAPE3D_DATA");
  try {
    shape3d::benchmarks::print_table(argc == 2                ? argv[1]
                                     : environment != nullptr ? environment
                                                              : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
