#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <shape3d/descriptors/descriptor.hpp>

#include "common/describe_mesh.hpp"
#include "common/mesh_io.hpp"
#include "common/output_file.hpp"
#include "describe_arguments.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "show_parts.hpp"

namespace shape3d::apps {
namespace {

using descriptors::Descriptor;

Descriptor parse_descriptor(const std::string& spec) {
  try {
    return Descriptor::parse(spec);
  } catch (const std::invalid_argument& error) {
    throw UsageError("--show " + spec + ": " + error.what());
  }
}

}  // namespace

void show_descriptor(const DescribeArguments& arguments, const Settings& settings) {
  const Descriptor descriptor = parse_descriptor(arguments.show);
  if (arguments.meshes.size() != 1) {
    throw UsageError("--show is given " + std::to_string(arguments.meshes.size()) +
                     " meshes, expected 1");
  }
  if (std::filesystem::path(arguments.picture).extension() != ".png") {
    throw UsageError("--picture " + arguments.picture + ": expected a name that ends in .png");
  }
  OutputFile file(arguments.picture);
  const std::string& path = arguments.meshes.front();
  Progress progress(settings);
  progress.stage("reading " + path);
  const MeshFile mesh = read_mesh(path);
  for (const std::string& sentence : mesh.warnings) warn(settings, path + ": " + sentence);
  progress.stage("describing " + path);
  Eigen::VectorXd vector;
  ShownParts parts;
  try {
    vector = describe_mesh(mesh.mesh, {descriptor}, settings.threads).front();
    parts = shown_parts(mesh.mesh, descriptor, settings.threads);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  progress.stage("drawing " + arguments.picture);
  file.write(draw_shown(parts, descriptor, vector));
  file.finish();
  Json report = report_head("describe");
  report["mesh"] = path;
  report["descriptor"] = descriptor.to_string();
  report["picture"] = arguments.picture;
  report["vector"] = std::vector<double>(vector.data(), vector.data() + vector.size());
  if (parts.residual) report["residual"] = *parts.residual;
  write_json(settings, report);
  file.commit();
  progress.clear();
  if (!settings.quiet) {
    std::cout << line("descriptor", descriptor.to_string())
              << line("numbers", std::to_string(vector.size()));
    if (parts.residual) std::cout << line("residual", rounded(*parts.residual));
    std::cout << line("picture", arguments.picture);
  }
}

}  // namespace shape3d::apps
