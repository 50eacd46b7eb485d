#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include <Eigen/Core>

/// Combinatorial and metric properties of a triangle mesh, counted without any mesh structure: by
/// sorting triangles and edges.
namespace shape3d::test {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Triangles = Eigen::Matrix<std::int64_t, Eigen::Dynamic, 3, Eigen::RowMajor>;

struct MeshProperties {
  std::int64_t vertices = 0, edges = 0, triangles = 0;

  std::int64_t odd_edges = 0;           ///< In an odd number of triangles and not exempt.
  std::int64_t unbalanced_edges = 0;    ///< Not run both ways equally often and not exempt.
  std::int64_t exempt_edges = 0;        ///< In an odd number of triangles, exempt.
  std::int64_t nonmanifold_edges = 0;   ///< In more than two triangles.
  std::int64_t inconsistent_edges = 0;  ///< In two triangles that run it the same way.

  std::int64_t repeated_ids = 0;           ///< Triangles with a vertex twice.
  std::int64_t invalid_ids = 0;            ///< Triangles with an id outside 0 ... #V - 1.
  std::int64_t duplicate_triangles = 0;    ///< Triangles whose three vertices an earlier one has.
  std::int64_t unreferenced_vertices = 0;  ///< In no triangle.
  std::int64_t coincident_vertices = 0;    ///< At the place of an earlier one, bit for bit.
  std::int64_t non_finite_vertices = 0;

  std::int64_t components = 0;       ///< Connected by shared vertices.
  std::int64_t edge_components = 0;  ///< Connected by shared edges.
  std::int64_t euler = 0;            ///< V - E + F of the vertices in use.
  double area = 0.0;
  double volume = 0.0;  ///< Signed, sum of a . (b x c) / 6: positive when normals point outwards.

  /// Total genus of a closed orientable manifold: sum of (2 - euler) / 2 over its components.
  [[nodiscard]] std::int64_t genus() const { return (2 * components - euler) / 2; }
  /// No repeated or invalid ids, no duplicates, nothing unreferenced, coincident or not finite.
  [[nodiscard]] bool is_clean() const {
    return repeated_ids + invalid_ids + duplicate_triangles + unreferenced_vertices +
               coincident_vertices + non_finite_vertices ==
           0;
  }
  /// No odd edge, each edge run both ways equally often.
  [[nodiscard]] bool is_closed() const { return odd_edges + unbalanced_edges == 0; }
};

/// May this edge, given by its end points, be of odd degree?
using Exempt = std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)>;

/// Exempts edges with both ends on one border plane of the box [lower, upper].
[[nodiscard]] Exempt on_border(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper);

/// The same for a lattice of dims samples with unit spacing at the origin.
[[nodiscard]] Exempt on_border(const std::array<std::int64_t, 3>& dims);

[[nodiscard]] MeshProperties mesh_properties(const Points& V, const Triangles& F,
                                             const Exempt& exempt = {});

/// The same for any Eigen matrices of three columns.
template <class Vertices, class Faces>
[[nodiscard]] MeshProperties mesh_properties_of(const Vertices& V, const Faces& F,
                                                const Exempt& exempt = {}) {
  return mesh_properties(Points(V.template cast<double>()),
                         Triangles(F.template cast<std::int64_t>()), exempt);
}

}  // namespace shape3d::test
