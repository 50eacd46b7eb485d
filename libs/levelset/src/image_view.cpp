#include "shape3d/levelset/image_view.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "message.hpp"

namespace shape3d::levelset {
namespace {

using detail::refuse;
using detail::text;

void check_lattice(const std::string& what, const std::array<std::int64_t, 3>& dims,
                   const Eigen::Vector3d& spacing, std::size_t bytes) {
  std::int64_t room = std::numeric_limits<std::ptrdiff_t>::max() / static_cast<std::int64_t>(bytes);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto h = spacing[static_cast<Eigen::Index>(axis)];
    if (dims[axis] < 1) {
      refuse(what + ": dims[" + text(axis) + "]", text(dims[axis]), "at least 1");
    }
    if (!(std::isfinite(h) && h > 0.0)) {
      refuse(what + ": spacing[" + text(axis) + "]", text(h), "a finite positive number of mm");
    }
    room /= dims[axis];
  }
  if (room == 0) {
    refuse(what + ": dims", text(dims), "a number of samples that memory can address");
  }
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

double Grid::mean_spacing() const { return std::cbrt(spacing.prod()); }

ImageView subvolume(const ImageView& view, const Box& box) {
  ImageView block = view;
  block.strides = view.effective_strides();
  std::int64_t offset = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (box.lower[axis] < 0 || box.lower[axis] >= box.upper[axis] ||
        box.upper[axis] > view.dims[axis]) {
      throw std::invalid_argument("region of interest: range [" + text(box.lower[axis]) + ", " +
                                  text(box.upper[axis]) + ") of axis " + "xyz"[axis] +
                                  "; expected a non-empty range within [0, " +
                                  text(view.dims[axis]) + ")");
    }
    block.dims[axis] = box.upper[axis] - box.lower[axis];
    offset += box.lower[axis] * block.strides[axis];
  }
  if (view.data != nullptr) {
    block.data = static_cast<const std::byte*>(view.data) +
                 offset * static_cast<std::int64_t>(sample_size(view.type));
  }
  return block;
}

void validate(const ImageView& view) {
  if (view.data == nullptr) refuse("image: data", "null", "a pointer to samples");
  check_lattice("image", view.dims, view.spacing, sample_size(view.type));
  int zero_strides = 0;
  for (const std::int64_t stride : view.strides) zero_strides += stride == 0 ? 1 : 0;
  if (zero_strides != 0 && zero_strides != 3) {
    refuse("image: strides", text(view.strides), "all or none of them 0");
  }
}

void validate(const Grid& grid) { check_lattice("grid", grid.dims, grid.spacing, sizeof(float)); }

double anisotropy(const Eigen::Vector3d& spacing) {
  return spacing.maxCoeff() / spacing.minCoeff();
}

}  // namespace shape3d::levelset
