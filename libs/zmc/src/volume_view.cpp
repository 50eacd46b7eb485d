#include "shape3d/zmc/volume_view.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/LU>

namespace shape3d::zmc {
namespace {

template <class Number>
std::string text(Number value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end.ptr};
}

std::string text(const std::array<std::int64_t, 3>& values) {
  return "(" + text(values[0]) + ", " + text(values[1]) + ", " + text(values[2]) + ")";
}

[[noreturn]] void refuse(const std::string& field, const std::string& value,
                         const std::string& expected) {
  throw std::invalid_argument("volume view: " + field + " is " + value + "; expected " + expected);
}

/// Bytes of a dense array of these samples fit the address range.
bool is_addressable(const std::array<std::int64_t, 3>& dims, SampleType type) {
  std::int64_t room =
      std::numeric_limits<std::ptrdiff_t>::max() / static_cast<std::int64_t>(sample_size(type));
  for (const std::int64_t dim : dims) room /= dim;
  return room > 0;
}

/// The axes, made unit vectors, span a volume of zero up to rounding. Dividing by the norms gives
/// each entry a relative error under 4u, the products and sums of the determinant add 6u (u: half
/// an epsilon). The six products sum to at most 3√3 in absolute value, the product of the columns'
/// sums: the error is under 18·5.2 u = 47 epsilon.
bool is_singular(const Eigen::Matrix3d& direction) {
  Eigen::Matrix3d unit = direction;
  for (int axis = 0; axis < 3; ++axis) {
    const double norm = direction.col(axis).stableNorm();
    if (norm == 0.0) return true;
    unit.col(axis) /= norm;
  }
  return std::abs(unit.determinant()) <= 64 * std::numeric_limits<double>::epsilon();
}

}  // namespace

std::string_view to_string(SampleType type) {
  switch (type) {
    case SampleType::int8:
      return "int8";
    case SampleType::uint8:
      return "uint8";
    case SampleType::int16:
      return "int16";
    case SampleType::uint16:
      return "uint16";
    case SampleType::int32:
      return "int32";
    case SampleType::float32:
      return "float32";
    case SampleType::float64:
      return "float64";
  }
  return "unknown";
}

std::size_t sample_size(SampleType type) {
  switch (type) {
    case SampleType::int8:
    case SampleType::uint8:
      return 1;
    case SampleType::int16:
    case SampleType::uint16:
      return 2;
    case SampleType::int32:
    case SampleType::float32:
      return 4;
    case SampleType::float64:
      return 8;
  }
  throw std::invalid_argument("sample type is " + text(static_cast<int>(type)) +
                              "; expected one of the enumeration");
}

VolumeView subvolume(const VolumeView& view, const std::array<std::int64_t, 3>& lower,
                     const std::array<std::int64_t, 3>& upper) {
  VolumeView block = view;
  block.strides = view.effective_strides();
  std::int64_t offset = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (lower[axis] < 0 || lower[axis] >= upper[axis] || upper[axis] > view.dims[axis]) {
      throw std::invalid_argument(
          "subvolume: range [" + text(lower[axis]) + ", " + text(upper[axis]) + ") of axis " +
          "xyz"[axis] + "; expected a non-empty range within [0, " + text(view.dims[axis]) + ")");
    }
    block.dims[axis] = upper[axis] - lower[axis];
    offset += lower[axis] * block.strides[axis];
  }
  if (view.data != nullptr) {
    block.data = static_cast<const std::byte*>(view.data) +
                 offset * static_cast<std::int64_t>(sample_size(view.type));
  }
  block.origin = view.world({static_cast<double>(lower[0]), static_cast<double>(lower[1]),
                             static_cast<double>(lower[2])});
  return block;
}

void validate(const VolumeView& view) {
  if (view.data == nullptr) refuse("data", "null", "a pointer to samples");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (view.dims[axis] < 2) {
      refuse("dims[" + text(axis) + "]", text(view.dims[axis]),
             "at least 2 (a volume one sample thick has no cells)");
    }
  }
  if (!is_addressable(view.dims, view.type)) {
    refuse("dims", text(view.dims), "a number of samples that memory can address");
  }

  int zero_strides = 0;
  for (const std::int64_t stride : view.strides) zero_strides += stride == 0 ? 1 : 0;
  if (zero_strides != 0 && zero_strides != 3) {
    refuse("strides", text(view.strides), "all or none of them 0");
  }

  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (!(std::isfinite(view.spacing[axis]) && view.spacing[axis] > 0.0)) {
      refuse("spacing[" + text(axis) + "]", text(view.spacing[axis]), "a finite positive number");
    }
    if (!std::isfinite(view.origin[axis])) {
      refuse("origin[" + text(axis) + "]", text(view.origin[axis]), "a finite number");
    }
    for (Eigen::Index row = 0; row < 3; ++row) {
      if (!std::isfinite(view.direction(row, axis))) {
        refuse("direction(" + text(row) + ", " + text(axis) + ")", text(view.direction(row, axis)),
               "a finite number");
      }
    }
  }
  if (is_singular(view.direction)) {
    std::string columns;
    for (Eigen::Index i = 0; i < 9; ++i) {
      columns += (i == 0 ? "" : i % 3 == 0 ? "; " : " ") + text(view.direction(i % 3, i / 3));
    }
    refuse("direction", "singular (columns " + columns + ")", "three independent axes");
  }
}

}  // namespace shape3d::zmc
