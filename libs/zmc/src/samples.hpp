#pragma once

// Access to samples of a lattice that may be surrounded by one layer of imaginary samples
// (Border::capped).

#include <array>
#include <cstdint>
#include <type_traits>

#include "magnitude.hpp"
#include "shape3d/zmc/cell.hpp"
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
    if (!inside(i, j, k)) return kHugeMagnitude;
    return magnitude_between(sample(i, j, k), isovalue);
  }
  /// Place of the crossing on the edge from (i, j, k) along an axis.
  double crossing(std::int64_t i, std::int64_t j, std::int64_t k, int axis) const {
    const std::int64_t x = i + (axis == 0), y = j + (axis == 1), z = k + (axis == 2);
    if (!inside(i, j, k)) return 1.0 - kCrossingMargin;
    if (!inside(x, y, z)) return kCrossingMargin;
    return crossing_parameter<T>(sample(i, j, k), sample(x, y, z), isovalue);
  }

 private:
  static constexpr std::int64_t kMargin = Capped ? 1 : 0;

  bool inside(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return !Capped || (i > 0 && j > 0 && k > 0 && i <= dims[0] && j <= dims[1] && k <= dims[2]);
  }
  double sample(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<double>(
        data[(i - kMargin) * strides[0] + (j - kMargin) * strides[1] + (k - kMargin) * strides[2]]);
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

/// A MagnitudeReader of any type behind calls, for places where speed does not matter.
class AnyMagnitudeReader {
 public:
  AnyMagnitudeReader(const VolumeView& view, double isovalue, bool capped)
      : view_(view), isovalue_(isovalue), functions_(choose(view.type, capped)) {}

  double operator()(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return functions_.magnitude(view_, isovalue_, i, j, k);
  }
  /// At the corners of cell (i, j, k), Lorensen's order.
  std::array<double, 8> corners(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return functions_.corners(view_, isovalue_, i, j, k);
  }
  double crossing(std::int64_t i, std::int64_t j, std::int64_t k, int axis) const {
    return functions_.crossing(view_, isovalue_, i, j, k, axis);
  }

 private:
  struct Functions {
    double (*magnitude)(const VolumeView&, double, std::int64_t, std::int64_t, std::int64_t);
    std::array<double, 8> (*corners)(const VolumeView&, double, std::int64_t, std::int64_t,
                                     std::int64_t);
    double (*crossing)(const VolumeView&, double, std::int64_t, std::int64_t, std::int64_t, int);
  };

  template <class Reader>
  static Functions functions() {
    return {
        [](const VolumeView& view, double isovalue, std::int64_t i, std::int64_t j,
           std::int64_t k) { return Reader(view, isovalue)(i, j, k); },
        [](const VolumeView& view, double isovalue, std::int64_t i, std::int64_t j,
           std::int64_t k) {
          const Reader reader(view, isovalue);
          std::array<double, 8> m{};
          for (int v = 0; v < 8; ++v) {
            const auto& step = kCellVertices[v];
            m[static_cast<std::size_t>(v)] = reader(i + step[0], j + step[1], k + step[2]);
          }
          return m;
        },
        [](const VolumeView& view, double isovalue, std::int64_t i, std::int64_t j, std::int64_t k,
           int axis) { return Reader(view, isovalue).crossing(i, j, k, axis); }};
  }
  static Functions choose(SampleType type, bool capped) {
    return visit_sample_type(type, [capped](auto sample) {
      using T = decltype(sample);
      return capped ? functions<MagnitudeReader<T, true>>()
                    : functions<MagnitudeReader<T, false>>();
    });
  }

  const VolumeView& view_;
  double isovalue_;
  Functions functions_;
};

}  // namespace shape3d::zmc::detail
