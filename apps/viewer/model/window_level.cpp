#include "window_level.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "samples_at.hpp"

namespace shape3d::apps::viewer {

std::optional<Window> window_preset(std::string_view name) {
  for (const WindowPreset& preset : kWindowPresets) {
    if (preset.name == name) return preset.window;
  }
  return std::nullopt;
}

Window automatic_window(const zmc::VolumeView& volume) {
  constexpr std::int64_t kSamples = 200'000;
  const std::int64_t count = volume.dims[0] * volume.dims[1] * volume.dims[2];
  // A step that shares no factor with the sides would be ideal; an odd one visits all columns of
  // lattices whose sides are powers of two.
  const std::int64_t step = std::max<std::int64_t>(1, count / kSamples) | 1;
  std::vector<double> values;
  for (std::int64_t n = 0; n < count; n += step) {
    const std::int64_t i = n % volume.dims[0], rest = n / volume.dims[0];
    const double value = sample_at(volume, {i, rest % volume.dims[1], rest / volume.dims[1]});
    if (std::isfinite(value)) values.push_back(value);
  }
  if (values.empty()) return {};
  const auto percentile = [&values](double share) {
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
  };
  const double lower = percentile(0.01), upper = percentile(0.995);
  return {(lower + upper) / 2.0, upper > lower ? upper - lower : 1.0};
}

Window dragged(const Window& start, double dx, double dy, double range) {
  constexpr double kLeast = 1e-3;  // of the range: a window is never empty
  return {start.level + dy * range, std::max(start.width + dx * range, kLeast * range)};
}

}  // namespace shape3d::apps::viewer
