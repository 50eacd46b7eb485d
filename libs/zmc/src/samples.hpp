#pragma once

// Access to samples of a lattice that may be surrounded by one layer of imaginary samples
// (Border::capped).

#include <cstdint>
#include <type_traits>

#include "magnitude.hpp"
#include "shape3d/zmc/volume_view.hpp"

namespace shape3d::zmc::detail {

/// |sample − isovalue| at lattice points. With Capped, indices count from the imaginary layer,
/// whose samples are infinitely far from the isovalue.
template <class T, bool Capped>
struct MagnitudeReader {
  const T* data = nullptr;
  std::array<std::int64_t, 3> strides{};
  std::array<std::int64_t, 3> dims{};  ///< Of the samples.
  double isovalue = 0.0;

  MagnitudeReader(const VolumeView& view, double iso)
      : data(static_cast<const T*>(view.data)),
        strides(view.effective_strides()),
        dims(view.dims),
        isovalue(iso) {}

  double operator()(std::int64_t i, std::int64_t j, std::int64_t k) const {
    if constexpr (Capped) {
      --i, --j, --k;
      if (i < 0 || j < 0 || k < 0 || i >= dims[0] || j >= dims[1] || k >= dims[2])
        return kHugeMagnitude;
    }
    const auto sample = static_cast<double>(data[i * strides[0] + j * strides[1] + k * strides[2]]);
    if constexpr (std::is_same_v<T, double>) return magnitude_between(sample, isovalue);
    return std::abs(sample - isovalue);
  }
};

/// Calls visit(T{}) with the C++ type of a sample type.
template <class Visitor>
decltype(auto) visit_sample_type(SampleType type, Visitor&& visit) {
  switch (type) {
    case SampleType::int8:
      return visit(std::int8_t{});
    case SampleType::uint8:
      return visit(std::uint8_t{});
    case SampleType::int16:
      return visit(std::int16_t{});
    case SampleType::uint16:
      return visit(std::uint16_t{});
    case SampleType::int32:
      return visit(std::int32_t{});
    case SampleType::float32:
      return visit(float{});
    case SampleType::float64:
      break;
  }
  return visit(double{});
}

/// A MagnitudeReader of any type behind one call, for places where speed does not matter.
class AnyMagnitudeReader {
 public:
  AnyMagnitudeReader(const VolumeView& view, double isovalue, bool capped)
      : view_(view), isovalue_(isovalue), read_(choose(view.type, capped)) {}

  double operator()(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return read_(view_, isovalue_, i, j, k);
  }

 private:
  using Read = double (*)(const VolumeView&, double, std::int64_t, std::int64_t, std::int64_t);

  template <class T, bool Capped>
  static double read(const VolumeView& view, double isovalue, std::int64_t i, std::int64_t j,
                     std::int64_t k) {
    return MagnitudeReader<T, Capped>(view, isovalue)(i, j, k);
  }
  static Read choose(SampleType type, bool capped) {
    return visit_sample_type(type, [capped](auto sample) -> Read {
      using T = decltype(sample);
      return capped ? &read<T, true> : &read<T, false>;
    });
  }

  const VolumeView& view_;
  double isovalue_;
  Read read_;
};

}  // namespace shape3d::zmc::detail
