#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <Eigen/Core>

#include "shape3d/levelset/export.hpp"

namespace shape3d::levelset {

/// Scalar type of the samples of an image. Two's complement integers and IEEE 754 reals, native
/// byte order.
enum class SampleType { int8, uint8, int16, uint16, int32, float32, float64 };

/// "int16", "float32" … as spelled in the enumeration.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT std::string_view to_string(SampleType type);

/// Bytes of one sample.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT std::size_t sample_size(SampleType type);

/// Size of a lattice of nx × ny × nz nodes and the distances between them in millimetres.
/// Fields on it are arrays of nx·ny·nz values, x fastest: node (i, j, k) is i + nx·(j + ny·k).
struct Grid {
  std::array<std::int64_t, 3> dims{0, 0, 0};
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();

  /// nx·ny·nz.
  [[nodiscard]] std::int64_t size() const { return dims[0] * dims[1] * dims[2]; }
  [[nodiscard]] std::int64_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return i + dims[0] * (j + dims[1] * k);
  }
  /// (hx·hy·hz)^⅓ in mm: the length that "one voxel" means where a spacing differs by axis.
  [[nodiscard]] double mean_spacing() const;
};

/// One number a node.
using Field = Eigen::ArrayXf;

/// Non-owning view of a regular lattice of intensities.
///
/// Sample (i, j, k) is element i·strides[0] + j·strides[1] + k·strides[2] of `data`. Strides are in
/// samples, not in bytes, and may be negative; all zero stands for a dense array with x fastest.
struct ImageView {
  const void* data = nullptr;
  SampleType type = SampleType::float32;
  std::array<std::int64_t, 3> dims{0, 0, 0};
  std::array<std::int64_t, 3> strides{0, 0, 0};
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();  ///< mm

  /// strides, with the dense default filled in.
  [[nodiscard]] std::array<std::int64_t, 3> effective_strides() const {
    if (strides[0] == 0 && strides[1] == 0 && strides[2] == 0)
      return {1, dims[0], dims[0] * dims[1]};
    return strides;
  }
  [[nodiscard]] Grid grid() const { return {dims, spacing}; }
};

template <class T>
struct SampleTypeOf;
template <>
struct SampleTypeOf<std::int8_t> {
  static constexpr SampleType value = SampleType::int8;
};
template <>
struct SampleTypeOf<std::uint8_t> {
  static constexpr SampleType value = SampleType::uint8;
};
template <>
struct SampleTypeOf<std::int16_t> {
  static constexpr SampleType value = SampleType::int16;
};
template <>
struct SampleTypeOf<std::uint16_t> {
  static constexpr SampleType value = SampleType::uint16;
};
template <>
struct SampleTypeOf<std::int32_t> {
  static constexpr SampleType value = SampleType::int32;
};
template <>
struct SampleTypeOf<float> {
  static constexpr SampleType value = SampleType::float32;
};
template <>
struct SampleTypeOf<double> {
  static constexpr SampleType value = SampleType::float64;
};

/// View of a dense array, x fastest.
template <class T>
[[nodiscard]] ImageView make_view(const T* data, std::array<std::int64_t, 3> dims,
                                  const Eigen::Vector3d& spacing = Eigen::Vector3d::Ones()) {
  ImageView view;
  view.data = data;
  view.type = SampleTypeOf<T>::value;
  view.dims = dims;
  view.spacing = spacing;
  return view;
}

/// A box of nodes, lower ≤ (i, j, k) < upper.
struct Box {
  std::array<std::int64_t, 3> lower{0, 0, 0};
  std::array<std::int64_t, 3> upper{0, 0, 0};
};

/// The region of interest `box` of a view; the samples are shared, not copied.
/// @throws std::invalid_argument  the box is empty, inverted or reaches outside the view.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT ImageView subvolume(const ImageView& view, const Box& box);

/// Checks what every function of this library requires of a view.
/// @throws std::invalid_argument  naming the field and its value: data is null; a dimension is
///         below 1; the number of samples is beyond what memory can address; a spacing is not
///         finite and positive; some strides are 0 and others not.
SHAPE3D_LEVELSET_EXPORT void validate(const ImageView& view);

/// The same for a grid.
/// @throws std::invalid_argument  a dimension below 1, a spacing not finite and positive.
SHAPE3D_LEVELSET_EXPORT void validate(const Grid& grid);

/// Largest spacing over smallest. Above 20 the results of this library are of little use: the
/// smallest spacing limits the time step, the largest the resolution; segment() warns.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT double anisotropy(const Eigen::Vector3d& spacing);

}  // namespace shape3d::levelset
