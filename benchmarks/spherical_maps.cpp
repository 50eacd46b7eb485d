// Maps meshes to the sphere and writes the tables of docs/results/spherical-maps.md.
//   shape3d_spherical_maps [--flow-limit SECONDS] [FOLDER of .off files]
// No flow is begun after that many seconds of them; 0 leaves them out.
// Each mesh is mapped in a process of its own, whose peak of memory is its own.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <shape3d/mapping/spherical_map.hpp>

#include "markdown_table.hpp"
#include "mean_curvature_flow.hpp"
#include "support/closed_meshes.hpp"
#include "support/off_file.hpp"

namespace {
using namespace shape3d::mapping;
using shape3d::bench::fixed;
using shape3d::bench::MarkdownTable;
using shape3d::test::ClosedMesh;

struct Subject {
  std::string name;
  std::function<ClosedMesh()> make;
};

/// What a child process hands back; plain, so that its bytes can go through a pipe.
struct Row {
  bool done = false;
  long triangles = 0;
  char status[96] = "";
  char termination[32] = "";
  Quantiles angle, linear_angle, flow_angle, sigma, linear_sigma, flow_sigma;
  double cost_before = 0, cost_after = 0, energy = 0, starved = 0, shortest = 0;
  int iterations = 0;
  long untangled = 0, flips = 0, flow_flipped = -1;
  int flow_steps = 0;
  double flow_roundness = 0;
  double linear_seconds = 0, seconds = 0, flow_seconds = 0;
  long peak_mebibytes = 0;
  /// The worst triangle: its least angle in the mesh, in degrees.
  double worst_least_angle = 0;
  long over_ten = 0, over_ten_slivers = 0;
};

/// A triangle with an angle under this, in degrees, is a sliver.
constexpr double kSliver = 5;

double least_angle(const ClosedMesh& mesh, Eigen::Index t) {
  double least = 180;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d p = mesh.V.row(mesh.F(t, k));
    const Eigen::Vector3d a = mesh.V.row(mesh.F(t, (k + 1) % 3)).transpose() - p;
    const Eigen::Vector3d b = mesh.V.row(mesh.F(t, (k + 2) % 3)).transpose() - p;
    least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)) * 57.29577951308232);
  }
  return least;
}

void copy(std::string_view from, char* to, std::size_t size) {
  std::snprintf(to, size, "%.*s", static_cast<int>(from.size()), from.data());
}

void map_mesh(const ClosedMesh& mesh, Row& row) {
  SphericalMapOptions options;
  options.linear = true;
  const SphericalMap linear = spherical_map(mesh.V, mesh.F, options);
  options.linear = false;
  const SphericalMap map = spherical_map(mesh.V, mesh.F, options);
  row.triangles = mesh.F.rows();
  copy(to_string(map.status), row.status, sizeof row.status);
  copy(map.minimisation.termination, row.termination, sizeof row.termination);
  row.angle = map.distortion.angle_change;
  row.sigma = map.distortion.sigma_ratio;
  row.linear_angle = linear.distortion.angle_change;
  row.linear_sigma = linear.distortion.sigma_ratio;
  row.energy = map.distortion.energy_over_area;
  row.starved = map.distortion.starved_area_share;
  row.shortest = map.distortion.shortest_edge;
  row.cost_before = map.minimisation.initial_cost;
  row.cost_after = map.minimisation.final_cost;
  row.iterations = map.minimisation.iterations;
  row.untangled = map.untangled_triangles;
  row.flips = map.delaunay_flips;
  row.linear_seconds = linear.seconds.total;
  row.seconds = map.seconds.total;
  if (map.status != Status::certified) return;
  const TriangleDistortion each = triangle_distortion(mesh.V, mesh.F, map.S);
  double worst = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const double sigma = each.sigma_ratio[t];
    if (sigma > worst) {
      worst = sigma;
      row.worst_least_angle = least_angle(mesh, t);
    }
    if (sigma > 10) {
      ++row.over_ten;
      row.over_ten_slivers += least_angle(mesh, t) < kSliver ? 1 : 0;
    }
  }
}

