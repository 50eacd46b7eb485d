#include "findings.hpp"

#include <string>

namespace shape3d::mapping {

std::string_view to_string(Defect defect) {
  switch (defect) {
    case Defect::too_few_triangles:
      return "too few triangles";
    case Defect::index_out_of_range:
      return "index out of range";
    case Defect::not_finite:
      return "not finite";
    case Defect::zero_extent:
      return "zero extent";
    case Defect::degenerate_triangle:
      return "degenerate triangle";
    case Defect::duplicate_triangle:
      return "duplicate triangle";
    case Defect::isolated_vertex:
      return "isolated vertex";
    case Defect::nonmanifold_edge:
      return "non-manifold edge";
    case Defect::nonmanifold_vertex:
      return "non-manifold vertex";
    case Defect::boundary_loop:
      return "boundary loop";
    case Defect::misoriented_edge:
      return "misoriented edge";
    case Defect::not_orientable:
      return "not orientable";
    case Defect::several_components:
      return "several components";
    case Defect::handle:
      return "handle";
    case Defect::inside_out:
      return "inside out";
    case Defect::zero_area_triangle:
      return "zero-area triangle";
    case Defect::self_intersection:
      return "self-intersection";
  }
  return "unknown defect";
}

std::string to_sentence(const Finding& finding, std::string_view repair, std::string_view wrap) {
  std::string text = finding.sentence;
  if (finding.advice.empty()) return text;
  text += "; ";
  if (finding.remedy == Remedy::repair) text += std::string(repair) + " ";
  if (finding.remedy == Remedy::wrap) text += std::string(wrap) + " ";
  return text + finding.advice;
}

namespace detail {
namespace {

// "1 edge", "3 edges".
std::string counted(std::int64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string between(const std::array<std::int32_t, 2>& edge) {
  return "between vertices " + std::to_string(edge[0]) + " and " + std::to_string(edge[1]);
}

}  // namespace

void add_findings(Inspection& result, const Examples& examples) {
  const auto add = [&result](Defect defect, std::int64_t count, std::string sentence, Remedy remedy,
                             std::string advice, bool blocking = true) {
    if (count == 0) return;
    result.findings.push_back(
        {defect, count, blocking, std::move(sentence), remedy, std::move(advice)});
  };
  const auto first = [](std::int64_t row) { return "the first is row " + std::to_string(row); };

  add(Defect::too_few_triangles, result.triangles < 4 ? 1 : 0,
      counted(result.triangles, "triangle", "triangles") +
          ": a closed surface has 4 at least, as the tetrahedron",
      Remedy::none, "");
  add(Defect::index_out_of_range, result.out_of_range_triangles,
      counted(result.out_of_range_triangles, "triangle names", "triangles name") +
          " a vertex that is not among the " + std::to_string(result.vertices) + ", " +
          first(examples.out_of_range_triangle),
      Remedy::none, "the mesh is damaged and has to be made anew");
  add(Defect::not_finite, result.not_finite_vertices,
      counted(result.not_finite_vertices, "vertex has", "vertices have") +
          " a coordinate that is not a finite number, " + first(examples.not_finite_vertex),
      Remedy::none, "the mesh is damaged and has to be made anew");
  add(Defect::zero_extent,
      result.triangles > 0 && result.not_finite_vertices == 0 && !examples.positive_area ? 1 : 0,
      "the area of all triangles together is zero", Remedy::none, "there is no surface to map");
  add(Defect::degenerate_triangle, result.degenerate_triangles,
      counted(result.degenerate_triangles, "degenerate triangle names",
              "degenerate triangles name") +
          " a vertex twice, " + first(examples.degenerate_triangle),
      Remedy::repair, "removes them");
  add(Defect::duplicate_triangle, result.duplicate_triangles,
      counted(result.duplicate_triangles, "triangle has", "triangles have") +
          " the same three vertices as an earlier one, " + first(examples.duplicate_triangle),
      Remedy::repair, "removes them");
  add(Defect::isolated_vertex, result.isolated_vertices,
      counted(result.isolated_vertices, "vertex is", "vertices are") + " in no triangle, " +
          first(examples.isolated_vertex),
      Remedy::repair, "removes them");
  add(Defect::nonmanifold_edge, result.nonmanifold_edges,
      counted(result.nonmanifold_edges, "edge has", "edges have") +
          " more than two triangles, the first " + between(examples.nonmanifold_edge),
      Remedy::repair, "cuts the surface apart there");
  add(Defect::nonmanifold_vertex, result.nonmanifold_vertices,
      counted(result.nonmanifold_vertices, "vertex joins", "vertices join") +
          " more than one sheet of triangles, " + first(examples.nonmanifold_vertex),
      Remedy::repair, "gives each sheet a vertex of its own");
  add(Defect::boundary_loop, result.boundary_loops,
      "the surface is open: " + counted(result.boundary_loops, "boundary loop", "boundary loops") +
          " of " + counted(result.boundary_edges, "edge", "edges") + " in all, the first " +
          between(examples.boundary_edge),
      Remedy::repair, "fills the holes");
  add(Defect::misoriented_edge, result.orientable ? result.misoriented_edges : 0,
      counted(result.misoriented_edges, "edge has", "edges have") +
          " two triangles that are oriented against each other, the first " +
          between(examples.misoriented_edge),
      Remedy::repair, "turns the triangles");
  add(Defect::not_orientable, result.orientable ? 0 : 1,
      "the surface has only one side (like a Möbius strip): however the triangles are turned, some "
      "of its " +
          counted(result.edges, "edge has", "edges have") + " two that disagree",
      Remedy::wrap, "makes a closed surface round it");
  add(Defect::several_components, result.components > 1 ? result.components : 0,
      std::to_string(result.components) + " separate components, the largest of " +
          counted(result.largest_component, "triangle", "triangles"),
      Remedy::repair, "keeps the largest");
  const std::int64_t genus = result.genus.value_or(0);
  add(Defect::handle, genus,
      "genus " + std::to_string(genus) + ": the body has " + counted(genus, "handle", "handles") +
          ", and only genus 0 can be mapped to a sphere",
      Remedy::wrap, "makes a surface of genus 0 round it");
  add(Defect::inside_out,
      result.volume.has_value() && !examples.positive_volume && examples.positive_area ? 1 : 0,
      "the triangles run clockwise seen from outside (the volume is negative), so that normals "
      "point "
      "inwards",
      Remedy::repair, "turns them", false);
  add(Defect::zero_area_triangle, result.zero_area_triangles,
      counted(result.zero_area_triangles, "triangle has its", "triangles have their") +
          " corners on a line, " + first(examples.zero_area_triangle),
      Remedy::none, "their angles cannot be kept by any map", false);
  const std::int64_t crossings = result.self_intersections.value_or(0);
  add(Defect::self_intersection, crossings,
      counted(crossings, "pair of triangles cuts", "pairs of triangles cut") +
          " through each other",
      Remedy::wrap, "makes a surface without round it", false);
}

}  // namespace detail
}  // namespace shape3d::mapping
