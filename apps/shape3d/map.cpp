#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <shape3d/mapping/spherical_map.hpp>

#include "common/error.hpp"
#include "common/vertex_normals.hpp"
#include "mapping_report.hpp"
#include "mesh_commands.hpp"
#include "mesh_subject.hpp"
#include "simplify.hpp"

namespace shape3d::apps {
namespace {

struct MapArguments {
  std::string mesh, output, prepared;
  std::string energy = "conformal";
  bool linear = false, repair = false, wrap = false, align = false;
  std::int64_t max_triangles = 0;
  double area_balance = 0.0;
  PictureArguments picture;
};

Json to_json(const mapping::Quantiles& q) {
  return {{"mean", q.mean}, {"median", q.median}, {"p95", q.p95}, {"p99", q.p99}, {"max", q.max}};
}

Json to_json(const mapping::Distortion& distortion) {
  return {{"angle_change_degrees", to_json(distortion.angle_change)},
          {"sigma_ratio", to_json(distortion.sigma_ratio)},
          {"energy_over_area", distortion.energy_over_area},
          {"starved_area_share", distortion.starved_area_share},
          {"shortest_edge", distortion.shortest_edge},
          {"unmeasured_triangles", distortion.unmeasured_triangles}};
}

Json to_json(const mapping::MinimisationSummary& ceres) {
  return {{"used", ceres.used},
          {"initial_cost", ceres.initial_cost},
          {"final_cost", ceres.final_cost},
          {"iterations", ceres.iterations},
          {"termination", ceres.termination},
          {"message", ceres.message}};
}

Json to_json(const mapping::SphericalMap& map) {
  const mapping::StageSeconds& s = map.seconds;
  return {{"status", to_string(map.status)},
          {"certified", map.status == mapping::Status::certified},
          {"certificate",
           {{"flipped", map.certificate.flipped},
            {"degenerate", map.certificate.degenerate},
            {"degree", map.certificate.degree},
            {"total_solid_angle", map.certificate.total_solid_angle},
            {"bijective", map.certificate.bijective()}}},
          {"distortion", to_json(map.distortion)},
          {"linear_distortion", to_json(map.linear_distortion)},
          {"ceres", to_json(map.minimisation)},
          {"refinement", to_json(map.refinement)},
          {"conformal_distortion",
           map.balancing.used ? to_json(map.conformal_distortion) : Json(nullptr)},
          {"balancing", to_json(map.balancing)},
          {"delaunay_flips", map.delaunay_flips},
          {"untangled_triangles", map.untangled_triangles},
          {"poles_tried", map.poles_tried},
          {"seconds",
           {{"delaunay", s.delaunay},
            {"linear", s.linear},
            {"untangle", s.untangle},
            {"minimise", s.minimise},
            {"centre", s.centre},
            {"certificate", s.certificate},
            {"distortion", s.distortion},
            {"total", s.total}}}};
}

/// Brings a mesh into a form that can be mapped, and notes each step in a report.
class Preparation {
 public:
  Preparation(const MapArguments& arguments, const Settings& settings, Progress& progress,
              Json& report)
      : arguments_(arguments), settings_(settings), progress_(progress), report_(report) {}

  /// @throws FileError  the mesh cannot be mapped: each reason, how often, and what to do.
  void run(Mesh& mesh) {
    mapping::Inspection found = mapping::inspect(mesh.V, mesh.F);
    report_["inspection"] = apps::to_json(found);
    if (arguments_.repair && !clean(found)) {
      repair(mesh);
      found = mapping::inspect(mesh.V, mesh.F);
    }
    if (arguments_.wrap && !found.spherical()) {
      wrap(mesh);
      found = mapping::inspect(mesh.V, mesh.F);
    }
    if (!found.spherical()) {
      throw FileError(arguments_.mesh, found.why_not_spherical(kRepairOption, kWrapOption));
    }
    warn_of(arguments_.mesh, found, settings_);
    if (arguments_.max_triangles > 0 && mesh.F.rows() > arguments_.max_triangles) simplify(mesh);
    report_["seconds"]["prepare"] = watch_.lap();
  }
  /// What was done, for a person.
  [[nodiscard]] const std::string& lines() const { return lines_; }

 private:
  static bool clean(const mapping::Inspection& found) {
    return found.spherical() && found.volume.value_or(0.0) > 0.0;
  }

  // Runs a step of the library; misuse of it is a fault of the file.
  template <class Step>
  auto guarded(const Step& step) {
    try {
      return step();
    } catch (const std::invalid_argument& error) {
      throw FileError(arguments_.mesh, error.what());
    }
  }

  [[nodiscard]] std::function<bool(double)> updates() {
    return [this](double share) {
      progress_.update(share);
      return true;
    };
  }

  void repair(Mesh& mesh) {
    progress_.stage("repairing " + arguments_.mesh);
    mapping::RepairOptions options;
    options.progress = updates();
    mapping::Repaired repaired = guarded([&] { return mapping::repair(mesh.V, mesh.F, options); });
    report_["repair"] = apps::to_json(repaired.summary);
    note("repair", to_sentence(repaired.summary));
    mesh.V = std::move(repaired.V);
    mesh.F = std::move(repaired.F);
  }

