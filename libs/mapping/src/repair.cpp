// CGAL's polygon mesh processing is here alone, and in self_intersections.cpp.
#include "shape3d/mapping/repair.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include "mesh_arguments.hpp"
#include "scaled.hpp"

namespace shape3d::mapping {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Polygon = std::vector<std::size_t>;

struct Cancelled {};

class Repair {
 public:
  Repair(const ConstPoints& V, const ConstTriangles& F, const RepairOptions& options)
      : options_(options), scale_(detail::scale_of(V)) {
    points_.reserve(static_cast<std::size_t>(V.rows()));
    for (Eigen::Index v = 0; v < V.rows(); ++v)
      points_.emplace_back(V(v, 0) / scale_, V(v, 1) / scale_, V(v, 2) / scale_);
    triangles_.reserve(static_cast<std::size_t>(F.rows()));
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
      triangles_.push_back({static_cast<std::size_t>(F(t, 0)), static_cast<std::size_t>(F(t, 1)),
                            static_cast<std::size_t>(F(t, 2))});
    }
  }

  Repaired run() {
    step(0.0);
    clean_soup();
    step(0.2);
    orient();
    step(0.4);
    PMP::polygon_soup_to_polygon_mesh(points_, triangles_, mesh_);
    PMP::stitch_borders(mesh_);
    step(0.5);
    if (options_.keep_largest) keep_largest();
    step(0.6);
    if (options_.fill_holes) fill_holes();
    step(0.9);
    Repaired result = finish();
    result.after = inspect(result.V, result.F);
    if (result.after.volume.value_or(0.0) < 0.0) {
      result.F.col(1).swap(result.F.col(2));
      summary_.turned_inside_out = true;
      result.after = inspect(result.V, result.F);
    }
    result.summary = summary_;
    return result;
  }

 private:
  void step(double share) const {
    if (options_.progress && !options_.progress(share)) throw Cancelled{};
  }

  void clean_soup() {
    const auto size = [](const auto& range) { return static_cast<std::int64_t>(range.size()); };
    summary_.merged_vertices =
        static_cast<std::int64_t>(PMP::merge_duplicate_points_in_polygon_soup(points_, triangles_));
    const std::int64_t all = size(triangles_);
    triangles_.erase(std::remove_if(triangles_.begin(), triangles_.end(),
                                    [](const Polygon& t) {
                                      return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
                                    }),
                     triangles_.end());
    summary_.removed_degenerate = all - size(triangles_);
    if (triangles_.empty()) {
      throw std::invalid_argument("F: none of the " + std::to_string(all) +
                                  " triangles has three different vertices");
    }
    // Of triangles with the same vertices one is kept: the first.
    const std::int64_t distinct = size(triangles_);
    PMP::merge_duplicate_polygons_in_polygon_soup(
        points_, triangles_, CGAL::parameters::require_same_orientation(false));
    summary_.removed_duplicates = distinct - size(triangles_);
    summary_.removed_vertices =
        static_cast<std::int64_t>(PMP::remove_isolated_points_in_polygon_soup(points_, triangles_));
  }

