#pragma once

#include <cstdint>

#include "mesh.hpp"

namespace shape3d::apps {

/// How far the points of one surface are from another.
struct SurfaceDistance {
  /// SSD_AB = Σ_{p ∈ A} dist²(p, B) over the vertices of A that triangles use (5.16).
  double sum_of_squares = 0.0;
  std::int64_t vertices = 0;  ///< Of that sum.
  /// ∫_A dist² / area: what does not depend on how A is cut into triangles.
  double mean_square = 0.0;
  /// Largest distance of a point of A that was looked at …
  double largest = 0.0;
  /// … which the largest of all points of A (the one-sided Hausdorff distance) exceeds at most by
  /// this.
  double spacing = 0.0;
  std::int64_t samples = 0;  ///< Points looked at.
};

/// Distances of the points of A to the nearest points of B, by cells of VTK. Triangles are cut into
/// n² equal ones whose sides are at most s; dist is looked at in the corners of these, and
/// integrated by their centroids (an error of order s²). No point is farther from a corner than s /
/// √3, and dist does not change faster than its argument: `spacing` is s / √3.
/// @param samples  About how many small triangles there are to be, 1 … 10⁸.
/// @param threads  0: all processors; no matter for the result.
/// @throws std::invalid_argument  A or B has no triangle with an area; samples is out of range.
[[nodiscard]] SurfaceDistance surface_distance(const Mesh& A, const Mesh& B,
                                               std::int64_t samples = 100000, int threads = 0);

}  // namespace shape3d::apps