  void wrap(Mesh& mesh) {
    progress_.stage("wrapping " + arguments_.mesh);
    mapping::WrapOptions options;
    options.progress = updates();
    mapping::Wrapped wrapped = guarded([&] { return mapping::wrap(mesh.V, mesh.F, options); });
    report_["wrap"] = apps::to_json(wrapped);
    if (wrapped.status != mapping::WrapStatus::ok)
      throw FileError(arguments_.mesh, std::string(to_string(wrapped.status)));
    note("wrap",
         "alpha " + rounded(wrapped.alpha) + ", " + grouped(wrapped.F.rows()) + " triangles");
    mesh.V = std::move(wrapped.V);
    mesh.F = std::move(wrapped.F);
  }

  void simplify(Mesh& mesh) {
    progress_.stage("simplifying " + arguments_.mesh);
    mapping::ProgressiveMesh levels =
        make_levels(mesh, arguments_.mesh, mapping::CollapseCost::quadrics,
                    std::max<std::int64_t>(4, arguments_.max_triangles), progress_);
    levels.set_triangle_count(arguments_.max_triangles);
    mesh.V = levels.V();
    mesh.F = levels.F();
    report_["simplify"] = {{"vertices", mesh.V.rows()}, {"triangles", mesh.F.rows()}};
    note("simplified to", grouped(mesh.F.rows()) + " triangles");
  }

  void note(const std::string& name, const std::string& what) { lines_ += line(name, what); }

