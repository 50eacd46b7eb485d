#include "isovalues.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "samples_at.hpp"

namespace shape3d::apps::viewer {

double default_isovalue(const zmc::VolumeView& volume, double minimum, double maximum) {
  if (minimum < -500.0 && maximum > 500.0) return 226.0;
  constexpr std::int64_t kSamples = 200'000;
  constexpr std::size_t kBins = 256;
  const std::int64_t count = volume.dims[0] * volume.dims[1] * volume.dims[2];
  const std::int64_t step = std::max<std::int64_t>(1, count / kSamples) | 1;
  const double width = (maximum - minimum) / kBins;
  if (!(width > 0.0)) return minimum;
  std::array<double, kBins> histogram{};
  double total = 0.0, sum = 0.0;
  for (std::int64_t n = 0; n < count; n += step) {
    const std::int64_t i = n % volume.dims[0], rest = n / volume.dims[0];
    const double value = sample_at(volume, {i, rest % volume.dims[1], rest / volume.dims[1]});
    if (!std::isfinite(value)) continue;
    const auto bin = static_cast<std::size_t>(
        std::clamp((value - minimum) / width, 0.0, static_cast<double>(kBins - 1)));
    histogram[bin] += 1.0;
    total += 1.0;
    sum += static_cast<double>(bin);
  }
  // The most between-class variance, w0 w1 (m0 − m1)², over thresholds after each bin.
  double below = 0.0, below_sum = 0.0, best = -1.0;
  std::size_t threshold = kBins / 2;
  for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
    below += histogram[bin];
    below_sum += histogram[bin] * static_cast<double>(bin);
    const double above = total - below;
    if (below <= 0.0 || above <= 0.0) continue;
    const double difference = below_sum / below - (sum - below_sum) / above;
    const double between = below * above * difference * difference;
    if (between > best) {
      best = between;
      threshold = bin + 1;
    }
  }
  return minimum + width * static_cast<double>(threshold);
}

}  // namespace shape3d::apps::viewer
