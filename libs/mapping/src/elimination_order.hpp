#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

using HalfEdges = std::vector<std::array<std::int32_t, 2>>;

/// From each vertex of each triangle to the next.
HalfEdges half_edges(const ConstTriangles& F);

/// Order in which to eliminate the vertices of a triangulated closed surface from a sparse
/// symmetric system with an entry for every vertex and edge, so that its Cholesky factor fills
/// little: the better of nested dissection and approximate minimum degree, by the floating-point
/// operations of the factorisation.
///
/// Nested dissection halves the vertices by planes across the axis that cuts the fewest of them off
/// their neighbours, down to parts of 50, and eliminates the cut ones after both halves (George
/// 1973); inside the parts and the cuts it is constrained minimum degree. On even meshes of 300k
/// triangles it halves the operations of minimum degree; on folded ones it may do harm.
///
/// @param positions  Of the vertices, in space or on the sphere; only their order along axes
/// counts.
/// @param edges      Each in both directions; loops and repetitions do not matter. They should be
///                   those of the system: one across a cut undoes it.
/// @return           order[k] is the vertex eliminated as the k-th. Deterministic.
/// O(n log² n) and the analyses.
std::vector<std::int32_t> elimination_order(const ConstPoints& positions, const HalfEdges& edges);

}  // namespace shape3d::mapping
