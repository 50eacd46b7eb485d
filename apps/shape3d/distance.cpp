#include <cmath>
#include <iostream>
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include <shape3d/descriptors/descriptor.hpp>
#include <shape3d/descriptors/hsh.hpp>
#include <shape3d/descriptors/voxelize.hpp>

#include "common/describe_mesh.hpp"
#include "common/error.hpp"
#include "common/mesh_io.hpp"
#include "common/surface_distance.hpp"
#include "descriptor_arguments.hpp"
#include "progress.hpp"
#include "report.hpp"

namespace shape3d::apps {
namespace {

using descriptors::Descriptor;

constexpr const char* kPlainEnergies = "hsh:K=8";  // what (5.17) and (5.18) are about

struct DistanceArguments {
  std::string a, b;
  std::vector<std::string> descriptors;
  bool align = false;
  std::int64_t samples = 100000;
};

Mesh read(const std::string& path, bool align, const Settings& settings) {
  MeshFile file = read_mesh(path);
  for (const std::string& sentence : file.warnings) warn(settings, path + ": " + sentence);
  try {
    descriptors::check_surface(file.mesh.V, file.mesh.F);
    if (align) {
      PosedMesh posed = posed_mesh(file.mesh, descriptors::Align::cpca, false);
      file.mesh.V = std::move(posed.V);
    }
  } catch (const std::invalid_argument& error) {
    throw FileError(path, error.what());
  }
  return std::move(file.mesh);
}

SurfaceDistance measure(const Mesh& from, const std::string& from_path, const Mesh& to,
                        const DistanceArguments& arguments, const Settings& settings) {
  try {
    return surface_distance(from, to, arguments.samples, settings.threads);
  } catch (const std::invalid_argument& error) {
    throw FileError(from_path, error.what());
  }
}

Json to_json(const SurfaceDistance& distance) {
  return {{"sum_of_squares", distance.sum_of_squares},
          {"vertices", distance.vertices},
          {"mean_square", distance.mean_square},
          {"hausdorff", {distance.largest, distance.largest + distance.spacing}},
          {"samples", distance.samples}};
}

std::string to_lines(const SurfaceDistance& distance, const std::string& way) {
  return line("SSD " + way, rounded(distance.sum_of_squares) + " over " +
                                grouped(distance.vertices) + " vertices") +
         line("root mean square " + way, rounded(std::sqrt(distance.mean_square))) +
         line("Hausdorff " + way,
              rounded(distance.largest) + " … " + rounded(distance.largest + distance.spacing));
}

// |f − g|² of the hyperspherical harmonics in the poses that the meshes have (5.18).
double function_distance(const descriptors::HshParameters& parameters, const Mesh& a, const Mesh& b,
                         int threads) {
  const descriptors::HshTransform transform(parameters.transform, parameters.voxels.side);
  descriptors::VoxelizeOptions options = parameters.voxels;
  options.threads = threads;
  const auto coefficients = [&](const Mesh& mesh) {
    return transform(descriptors::voxelize(mesh.V, mesh.F, options), threads);
  };
  return (coefficients(a).values - coefficients(b).values).squaredNorm();
}

// The descriptor is the energies of a function, whose distances the bound (5.18) is about.
const descriptors::HshParameters* energies_of(const Descriptor& descriptor) {
  const auto* hsh = std::get_if<descriptors::HshParameters>(&descriptor.parameters());
  const bool plain = hsh != nullptr && hsh->source == descriptors::HshSource::voxels &&
                     hsh->invariants == descriptors::HshInvariants::energies && !hsh->unit &&
                     hsh->power == 1.0 && descriptor.align() == descriptors::Align::none;
  return plain ? hsh : nullptr;
}

void distance(const DistanceArguments& arguments, const Settings& settings) {
  const std::vector<Descriptor> descriptors =
      parse_descriptors(arguments.descriptors.empty() ? std::vector<std::string>{kPlainEnergies}
                                                      : arguments.descriptors);
  Progress progress(settings);
  progress.stage("reading the meshes");
  const Mesh a = read(arguments.a, arguments.align, settings),
             b = read(arguments.b, arguments.align, settings);
  progress.stage("measuring distances of points");
  const SurfaceDistance ab = measure(a, arguments.a, b, arguments, settings),
                        ba = measure(b, arguments.b, a, arguments, settings);
  progress.stage("describing the meshes");
  Json report = report_head("distance");
  report["a"] = arguments.a;
  report["b"] = arguments.b;
  report["aligned"] = arguments.align;
  report["a_to_b"] = to_json(ab);
  report["b_to_a"] = to_json(ba);
  report["hausdorff"] = {std::max(ab.largest, ba.largest),
                         std::max(ab.largest + ab.spacing, ba.largest + ba.spacing)};
  report["descriptors"] = Json::array();
  std::string lines = line("A", arguments.a) + line("B", arguments.b) + to_lines(ab, "A to B") +
                      to_lines(ba, "B to A");
  for (const Descriptor& descriptor : descriptors) {
    Eigen::VectorXd difference;
    for (const auto& [mesh, path] : {std::pair{&a, &arguments.a}, std::pair{&b, &arguments.b}}) {
      try {
        const Eigen::VectorXd vector = describe_mesh(*mesh, {descriptor}, settings.threads).front();
        difference = difference.size() == 0 ? vector : Eigen::VectorXd(difference - vector);
      } catch (const std::exception& error) {
        throw FileError(*path, error.what());
      }
    }
    Json entry{{"spec", descriptor.to_string()},
               {"L1", difference.lpNorm<1>()},
               {"L2", difference.norm()},
               {"L2_squared", difference.squaredNorm()}};
    lines += line("descriptor", descriptor.to_string()) +
             line("  L1, L2, L2 squared", rounded(difference.lpNorm<1>()) + ", " +
                                              rounded(difference.norm()) + ", " +
                                              rounded(difference.squaredNorm()));
    if (const descriptors::HshParameters* hsh = energies_of(descriptor)) {
      const double bound = function_distance(*hsh, a, b, settings.threads);
      entry["function_L2_squared"] = bound;
      lines += line("  of the functions", rounded(bound) + ", which is not less (5.18)");
    }
    report["descriptors"].push_back(entry);
  }
  progress.clear();
  write_json(settings, report);
  if (!settings.quiet) std::cout << lines;
}

}  // namespace

void add_distance(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<DistanceArguments>();
  CLI::App* command = app.add_subcommand("distance", "Measure how unlike two meshes are");
  command->add_option("A", arguments->a, "A mesh (.ply, .obj, .off, .stl, .vtp)")->required();
  command->add_option("B", arguments->b, "Another")->required();
  command
      ->add_option(
          "--descriptor", arguments->descriptors,
          std::string("Also by these descriptors, as of 'describe'; default: ") + kPlainEnergies)
      ->allow_extra_args(false)
      ->type_name("SPEC");
  command->add_flag("--align", arguments->align,
                    "Bring both meshes into their canonical pose and size first");
  command
      ->add_option("--samples", arguments->samples,
                   "About how many small triangles a surface is cut into (default 100000)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{100000000}))
      ->type_name("N");
  command->footer(
      "SSD: the sum over the vertices of one mesh of their squared distances to the other.\n"
      "Hausdorff: an interval that holds the largest distance of a point of the one surface to the "
      "other.\n"
      "Example:\n"
      "  shape3d distance cat.off dog.off --align --descriptor hsh:K=8 --descriptor d2");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { distance(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