void flow_mesh(const ClosedMesh& mesh, Row& row) {
  const auto flow = shape3d::bench::mean_curvature_flow(mesh, 100, 1e-2);
  row.flow_steps = flow.steps;
  row.flow_seconds = flow.seconds;
  row.flow_roundness = flow.roundness;
  if (flow.steps == 0) return;
  const Certificate certificate = certify(flow.S, mesh.F);
  row.flow_flipped = certificate.flipped + certificate.degenerate;
  const Distortion distortion = measure_distortion(mesh.V, mesh.F, flow.S);
  row.flow_angle = distortion.angle_change;
  row.flow_sigma = distortion.sigma_ratio;
}

/// A child process at work, and the pipe that its row comes through.
struct Child {
  pid_t process = -1;
  int pipe = -1;
};

Child start(const Subject& subject, void (*work)(const ClosedMesh&, Row&)) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t process = fork();
  if (process == 0) {
    Row row;
    try {
      work(subject.make(), row);
    } catch (const std::exception& error) {
      copy(error.what(), row.status, sizeof row.status);
    }
    row.done = true;
    const bool written = write(ends[1], &row, sizeof row) == static_cast<ssize_t>(sizeof row);
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  return {process, ends[0]};
}

Row finish(const Child& child) {
  Row row;
  std::size_t got = 0;
  while (child.process > 0 && got < sizeof row) {
    const ssize_t n = read(child.pipe, reinterpret_cast<char*>(&row) + got, sizeof row - got);
    if (n <= 0) break;
    got += static_cast<std::size_t>(n);
  }
  rusage usage{};
  if (child.process > 0) {
    int status = 0;
    close(child.pipe);
    wait4(child.process, &status, 0, &usage);
  }
  if (got < sizeof row) row = Row();
  if (!row.done) copy("the process ended early", row.status, sizeof row.status);
  row.peak_mebibytes = usage.ru_maxrss / 1024;
  return row;
}

std::vector<Subject> generated() {
  using namespace shape3d::test;
  std::vector<Subject> subjects;
  for (const int length : {10, 20, 30, 40, 50, 60, 80, 120}) {
    subjects.push_back({"capsule, length / radius " + std::to_string(length),
                        [length] { return capsule(length, 32); }});
  }
  for (unsigned seed = 1; seed <= 5; ++seed) {
    subjects.push_back(
        {"star-shaped " + std::to_string(seed), [seed] { return star_shaped(4, seed); }});
  }
  for (unsigned seed = 1; seed <= 5; ++seed) {
    subjects.push_back({"spherical harmonics " + std::to_string(seed),
                        [seed] { return spharm_body(4, seed, 0.8); }});
  }
  return subjects;
}

