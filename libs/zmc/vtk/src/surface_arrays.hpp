#pragma once

// Surfaces of the library as arrays of VTK, without copying them.

#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>

#include "shape3d/zmc/surface.hpp"

namespace shape3d::zmc_vtk {

/// The array class whose elements are T.
template <class T>
using ArrayOf = std::conditional_t<
    std::is_same_v<T, float>, vtkFloatArray,
    std::conditional_t<std::is_same_v<T, double>, vtkDoubleArray,
                       std::conditional_t<sizeof(T) == 4, vtkTypeInt32Array, vtkTypeInt64Array>>>;

/// Hands the memory of a buffer over to a new array.
template <class T>
[[nodiscard]] vtkSmartPointer<ArrayOf<T>> adopt(zmc::detail::Buffer<T>&& buffer,
                                                int components = 1) {
  using Value = typename ArrayOf<T>::ValueType;
  static_assert(sizeof(Value) == sizeof(T));
  auto array = vtkSmartPointer<ArrayOf<T>>::New();
  array->SetNumberOfComponents(components);
  const auto size = static_cast<vtkIdType>(buffer.size());
  if (size == 0) return array;
  array->SetArray(reinterpret_cast<Value*>(zmc::detail::release_array(std::move(buffer))), size, 0,
                  vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
  array->SetArrayFreeFunction([](void* memory) { zmc::detail::free_array(memory); });
  return array;
}

/// Whether 32 bits number the vertices and the corners of triangles.
[[nodiscard]] constexpr bool fits_32_bits(std::int64_t vertices, std::int64_t triangles) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  return vertices <= kMost && triangles <= kMost / 3;
}

/// Triangles given by their corners, stored in Index.
template <class Index>
[[nodiscard]] vtkSmartPointer<vtkCellArray> make_triangles(zmc::detail::Buffer<Index>&& indices) {
  const auto count = static_cast<vtkIdType>(indices.size() / 3);
  zmc::detail::Buffer<Index> offsets(static_cast<std::size_t>(count) + 1);
  vtkSMPTools::For(0, count + 1, [&](vtkIdType first, vtkIdType last) {
    for (vtkIdType n = first; n < last; ++n)
      offsets[static_cast<std::size_t>(n)] = static_cast<Index>(3 * n);
  });
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  auto corners = adopt(std::move(indices));
  cells->SetData(adopt(std::move(offsets)).Get(), corners.Get());
  return cells;
}

/// Copies `from` to `to`, adding `base`, and frees its memory.
template <class T>
void move_elements(zmc::detail::Buffer<T>&& from, T* to, T base) {
  vtkSMPTools::For(0, static_cast<vtkIdType>(from.size()), [&](vtkIdType first, vtkIdType last) {
    for (vtkIdType n = first; n < last; ++n) to[n] = from[static_cast<std::size_t>(n)] + base;
  });
  zmc::detail::Buffer<T>().swap(from);
}

/// Several surfaces in one, in their order.
template <class Real, class Index>
[[nodiscard]] zmc::Surface<Real, Index> join(std::vector<zmc::Surface<Real, Index>>&& surfaces) {
  using Mesh = zmc::Surface<Real, Index>;
  Mesh whole;
  const auto join_field = [&](auto field, const auto& base_of) {
    std::size_t size = 0;
    for (const Mesh& part : surfaces) size += (part.*field).size();
    (whole.*field).resize(size);
    auto* to = (whole.*field).data();
    for (std::size_t n = 0; n < surfaces.size(); ++n) {
      auto& from = surfaces[n].*field;
      const std::size_t count = from.size();
      move_elements(std::move(from), to, base_of(n));
      to += count;
    }
  };
  std::vector<Index> base(surfaces.size(), 0);
  for (std::size_t n = 1; n < surfaces.size(); ++n)
    base[n] = base[n - 1] + static_cast<Index>(surfaces[n - 1].vertex_count());

  join_field(&Mesh::indices, [&](std::size_t n) { return base[n]; });
  join_field(&Mesh::edges, [](std::size_t) { return std::int64_t{0}; });
  for (auto field : {&Mesh::positions, &Mesh::gradients, &Mesh::normals, &Mesh::edge_parameters}) {
    join_field(field, [](std::size_t) { return Real{0}; });
  }
  return whole;
}

}  // namespace shape3d::zmc_vtk
