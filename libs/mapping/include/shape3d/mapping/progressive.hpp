#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "shape3d/mapping/export.hpp"
#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

/// What an edge collapse costs, and where it puts the vertex that is left.
enum class CollapseCost {
  /// Sum of squared distances to the planes of the triangles that were merged into the vertex
  /// (Garland and Heckbert's quadrics); the vertex goes where it is least. The fastest.
  quadrics,
  /// Lindstrom and Turk's memoryless cost: volume and boundary are preserved, then their change is
  /// least.
  lindstrom_turk,
  /// Hoppe's energy (4.12): see HoppeOptions. The slowest.
  hoppe
};

/// "quadrics", "lindstrom_turk", "hoppe".
[[nodiscard]] SHAPE3D_MAPPING_EXPORT std::string_view to_string(CollapseCost cost);

/// The terms of E = E_dist + E_spring + E_scalar + E_disc (4.12), in a mesh scaled to a bounding
/// box of diagonal 1. A collapse costs the change of E.
struct HoppeOptions {
  /// E_dist = Σ d² of the points X = the vertices of the given mesh to the simplified one.
  double distance_weight = 1.0;
  /// E_spring = κ Σ |edge|², where κ is this times 1, 10⁻² or 10⁻⁶ when the neighbourhood has fewer
  /// than 4, fewer than 8, or more points of X a triangle.
  double spring_weight = 1e-2;
  /// E_scalar = Σ |attribute of a point − attribute of the simplified mesh at its foot|².
  double scalar_weight = 1.0;
  Eigen::MatrixXd attributes;  ///< #V rows; empty: no E_scalar.
  /// E_disc = Σ d² of the vertices and middles of the sharp edges to the simplified sharp edges.
  double discontinuity_weight = 1.0;
  /// Edges are sharp whose two triangles meet at more than this angle (radians, 0 … π between their
  /// normals), and boundary edges. π: boundary edges alone. Collapses that would change how curves
  /// of sharp edges are connected are not made.
  double sharp_angle = 0.7853981633974483;
};

/// Settings of ProgressiveMesh's constructor.
struct ProgressiveOptions {
  CollapseCost cost = CollapseCost::quadrics;
  /// Collapses end at this number of triangles, or when none is left that keeps the topology; >= 1.
  std::int64_t coarsest = 4;
  HoppeOptions hoppe;  ///< Of CollapseCost::hoppe.
  /// Called now and then with the share done, 0 … 1; false cancels (see is_complete()).
  std::function<bool(double)> progress;
};

/// A mesh in all numbers of triangles: the finest mesh, and the edge collapses that lead to the
/// coarsest one, each of which can be undone exactly (Hoppe's progressive mesh).
///
/// The finest level is the given mesh to the bit: coordinates, order of vertices and triangles, and
/// which corner of a triangle comes first. Vertices and triangles keep their numbers through all
/// levels; a level lists those that are left in the order of these numbers.
///
/// Topology does not change: genus, components and boundary loops of the coarsest level are those
/// of the mesh.
class SHAPE3D_MAPPING_EXPORT ProgressiveMesh {
 public:
  /// Collapses edges in the order of their cost (CGAL's surface mesh simplification).
  ///
  /// New positions are rounded to a lattice of 2⁻²² of the extent, which makes them compact.
  ///
  /// @param V  #V by 3, finite; every vertex in a triangle.
  /// @param F  #F by 3; an oriented manifold, with or without boundary, of any genus.
  /// @throws std::invalid_argument  V or F is not as described (the message says what, where and
  /// how often), or an option is out of range.
  ///
  /// Deterministic. O(#F log #F). The mesh is at its finest level.
  ProgressiveMesh(const ConstPoints& V, const ConstTriangles& F,
                  const ProgressiveOptions& options = {});
  ~ProgressiveMesh();
  ProgressiveMesh(const ProgressiveMesh& other);
  ProgressiveMesh& operator=(const ProgressiveMesh& other);
  ProgressiveMesh(ProgressiveMesh&&) noexcept;
  ProgressiveMesh& operator=(ProgressiveMesh&&) noexcept;

  /// False when `progress` cancelled; the collapses made till then are there.
  [[nodiscard]] bool is_complete() const;

  [[nodiscard]] std::int64_t finest() const;     ///< Triangles of the given mesh.
  [[nodiscard]] std::int64_t coarsest() const;   ///< Triangles of the coarsest level.
  [[nodiscard]] std::int64_t collapses() const;  ///< Number of recorded collapses.
  /// Of the present level.
  [[nodiscard]] std::int64_t triangle_count() const;
  [[nodiscard]] std::int64_t vertex_count() const;

  /// Coarsens or refines to the finest level of at most `count` triangles, or to the coarsest when
  /// there is none. O(difference); millions of splits a second.
  /// @throws std::invalid_argument  count < 0.
  void set_triangle_count(std::int64_t count);

  /// The present level.
  [[nodiscard]] Points V() const;
  [[nodiscard]] Triangles F() const;
  /// The rows of the given mesh that the rows of V() stand for.
  [[nodiscard]] std::vector<std::int32_t> vertex_rows() const;

  /// All levels in a compact form: the coarsest level and the vertex splits. Coordinates that are
  /// decimals of few digits take about 3 bytes each, floats 4, others 8.
  [[nodiscard]] std::vector<std::byte> to_bytes() const;
  /// The mesh at its finest level, equal to the one that was written. The bytes need not be
  /// trusted.
  /// @throws std::invalid_argument  the bytes are damaged or of another version; the message says
  /// where.
  [[nodiscard]] static ProgressiveMesh from_bytes(const std::byte* data, std::size_t size);

  struct Data;  ///< Of the implementation.

 private:
  explicit ProgressiveMesh(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace shape3d::mapping
