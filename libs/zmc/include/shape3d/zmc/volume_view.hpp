#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <Eigen/Core>

#include "shape3d/zmc/export.hpp"

namespace shape3d::zmc {

/// Scalar type of the samples of a volume. Two's complement integers and IEEE 754 reals, native
/// byte order.
enum class SampleType { int8, uint8, int16, uint16, int32, float32, float64 };

/// "int16", "float32" … as spelled in the enumeration.
[[nodiscard]] SHAPE3D_ZMC_EXPORT std::string_view to_string(SampleType type);

/// Bytes of one sample.
[[nodiscard]] SHAPE3D_ZMC_EXPORT std::size_t sample_size(SampleType type);

/// Non-owning view of a regular lattice of nx × ny × nz samples in world space.
///
/// Sample (i, j, k) is element `i·strides[0] + j·strides[1] + k·strides[2]` of `data` and lies at
///   p = origin + direction · (spacing ∘ (i, j, k))      (world units; columns of direction: axes)
/// Strides are in samples, not in bytes, and may be negative; all zero stands for a dense array
/// with x fastest: (1, nx, nx·ny). The world is LPS in medical use; the library does not care.
struct VolumeView {
  const void* data = nullptr;
  SampleType type = SampleType::float32;
  std::array<std::int64_t, 3> dims{0, 0, 0};
  std::array<std::int64_t, 3> strides{0, 0, 0};
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();

  /// strides, with the dense default filled in.
  [[nodiscard]] std::array<std::int64_t, 3> effective_strides() const {
    if (strides[0] == 0 && strides[1] == 0 && strides[2] == 0)
      return {1, dims[0], dims[0] * dims[1]};
    return strides;
  }
  /// World position of lattice coordinates (not necessarily integers).
  [[nodiscard]] Eigen::Vector3d world(const Eigen::Vector3d& lattice) const {
    return origin + direction * spacing.cwiseProduct(lattice);
  }
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

/// View of a dense array, x fastest, with the identity as direction.
template <class T>
[[nodiscard]] VolumeView make_view(const T* data, std::array<std::int64_t, 3> dims,
                                   const Eigen::Vector3d& spacing = Eigen::Vector3d::Ones(),
                                   const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) {
  VolumeView view;
  view.data = data;
  view.type = SampleTypeOf<T>::value;
  view.dims = dims;
  view.spacing = spacing;
  view.origin = origin;
  return view;
}

/// The block lower ≤ (i, j, k) < upper of a view (half-open, lattice indices), at its place in the
/// world; the samples are shared, not copied.
/// @throws std::invalid_argument  the block is empty or reaches outside the view.
[[nodiscard]] SHAPE3D_ZMC_EXPORT VolumeView subvolume(const VolumeView& view,
                                                      const std::array<std::int64_t, 3>& lower,
                                                      const std::array<std::int64_t, 3>& upper);

/// Checks what every function of this library requires of a view.
/// @throws std::invalid_argument  naming the field and its value: data is null; a dimension is
/// below
///         2 (a volume one sample thick has no cells); nx·ny·nz overflows; a spacing is not finite
///         and positive; the origin or the direction is not finite; the direction is singular;
///         some strides are 0 and others not.
SHAPE3D_ZMC_EXPORT void validate(const VolumeView& view);

}  // namespace shape3d::zmc
