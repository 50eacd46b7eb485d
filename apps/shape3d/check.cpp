#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/mesh_check.hpp"
#include "common/mesh_io.hpp"
#include "mesh_report.hpp"
#include "progress.hpp"
#include "report.hpp"

namespace shape3d::apps {

void report_mesh(const std::string& command, const std::string& path, const Settings& settings) {
  Progress progress(settings);
  progress.stage("reading " + path);
  Stopwatch watch;
  const MeshFile file = read_mesh(path);
  const double read_seconds = watch.lap();
  for (const std::string& sentence : file.warnings) warn(settings, path + ": " + sentence);
  progress.stage("checking " + path);
  const MeshCheck check = check_mesh(view_of(file.mesh));
  const double check_seconds = watch.lap();
  progress.clear();
  const std::string space = file.mesh.space.empty() ? "not stated" : file.mesh.space;
  if (!settings.quiet) {
    std::cout << line("file", path)
              << line("format", std::string(to_string(file.format)) + ", " + file.encoding)
              << line("space", space) << to_lines(check);
  }
  Json report = report_head(command);
  report["file"] = path;
  report["format"] = to_string(file.format);
  report["encoding"] = file.encoding;
  report["space"] = file.mesh.space.empty() ? Json(nullptr) : Json(file.mesh.space);
  report["polygons"] = file.polygons;
  report.update(to_json(check));
  report["seconds"] = {{"read", read_seconds}, {"check", check_seconds}};
  report["warnings"] = file.warnings;
  write_json(settings, report);
}

void add_check(CLI::App& app, Settings& settings) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("check", "Count what is good and bad about a mesh");
  command->add_option("MESH", *path, "A mesh (.ply, .obj, .off, .stl, .vtp)")->required();
  command->footer(
      "Examples:\n"
      "  shape3d check bone.ply\n"
      "  shape3d check bone.stl --quiet --json bone.json");
  command->callback([path, &settings] {
    settings.run = [path, &settings] { report_mesh("check", *path, settings); };
  });
}

}  // namespace shape3d::apps