  const MapArguments& arguments_;
  const Settings& settings_;
  Progress& progress_;
  Json& report_;
  Stopwatch watch_;
  std::string lines_;
};

std::vector<std::uint8_t> colors_of_numbers(const std::vector<double>& values,
                                            const ColorScale& scale) {
  return colors_of(values.data(), values.size(), scale);
}

// Above: the mesh and its sphere in the colors of the mesh's normals (Fig. 4.3). Below: both in the
// colors of the distortion.
std::vector<Panel> panels_of(const Mesh& mesh, const Mesh& sphere,
                             const mapping::Distortion& distortion) {
  const Mesh::Points normals = vertex_normals(mesh);
  const std::vector<std::uint8_t> colors =
      colors_of_directions(normals.data(), static_cast<std::size_t>(normals.rows()));
  const mapping::TriangleDistortion triangles =
      mapping::triangle_distortion(mesh.V, mesh.F, sphere.V);
  ColorScale scale;
  scale.map = ColorMap::inferno;
  scale.upper = std::max(1.0, std::ceil(1.5 * distortion.angle_change.p95));
  scale.title = "mean angle change of a triangle (degrees)";
  return {vertex_colors_panel(mesh, colors, "normals as colors"),
          vertex_colors_panel(sphere, colors, "the same on the sphere"),
          triangle_colors_panel(mesh, colors_of_numbers(triangles.angle_change, scale), scale,
                                "distortion"),
          triangle_colors_panel(sphere, colors_of_numbers(triangles.angle_change, scale), scale,
                                "the same on the sphere")};
}

std::string to_lines(const mapping::SphericalMap& map, const MapArguments& arguments) {
  const auto degrees = [](double value) { return rounded(value) + " degrees"; };
  std::string text =
      line("status", std::string(to_string(map.status))) +
      line("flipped triangles", grouped(map.certificate.flipped)) +
      line("degree", grouped(map.certificate.degree)) +
      line("angle change", "mean " + degrees(map.distortion.angle_change.mean) + ", 95 % " +
                               degrees(map.distortion.angle_change.p95) + ", most " +
                               degrees(map.distortion.angle_change.max)) +
      line("sigma ratio", "mean " + rounded(map.distortion.sigma_ratio.mean) + ", 95 % " +
                              rounded(map.distortion.sigma_ratio.p95) + ", most " +
                              rounded(map.distortion.sigma_ratio.max)) +
      line("energy / area", rounded(map.distortion.energy_over_area)) +
      line("starved area", rounded(100 * map.distortion.starved_area_share) + " %");
  if (map.minimisation.used) {
    text += line("Ceres", "cost " + rounded(map.minimisation.initial_cost) + " to " +
                              rounded(map.minimisation.final_cost) + " in " +
                              std::to_string(map.minimisation.iterations) + " steps, " +
                              map.minimisation.termination) +
            line("linear angle change", "mean " + degrees(map.linear_distortion.angle_change.mean));
  }
  if (map.refinement.used) {
    text += line("angles", "cost " + rounded(map.refinement.initial_cost) + " to " +
                               rounded(map.refinement.final_cost) + " in " +
                               std::to_string(map.refinement.iterations) + " steps, " +
                               map.refinement.termination);
  }
  if (map.balancing.used) {
    text += line("before balancing",
                 "angle change mean " + degrees(map.conformal_distortion.angle_change.mean) +
                     ", starved area " +
                     rounded(100 * map.conformal_distortion.starved_area_share) + " %");
  }
  text += line("seconds", rounded(map.seconds.total));
  return text + line("output", arguments.output);
}

void run_map(const MapArguments& arguments, const Settings& settings) {
  mapping::SphericalMapOptions options;
  if (arguments.energy == "harmonic") {
    options.energy = mapping::Energy::harmonic;
  } else if (arguments.energy != "conformal") {
    throw UsageError("--energy " + arguments.energy + ": expected conformal or harmonic");
  }
  options.linear = arguments.linear;
  options.area_balance = arguments.area_balance;
  MeshOutput output("-o", arguments.output);
  std::optional<MeshOutput> prepared;
  if (!arguments.prepared.empty()) prepared.emplace("--mesh", arguments.prepared);
  PictureOutput picture(arguments.picture);
  Progress progress(settings);
  Json report = report_head("map");
  Mesh mesh = read_subject(arguments.mesh, settings, progress, report);
  report["output"] = arguments.output;
  report["options"] = {{"energy", arguments.energy}, {"linear", arguments.linear},
                       {"repair", arguments.repair}, {"wrap", arguments.wrap},
                       {"align", arguments.align},   {"max_triangles", arguments.max_triangles}};
  mesh.vertex_arrays.clear();  // they do not fit what preparation makes
  mesh.triangle_arrays.clear();
  Preparation preparation(arguments, settings, progress, report);
  preparation.run(mesh);
  if (arguments.align) {
    const mapping::Pose pose = mapping::align(mesh.V, mesh.F);
    if (pose.ambiguous)
      warn(settings, arguments.mesh + ": the pose is ambiguous; 'shape3d align' says why");
    report["pose"] = apps::to_json(pose);
    mesh.V = mapping::posed(mesh.V, pose);  // and the map lies as the mesh does
    mesh.space.clear();
  }
  progress.stage("mapping " + arguments.mesh);
  options.progress = [&progress](double share) {
    progress.update(share);
    return true;
  };
  mapping::SphericalMap map;
  try {
    map = mapping::spherical_map(mesh.V, mesh.F, options);
  } catch (const std::invalid_argument& error) {
    throw FileError(arguments.mesh, error.what());
  }
  report["map"] = to_json(map);
  if (map.status != mapping::Status::certified) {
    write_json(settings, report);
    throw FileError(arguments.mesh,
                    "no one-to-one map was found: " + std::string(to_string(map.status)));
  }
  Mesh sphere;
  sphere.V = map.S;
  sphere.F = mesh.F;
  output.write(sphere);
  if (prepared) {
    prepared->write(mesh);
    report["mesh"] = arguments.prepared;
  }
  if (picture.wanted()) {
    progress.stage("drawing " + arguments.picture.path);
    picture.draw(panels_of(mesh, sphere, map.distortion), 2, 1400, 1480);
    report["picture"] = arguments.picture.path;
  }
  write_json(settings, report);
  output.commit();
  if (prepared) prepared->commit();
  picture.commit();
  progress.clear();
  if (!settings.quiet)
    std::cout << line("mesh", arguments.mesh) << preparation.lines() << to_lines(map, arguments);
}

}  // namespace

void add_map(CLI::App& app, Settings& settings) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* command = app.add_subcommand(
      "map", "Map a closed mesh of genus 0 to the unit sphere, one to one and keeping angles");
  command->add_option("MESH", arguments->mesh, "A mesh (.ply, .obj, .off, .stl, .vtp)")->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "The sphere: a vertex for each vertex of the mesh, in the same order")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--energy", arguments->energy,
                   "What is minimised: conformal (default) or harmonic")
      ->type_name("NAME");
  command->add_flag("--linear", arguments->linear,
                    "Only the linear map: faster, angles change more");
  command->add_flag("--repair", arguments->repair,
                    "First make a closed, oriented manifold of the mesh (as 'shape3d repair')");
  command->add_flag("--wrap", arguments->wrap,
                    "If that does not make it genus 0, wrap it (as 'shape3d wrap')");
  command->add_flag("--align", arguments->align,
                    "Bring the mesh into its canonical pose first, so that equal shapes have equal "
                    "maps");
  command
      ->add_option("--max-triangles", arguments->max_triangles,
                   "Simplify a larger mesh to this number of triangles first")
      ->check(CLI::Range(std::int64_t{4}, std::int64_t{2147483647}))
      ->type_name("N");
  command
      ->add_option("--area-balance", arguments->area_balance,
                   "Give long extrusions more of the sphere at the cost of angles: a weight, for "
                   "example 0.1 (default 0)")
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("W");
  command
      ->add_option("--mesh", arguments->prepared,
                   "The mesh that was mapped: repaired, wrapped, simplified, aligned")
      ->type_name("FILE");
  add_picture_options(*command, arguments->picture,
                      "Mesh and sphere side by side, in the colors of normals and of distortion");
  command->footer(
      "Examples:\n"
      "  shape3d map spot.off -o sphere.off --picture spot.png\n"
      "  shape3d map scan.ply -o sphere.ply --repair --wrap --align --max-triangles 20000 --mesh "
      "mapped.ply");
  command->callback([arguments, &settings] {
    settings.run = [arguments, &settings] { run_map(*arguments, settings); };
  });
}

}  // namespace shape3d::apps
