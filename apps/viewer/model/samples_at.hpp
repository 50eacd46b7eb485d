#pragma once

#include <array>
#include <cstdint>

#include <shape3d/zmc/volume_view.hpp>

namespace shape3d::apps::viewer {

/// Calls `function` with the samples of a view as a pointer of their type.
template <class Function>
decltype(auto) with_samples(const zmc::VolumeView& view, Function&& function) {
  switch (view.type) {
    case zmc::SampleType::int8:
      return function(static_cast<const std::int8_t*>(view.data));
    case zmc::SampleType::uint8:
      return function(static_cast<const std::uint8_t*>(view.data));
    case zmc::SampleType::int16:
      return function(static_cast<const std::int16_t*>(view.data));
    case zmc::SampleType::uint16:
      return function(static_cast<const std::uint16_t*>(view.data));
    case zmc::SampleType::int32:
      return function(static_cast<const std::int32_t*>(view.data));
    case zmc::SampleType::float32:
      return function(static_cast<const float*>(view.data));
    case zmc::SampleType::float64:
      break;
  }
  return function(static_cast<const double*>(view.data));
}

/// One sample. @pre  p is within the lattice.
[[nodiscard]] inline double sample_at(const zmc::VolumeView& view,
                                      const std::array<std::int64_t, 3>& p) {
  const std::array<std::int64_t, 3> strides = view.effective_strides();
  const std::int64_t element = p[0] * strides[0] + p[1] * strides[1] + p[2] * strides[2];
  return with_samples(view,
                      [element](const auto* data) { return static_cast<double>(data[element]); });
}

}  // namespace shape3d::apps::viewer