  void orient() {
    const std::vector<Polygon> before = triangles_;
    const std::size_t vertices = points_.size();
    PMP::orient_polygon_soup(points_, triangles_);
    summary_.separated_vertices = static_cast<std::int64_t>(points_.size() - vertices);
    // Turned: the corners run the other way, whatever their names are now.
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto position = [&](std::size_t v) { return points_[v]; };
      const auto first =
          std::find_if(triangles_[t].begin(), triangles_[t].end(),
                       [&](std::size_t v) { return position(v) == position(before[t][0]); });
      const auto place = static_cast<std::size_t>(first - triangles_[t].begin());
      if (position(triangles_[t][(place + 1) % 3]) != position(before[t][1]))
        ++summary_.turned_triangles;
    }
  }

  void keep_largest() {
    const std::int64_t faces = static_cast<std::int64_t>(mesh_.number_of_faces());
    summary_.removed_components =
        static_cast<std::int64_t>(PMP::keep_largest_connected_components(mesh_, 1));
    summary_.removed_component_triangles =
        faces - static_cast<std::int64_t>(mesh_.number_of_faces());
  }

  void fill_holes() {
    std::vector<Mesh::Halfedge_index> cycles;
    PMP::extract_boundary_cycles(mesh_, std::back_inserter(cycles));
    for (std::size_t i = 0; i < cycles.size(); ++i) {
      step(0.6 + 0.3 * static_cast<double>(i) / static_cast<double>(cycles.size()));
      std::vector<Mesh::Face_index> faces;
      PMP::triangulate_hole(mesh_, cycles[i], std::back_inserter(faces),
                            CGAL::parameters::use_delaunay_triangulation(true));
      ++(faces.empty() ? summary_.unfilled_holes : summary_.filled_holes);
      summary_.filling_triangles += static_cast<std::int64_t>(faces.size());
    }
  }

  Repaired finish() {
    mesh_.collect_garbage();
    Repaired result;
    result.V.resize(static_cast<Eigen::Index>(mesh_.number_of_vertices()), 3);
    result.F.resize(static_cast<Eigen::Index>(mesh_.number_of_faces()), 3);
    for (const Mesh::Vertex_index v : mesh_.vertices()) {
      const Point& p = mesh_.point(v);
      result.V.row(v.idx()) << p.x() * scale_, p.y() * scale_, p.z() * scale_;
    }
    for (const Mesh::Face_index f : mesh_.faces()) {
      Eigen::Index i = 0;
      for (const Mesh::Vertex_index v : mesh_.vertices_around_face(mesh_.halfedge(f)))
        result.F(f.idx(), i++) = static_cast<std::int32_t>(v.idx());
    }
    return result;
  }

  const RepairOptions& options_;
  double scale_;
  std::vector<Point> points_;
  std::vector<Polygon> triangles_;
  Mesh mesh_;
  RepairSummary summary_;
};

}  // namespace

Repaired repair(const ConstPoints& V, const ConstTriangles& F, const RepairOptions& options) {
  detail::check_indices(V, F);
  detail::check_finite(V);
  try {
    return Repair(V, F, options).run();
  } catch (const Cancelled&) {
    Repaired result;
    result.cancelled = true;
    return result;
  }
}

std::string to_sentence(const RepairSummary& summary) {
  std::string text;
  const auto add = [&text](std::int64_t count, const std::string& before, const std::string& one,
                           const std::string& many, const std::string& after = "") {
    if (count == 0) return;
    if (!text.empty()) text += ", ";
    text += before + " " + std::to_string(count) + " " + (count == 1 ? one : many) + after;
  };
  add(summary.merged_vertices, "merged", "vertex with another one at its position",
      "vertices with others at their positions");
  add(summary.removed_vertices, "removed", "isolated vertex", "isolated vertices");
  add(summary.removed_degenerate, "removed", "degenerate triangle", "degenerate triangles");
  add(summary.removed_duplicates, "removed", "duplicate triangle", "duplicate triangles");
  add(summary.separated_vertices, "made", "copy of a vertex to part sheets",
      "copies of vertices to part sheets");
  add(summary.turned_triangles, "turned", "triangle", "triangles");
  add(summary.removed_components, "removed", "component", "components",
      " of " + std::to_string(summary.removed_component_triangles) + " triangles");
  add(summary.filled_holes, "filled", "hole", "holes",
      " with " + std::to_string(summary.filling_triangles) + " triangles");
  add(summary.unfilled_holes, "could not fill", "hole", "holes");
  if (summary.turned_inside_out)
    text += (text.empty() ? "" : ", ") + std::string("turned the surface inside out");
  return text.empty() ? "nothing had to be repaired" : text;
}

}  // namespace shape3d::mapping
