#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/SparseCore>

#include "shape3d/mapping/mesh.hpp"
#include "surface.hpp"

namespace shape3d::mapping {

/// A triangulation of the surface by its edge lengths (Fisher, Springborn, Schröder, Bobenko 2007).
/// Half-edges are numbered as in surface.hpp; two triangles may share more than one edge, and an
/// edge may join a vertex with itself.
struct IntrinsicTriangulation {
  std::vector<std::int32_t> origin;  ///< Vertex that half-edge h starts from.
  Twins twin;
  std::vector<double> length;  ///< Of half-edge h; equal to its twin's.
  std::int64_t vertex_count = 0;
  std::int64_t flips = 0;

  [[nodiscard]] std::int32_t target(std::int32_t h) const { return origin[next_half_edge(h)]; }
};

/// The triangles of V, F. Where a triangle is degenerate to 1e-8 of the mean edge, all edges grow
/// by what makes every triangle inequality strict by that much (Sharp, Crane 2020).
[[nodiscard]] IntrinsicTriangulation intrinsic_triangulation(const ConstPoints& V,
                                                             const ConstTriangles& F,
                                                             const Twins& twins);

/// Flips edges until the two angles opposite to each add up to no more than π.
void make_delaunay(IntrinsicTriangulation& mesh);

/// Twice the area and the three cotangents of triangle t; cotangent k is that of the angle opposite
/// to half-edge 3 t + k.
struct TriangleCotangents {
  double area = 0;
  double cotangent[3] = {0, 0, 0};
};
[[nodiscard]] TriangleCotangents triangle_cotangents(const IntrinsicTriangulation& mesh,
                                                     std::int32_t t);

/// Weights of (4.7), k = ½ (cot α + cot β), of each half-edge; no less than 0 once Delaunay.
[[nodiscard]] std::vector<double> cotangent_weights(const IntrinsicTriangulation& mesh);

}  // namespace shape3d::mapping
