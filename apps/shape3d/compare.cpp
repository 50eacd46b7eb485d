#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "common/error.hpp"
#include "common/mesh_check.hpp"
#include "extract_arguments.hpp"
#include "extractors.hpp"
#include "report.hpp"
#include "volume_options.hpp"

namespace shape3d::apps {
namespace {

struct CompareArguments {
  VolumeArguments volume;
  double isovalue = 0.0;
  std::vector<std::int64_t> roi;
};

// One extractor's surface: as it comes, and with vertices at equal positions merged, which shows
// triangles that have shrunk to a line or a point and faces that are there twice.
struct Row {
  std::string name;
  std::int64_t vertices = 0, triangles = 0, coincident = 0;
  MeshCheck merged;
  std::int64_t changed_by_negation = 0;
  double seconds = 0.0;
};

Row measure(Extractor extractor, NegatableVolume& volume, double isovalue,
            const zmc::Options& options) {
  Row row;
  row.name = to_string(extractor);
  ExtractedMesh result = run_extractor(extractor, volume.view(), isovalue, options);
  row.vertices = result.mesh.V.rows();
  row.triangles = result.mesh.F.rows();
  row.seconds = result.seconds;
  row.coincident = merge_coincident(result.mesh);
  MeshCheckOptions check;
  check.volume = &volume.view();
  row.merged = check_mesh(view_of(result.mesh), check);
  volume.negate();
  const ExtractedMesh negated = run_extractor(extractor, volume.view(), -isovalue, options);
  volume.negate();
  row.changed_by_negation = triangles_in_one_only(result.mesh, negated.mesh);
  return row;
}

Json to_json(const Row& row) {
  return {{"extractor", row.name},
          {"vertices", row.vertices},
          {"triangles", row.triangles},
          {"odd_interior_edges", row.merged.odd_interior_edges.value_or(0)},
          {"coincident_vertices", row.coincident},
          {"degenerate_triangles", row.merged.degenerate_triangles},
          {"duplicate_triangles", row.merged.duplicate_triangles},
          {"neutral", row.changed_by_negation == 0},
          {"triangles_changed_by_negation", row.changed_by_negation},
          {"seconds", row.seconds}};
}

std::string to_line(const Row& row) {
  char text[256];
  std::snprintf(text, sizeof text, "%-18s %10lld %10lld %9lld %11lld %11lld %10lld   %-8s %8.3f\n",
                row.name.c_str(), static_cast<long long>(row.vertices),
                static_cast<long long>(row.triangles),
                static_cast<long long>(row.merged.odd_interior_edges.value_or(0)),
                static_cast<long long>(row.coincident),
                static_cast<long long>(row.merged.degenerate_triangles),
                static_cast<long long>(row.merged.duplicate_triangles),
                row.changed_by_negation == 0 ? "yes" : "no", row.seconds);
  return text;
}

void compare(const CompareArguments& arguments, const Settings& settings) {
  if (!std::isfinite(arguments.isovalue))
    throw UsageError("--iso " + shortest(arguments.isovalue) + ": expected a finite number");
  Progress progress(settings);
  const Volume read = read_volume_of(arguments.volume, settings, progress);
  NegatableVolume volume(region_of(read.view, arguments.roi));
  const zmc::Options options = to_options(arguments.volume, settings);
  Json rows = Json::array();
  std::string table =
      "extractor            vertices  triangles odd edges  coincident  degenerate duplicates   "
      "neutral   seconds\n";
  for (const Extractor extractor : kExtractors) {
    progress.stage("extracting by " + to_string(extractor));
    try {
      const Row row = measure(extractor, volume, arguments.isovalue, options);
      rows.push_back(to_json(row));
      table += to_line(row);
    } catch (const std::invalid_argument& error) {
      fail_for(arguments.volume.path, error);
    }
  }
  progress.clear();
  if (!settings.quiet) {
    std::cout << line("volume", arguments.volume.path)
              << line("isovalue", shortest(arguments.isovalue)) << '\n'
              << table
              << "\nodd edges: edges inside the volume with an odd number of triangles (holes); "
                 "coincident: vertices at the place of\n"
                 "another; degenerate, duplicates: triangles after merging those; neutral: the "
                 "negated volume gives the same triangles\n";
  }
  Json report = report_head("compare");
  report["file"] = arguments.volume.path;
  report["isovalue"] = arguments.isovalue;
  report["extractors"] = rows;
  write_json(settings, report);
}

}  // namespace

void add_compare(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "Set the isosurface beside those of VTK's extractors");
  add_volume_options(*command, arguments->volume);
  command->add_option("--iso", arguments->isovalue, "The isovalue")->required()->type_name("V");
  command
      ->add_option("--roi", arguments->roi,
                   "Only samples x0 ≤ x < x1, y0 ≤ y < y1, z0 ≤ z < z1, by index")
      ->delimiter(',')
      ->expected(6)
      ->type_name("x0,x1,y0,y1,z0,z1");
  command->footer(
      "Examples:\n"
      "  shape3d compare skull.mhd --iso 226\n"
      "  shape3d compare engine.vti --iso 128 --threads 1 --json engine.json");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { compare(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
