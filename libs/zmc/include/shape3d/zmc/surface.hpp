#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "shape3d/zmc/export.hpp"

namespace shape3d::zmc {

namespace detail {
/// Memory for large arrays, on huge pages where the system has them: a first touch costs a page
/// fault, which is dearer than the writing itself. @throws std::bad_alloc
[[nodiscard]] SHAPE3D_ZMC_EXPORT void* allocate_array(std::size_t bytes);
SHAPE3D_ZMC_EXPORT void free_array(void* array) noexcept;

/// Allocator whose containers leave new elements uninitialised on resize().
template <class T>
struct ArrayAllocator {
  using value_type = T;

  ArrayAllocator() = default;
  template <class U>
  ArrayAllocator(const ArrayAllocator<U>& /*other*/) noexcept {
  }  // NOLINT(google-explicit-constructor): as allocators are

  [[nodiscard]] T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_array(count * sizeof(T)));
  }
  void deallocate(T* array, std::size_t /*count*/) noexcept { free_array(array); }
  template <class U>
  void construct(U* p) noexcept {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
  friend bool operator==(const ArrayAllocator& /*a*/, const ArrayAllocator& /*b*/) { return true; }
  friend bool operator!=(const ArrayAllocator& /*a*/, const ArrayAllocator& /*b*/) { return false; }
};
template <class T>
using Buffer = std::vector<T, ArrayAllocator<T>>;

/// Takes the array out of a buffer without a copy: null when the buffer has none. The caller ends
/// it with free_array(). For hand-over to libraries that keep arrays by address.
template <class T>
[[nodiscard]] T* release_array(Buffer<T>&& buffer) noexcept {
  static_assert(std::is_trivially_destructible_v<T>);
  // A vector gives its array up only by its destructor, so this one never ends.
  alignas(Buffer<T>) unsigned char storage[sizeof(Buffer<T>)];
  return (::new (static_cast<void*>(storage)) Buffer<T>(std::move(buffer)))->data();
}
}  // namespace detail

/// Where a triangle comes from.
enum class TriangleKind : std::uint8_t {
  patch,      ///< Part of a patch, the polygon in one cell.
  zero_face,  ///< Part of a cell face whose four samples are zero (face case 12).
  closing     ///< In a face of case 11 whose two cells bend the line to different zero vertices.
};

/// What extract() met on the way.
struct Counts {
  std::int64_t cells_with_patch = 0;  ///< Cells that contain at least one patch.
  std::array<std::int64_t, 13>
      faces_by_case{};  ///< [c − 1]: faces of case c among the six of each such cell (Fig. 3.7).
  std::int64_t patches = 0;            ///< Polygons in cells.
  std::int64_t zero_vertices = 0;      ///< Zero cell vertices that are vertices of the surface.
  std::int64_t zero_faces = 0;         ///< Faces of case 12 in the surface (quads, not triangles).
  std::int64_t closing_triangles = 0;  ///< Triangles of kind closing.
  std::int64_t all_zero_cells = 0;     ///< Cells of eight zero samples.
  std::int64_t masked_cells = 0;       ///< Cells skipped for a non-finite sample.
  std::int64_t centroids = 0;          ///< Vertices that are centroids of polygons.
  /// With Options::count_nonmanifold: edges of more than two triangles (all are zero edges);
  /// otherwise −1.
  std::int64_t nonmanifold_edges = -1;
};

/// Wall-clock seconds by stage.
struct Timings {
  double classify = 0.0, zero_regions = 0.0, count = 0.0, generate = 0.0;
};

/// Triangle mesh with shared vertices. Storage is kept and reused when the same object is filled
/// again.
///
/// Real: float or double. Index: std::int32_t or std::int64_t.
/// Triangles are ordered patch, zero face, closing; within a kind by cell in lattice order.
template <class Real = double, class Index = std::int32_t>
struct Surface {
  using Points = Eigen::Matrix<Real, Eigen::Dynamic, 3, Eigen::RowMajor>;
  using Triangles = Eigen::Matrix<Index, Eigen::Dynamic, 3, Eigen::RowMajor>;

  detail::Buffer<Real> positions;  ///< 3·n world coordinates, x y z of vertex 0 first.
  detail::Buffer<Index> indices;   ///< 3·m vertex ids, counter-clockwise seen from outside.
  /// With Options::gradients, 3·n: the gradient of the samples in world units, by central
  /// differences at lattice points (one-sided at the border and beside masked samples, 0 where
  /// neither side is there), interpolated along lattice edges, averaged at centroids. On a cap it
  /// is 0.
  detail::Buffer<Real> gradients;
  /// With Options::normals, 3·n: the unit vector along the gradient that points from inside to
  /// outside; on a cap the direction out of the volume. Zero where the gradient vanishes.
  detail::Buffer<Real> normals;
  /// With Options::edges, n: the lattice edge that a vertex lies on, 3·(i + nx·(j + ny·k)) + axis
  /// of its lower end (i, j, k). A zero sample, and the border sample under a cap, count as the
  /// beginning of an edge along x. −1: a centroid, which is the mean of the vertices that it shares
  /// triangles with.
  detail::Buffer<std::int64_t> edges;
  /// With Options::edges, n: the place on that edge, 0 at its lower end, 1 at its upper; 0 for
  /// centroids. Interpolates other samples of the lattice: (1 − t)·lower + t·upper.
  detail::Buffer<Real> edge_parameters;
  std::int64_t first_zero_face =
      0;  ///< Triangles [first_zero_face, first_closing) are of kind zero_face.
  std::int64_t first_closing = 0;  ///< Triangles [first_closing, m) are of kind closing.
  Counts counts;
  Timings timings;

  [[nodiscard]] std::int64_t vertex_count() const {
    return static_cast<std::int64_t>(positions.size() / 3);
  }
  [[nodiscard]] std::int64_t triangle_count() const {
    return static_cast<std::int64_t>(indices.size() / 3);
  }
  /// #V by 3, world units.
  [[nodiscard]] Eigen::Map<const Points> V() const { return {positions.data(), vertex_count(), 3}; }
  /// #F by 3, rows of vertex ids.
  [[nodiscard]] Eigen::Map<const Triangles> F() const {
    return {indices.data(), triangle_count(), 3};
  }
  /// #V by 3, or empty.
  [[nodiscard]] Eigen::Map<const Points> N() const {
    return {normals.data(), static_cast<Eigen::Index>(normals.size() / 3), 3};
  }
  /// #V by 3, or empty.
  [[nodiscard]] Eigen::Map<const Points> G() const {
    return {gradients.data(), static_cast<Eigen::Index>(gradients.size() / 3), 3};
  }
  [[nodiscard]] TriangleKind kind(std::int64_t triangle) const {
    if (triangle < first_zero_face) return TriangleKind::patch;
    return triangle < first_closing ? TriangleKind::zero_face : TriangleKind::closing;
  }
};

}  // namespace shape3d::zmc
