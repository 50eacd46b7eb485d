#include <array>
#include <utility>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include "mesh_arguments.hpp"
#include "scaled.hpp"
#include "shape3d/mapping/inspect.hpp"

namespace shape3d::mapping {

std::int64_t count_self_intersections(const ConstPoints& V, const ConstTriangles& F) {
  namespace PMP = CGAL::Polygon_mesh_processing;
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  detail::check_indices(V, F);
  detail::check_finite(V);
  const double scale = detail::scale_of(V);
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> triangles;
  for (Eigen::Index v = 0; v < V.rows(); ++v)
    points.emplace_back(V(v, 0) / scale, V(v, 1) / scale, V(v, 2) / scale);
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const auto a = static_cast<std::size_t>(F(t, 0)), b = static_cast<std::size_t>(F(t, 1)),
               c = static_cast<std::size_t>(F(t, 2));
    if (a != b && b != c && c != a) triangles.push_back({a, b, c});
  }
  // CGAL counts in a mesh; sheets that meet in a non-manifold place are parted for it.
  PMP::orient_polygon_soup(points, triangles);
  Mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(points, triangles, mesh);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  PMP::self_intersections(mesh, std::back_inserter(pairs));
  return static_cast<std::int64_t>(pairs.size());
}

}  // namespace shape3d::mapping
