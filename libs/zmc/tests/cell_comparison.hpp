#pragma once

#include <array>
#include <string>
#include <vector>

#include "shape3d/zmc/cell.hpp"
#include "support/zmc_reference_cell.hpp"

namespace shape3d::zmc::test {

namespace reference = shape3d::test::reference;

/// Samples of the cell vertices, in Lorensen's order.
using Samples = std::array<double, 8>;

[[nodiscard]] std::string to_string(const Samples& samples);

/// The reference's name of a surface vertex of a cell.
[[nodiscard]] reference::LocalVertex local_vertex(CellSurfaceVertex v);

/// Polygons with the smallest vertex first, sorted, in the reference's vertex names.
[[nodiscard]] std::vector<std::vector<int>> canonical_patches(
    const std::vector<std::vector<CellSurfaceVertex>>& patches);
/// The same of the reference's.
[[nodiscard]] std::vector<std::vector<int>> canonical_cycles(std::vector<std::vector<int>> cycles);

[[nodiscard]] reference::CellSolution reference_solution(const Samples& samples, TieRule ties);

/// What differs between the library's cell and the reference's: cases, signs, patch edges with
/// direction and face, patches. Empty: nothing.
[[nodiscard]] std::string difference(const CellPatches& cell, const Samples& samples, TieRule ties);

/// What is wrong with the triangles of a cell. Each polygon of n vertices must be n - 2 triangles
/// on its vertices, without an edge in a cell face other than its sides, or n triangles round an
/// own centroid; the latter under compact only where the former is impossible, and under centroid
/// for every n > 3. Empty: nothing.
[[nodiscard]] std::string triangulation_fault(const CellPatches& cell, Triangulation triangulation);

}  // namespace shape3d::zmc::test
