#include "volume_info.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace shape3d::apps {
namespace {

template <class T>
bool is_finite(T value) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value);
  } else {
    return true;
  }
}

template <class T>
void describe(const T* samples, std::size_t count, std::size_t row, VolumeDescription& result) {
  T lower = std::numeric_limits<T>::max();
  T upper = std::numeric_limits<T>::lowest();
  long double sum = 0.0L;
  for (std::size_t first = 0; first < count; first += row) {
    long double row_sum = 0.0L;
    for (std::size_t index = first; index < std::min(first + row, count); ++index) {
      const T value = samples[index];
      if (!is_finite(value)) {
        ++result.non_finite;
        continue;
      }
      lower = std::min(lower, value);
      upper = std::max(upper, value);
      row_sum += static_cast<long double>(value);
    }
    sum += row_sum;
  }
  result.finite = count - result.non_finite;
  if (result.finite == 0) return;
  result.minimum = static_cast<double>(lower);
  result.maximum = static_cast<double>(upper);
  result.mean = static_cast<double>(sum / static_cast<long double>(result.finite));

  int bins = VolumeDescription::kBins;
  // The difference of two doubles of 1e308 overflows; halves do not.
  double half_width = (0.5 * result.maximum - 0.5 * result.minimum) / bins;
  result.histogram_lower = result.minimum;
  if (std::is_integral_v<T> && result.maximum - result.minimum < bins) {
    bins = static_cast<int>(result.maximum - result.minimum) + 1;
    half_width = 0.5;
    result.histogram_lower = result.minimum - 0.5;
  } else if (half_width == 0.0) {
    bins = 1;
  }
  result.histogram_width = 2.0 * half_width;
  result.histogram.assign(static_cast<std::size_t>(bins), 0);
  for (std::size_t index = 0; index < count; ++index) {
    if (!is_finite(samples[index])) continue;
    int bin = 0;
    if (half_width > 0.0) {
      const double offset =
          0.5 * static_cast<double>(samples[index]) - 0.5 * result.histogram_lower;
      bin = std::clamp(static_cast<int>(offset / half_width), 0, bins - 1);
    }
    ++result.histogram[static_cast<std::size_t>(bin)];
  }
}

}  // namespace

VolumeDescription describe_volume(const Volume& volume) {
  const zmc::VolumeView& view = volume.view;
  VolumeDescription result;
  result.format = volume.format;
  result.dims = view.dims;
  result.type = view.type;
  result.spacing = view.spacing;
  result.origin = view.origin;
  result.direction = view.direction;
  const auto row = static_cast<std::size_t>(view.dims[0]);
  const std::size_t count =
      row * static_cast<std::size_t>(view.dims[1]) * static_cast<std::size_t>(view.dims[2]);
  if (count == 0) return result;
  const auto run = [&](auto zero) {
    describe(static_cast<const decltype(zero)*>(view.data), count, row, result);
  };
  switch (view.type) {
    case zmc::SampleType::int8:
      run(std::int8_t{});
      break;
    case zmc::SampleType::uint8:
      run(std::uint8_t{});
      break;
    case zmc::SampleType::int16:
      run(std::int16_t{});
      break;
    case zmc::SampleType::uint16:
      run(std::uint16_t{});
      break;
    case zmc::SampleType::int32:
      run(std::int32_t{});
      break;
    case zmc::SampleType::float32:
      run(float{});
      break;
    case zmc::SampleType::float64:
      run(double{});
      break;
  }
  return result;
}

}  // namespace shape3d::apps