int run(int argc, char** argv) {
  double flow_limit = 1e9;
  std::vector<Subject> subjects;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--flow-limit") == 0 && i + 1 < argc) {
      flow_limit = std::atof(argv[++i]);
      continue;
    }
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(argv[i])) {
      if (entry.path().extension() == ".off") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
      subjects.push_back({file.stem().string(), [file] { return shape3d::test::read_off(file); }});
    }
  }
  for (Subject& subject : generated()) subjects.push_back(std::move(subject));

  MarkdownTable quality({"mesh", "triangles", "status", "mean", "p95", "max", "σ mean", "σ p99",
                         "σ max", "> 10", "of these slivers", "E/A", "starved", "shortest edge"});
  MarkdownTable comparison({"mesh", "linear mean", "Ceres mean", "flow mean", "Ceres / flow",
                            "linear σ max", "Ceres σ max", "flow σ max", "flow flipped",
                            "flow roundness"});
  MarkdownTable minimisation({"mesh", "cost before", "cost after", "iterations", "termination",
                              "flipped, repaired", "linear s", "all s", "linear s / 100k", "flow s",
                              "peak MiB"});
  // Maps one after the other, whose times count; flows two at a time, which take most of it.
  std::vector<Row> maps(subjects.size()), flows(subjects.size());
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    maps[i] = finish(start(subjects[i], map_mesh));
    std::fprintf(stderr, "%s: %s, %.2f s\n", subjects[i].name.c_str(), maps[i].status,
                 maps[i].seconds);
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [begin] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  for (std::size_t i = 0; i < subjects.size() && elapsed() < flow_limit; i += 2) {
    const Child first = start(subjects[i], flow_mesh);
    Child second;
    if (i + 1 < subjects.size()) second = start(subjects[i + 1], flow_mesh);
    flows[i] = finish(first);
    if (i + 1 < subjects.size()) flows[i + 1] = finish(second);
    std::fprintf(stderr, "flow: %s\n", subjects[i].name.c_str());
  }
  int above_linear = 0, above_flow = 0, refused = 0;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    const Subject& subject = subjects[i];
    const Row& r = maps[i];
    const Row& f = flows[i];
    const bool mapped = std::strncmp(r.status, "certified", 9) == 0;
    const auto number = [mapped](double value, int digits) {
      return mapped ? fixed(value, digits) : std::string();
    };
    char shortest[32];
    std::snprintf(shortest, sizeof shortest, "%.1e", r.shortest);
    const std::string status = r.status;
    quality.add({subject.name, std::to_string(r.triangles), status.substr(0, status.find(':')),
                 number(r.angle.mean, 3), number(r.angle.p95, 2), number(r.angle.max, 1),
                 number(r.sigma.mean, 3), number(r.sigma.p99, 2), number(r.sigma.max, 2),
                 mapped ? std::to_string(r.over_ten) : "",
                 mapped ? std::to_string(r.over_ten_slivers) : "", number(r.energy, 4),
                 number(100 * r.starved, 0) + (mapped ? " %" : ""), mapped ? shortest : ""});
    const bool flowed = f.flow_flipped >= 0;
    const double ratio =
        mapped && flowed && f.flow_angle.mean > 0 ? r.angle.mean / f.flow_angle.mean : 0;
    comparison.add({subject.name, number(r.linear_angle.mean, 3), number(r.angle.mean, 3),
                    flowed ? fixed(f.flow_angle.mean, 3) : "", ratio > 0 ? fixed(ratio, 3) : "",
                    number(r.linear_sigma.max, 1), number(r.sigma.max, 2),
                    flowed ? fixed(f.flow_sigma.max, 1) : "",
                    flowed ? std::to_string(f.flow_flipped) : "",
                    flowed ? fixed(f.flow_roundness, 4) : ""});
    char before[32], after[32];
    std::snprintf(before, sizeof before, "%.3e", r.cost_before);
    std::snprintf(after, sizeof after, "%.3e", r.cost_after);
    minimisation.add({subject.name, before, after, std::to_string(r.iterations), r.termination,
                      std::to_string(r.untangled), fixed(r.linear_seconds, 2), fixed(r.seconds, 2),
                      r.triangles > 0 ? fixed(1e5 * r.linear_seconds / double(r.triangles), 2) : "",
                      flowed ? fixed(f.flow_seconds, 1) : "", std::to_string(r.peak_mebibytes)});
    refused += mapped ? 0 : 1;
    above_linear += mapped && r.angle.mean > r.linear_angle.mean ? 1 : 0;
    above_flow += mapped && ratio > 1.01 ? 1 : 0;
  }
  std::printf(
      "## Distortion\n\n%s\n## Linear map, Ceres and mean curvature flow\n\n%s\n"
      "## Minimisation, time and memory\n\n%s\n"
      "%zu meshes: %d without a map, %d whose angle change is above the linear map's, %d\n"
      "above 1.01 times the flow's.\n",
      quality.text().c_str(), comparison.text().c_str(), minimisation.text().c_str(),
      subjects.size(), refused, above_linear, above_flow);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "shape3d_spherical_maps: %s\n", error.what());
    return 1;
  }
}
