#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

/// Half-edge h = 3 t + k of triangle t runs from F(t, k) to F(t, (k + 1) % 3).
using Twins = std::vector<std::int32_t>;

inline std::int32_t next_half_edge(std::int32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline std::int32_t previous_half_edge(std::int32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// @throws std::invalid_argument  an entry of P is not finite, named by row; `name` is the
/// argument.
void require_finite(const ConstPoints& P, std::string_view name);

/// @throws std::invalid_argument  an index is not in [0, vertex_count).
void require_indices(const ConstTriangles& F, Eigen::Index vertex_count);

/// The opposite half-edge of each.
/// @throws std::invalid_argument  F is no closed, consistently oriented, connected surface of genus
/// 0
///         that uses all vertices and has one fan of triangles at each; says how often what occurs.
[[nodiscard]] Twins genus_zero_twins(const ConstTriangles& F, Eigen::Index vertex_count);

}  // namespace shape3d::mapping
