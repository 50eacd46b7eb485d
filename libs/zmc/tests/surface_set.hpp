#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shape3d/zmc/extract.hpp"
#include "support/mesh_properties.hpp"
#include "support/zmc_reference.hpp"

namespace shape3d::zmc::test {

namespace reference = shape3d::test::reference;
using shape3d::test::MeshProperties;
using shape3d::test::Points;
using shape3d::test::Triangles;

/// A surface of the library in the reference's form, for a lattice of unit spacing at the origin.
///
/// A vertex with three whole coordinates is that sample; with two, the crossing on that lattice
/// edge; with fewer, the centroid of a polygon. All vertices of a patch triangle lie in one closed
/// cell, and in no other unless the triangle lies in a cell face, which is refused. Per cell, the
/// sides of the triangles cancel where two triangles run them in opposite directions; what is left
/// is the boundary of its polygons. Polygons of one cell share no vertex (the degree theorem), so
/// that the left-over sides, followed from vertex to vertex, give back each polygon with its
/// direction. Each must be made of n - 2 triangles on its n vertices or n round one centroid, at
/// the average: with one boundary and no inner vertex but the centroid, such a set of triangles is
/// a disk. Zero faces likewise, per lattice face.
struct Conversion {
  reference::SurfaceSet surface;
  std::vector<std::int64_t> triangle_cells;  ///< First sample of the cell of each patch triangle.
  std::int64_t zero_vertices = 0;            ///< Samples that are vertices.
  std::int64_t centroids = 0;
  double position_error = 0.0;  ///< Largest distance of a crossing or centroid from its place.
};

/// @param outside  The lattice in which crossings are named is `volume`; vertex coordinates are
///                 relative to its sample (outside, outside, outside).
/// @throws std::runtime_error  the triangles are not such polygons.
[[nodiscard]] Conversion convert(const Points& V, const Triangles& F,
                                 const std::vector<TriangleKind>& kinds,
                                 const reference::Volume& volume, int outside = 0);

template <class Index>
[[nodiscard]] Conversion convert(const Surface<double, Index>& surface,
                                 const reference::Volume& volume, int outside = 0) {
  std::vector<TriangleKind> kinds;
  for (std::int64_t t = 0; t < surface.triangle_count(); ++t) kinds.push_back(surface.kind(t));
  return convert(Points(surface.V()), Triangles(surface.F().template cast<std::int64_t>()), kinds,
                 volume, outside);
}

/// The reference's name of the vertex at a place that is a sample or on a lattice edge.
/// @throws std::runtime_error  it is neither.
[[nodiscard]] reference::Vertex vertex_at(const Eigen::Vector3d& place,
                                          const reference::Volume& volume);

/// Exempts the edges at which the surface may end: those with a cell round them that is masked or
/// outside the volume.
[[nodiscard]] shape3d::test::Exempt at_border_or_mask(const reference::Volume& volume);

template <class Real, class Index>
[[nodiscard]] MeshProperties properties_of(const Surface<Real, Index>& surface,
                                           const shape3d::test::Exempt& exempt = {}) {
  return shape3d::test::mesh_properties_of(surface.V(), surface.F(), exempt);
}

}  // namespace shape3d::zmc::test
