#include "pipeline.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>

#include "parallel.hpp"
#include "plan.hpp"

namespace shape3d::zmc::detail {

void check_arguments(const VolumeView& view, double isovalue, const Options& options) {
  validate(view);
  if (view.dims[0] > Plan::kLongestRow - 2) {
    throw std::invalid_argument("dims[0]: expected at most " +
                                std::to_string(Plan::kLongestRow - 2) + " samples in a row, got " +
                                std::to_string(view.dims[0]));
  }
  if (!std::isfinite(isovalue)) {
    throw std::invalid_argument("isovalue: expected a finite value, got " +
                                std::to_string(isovalue));
  }
  if (options.threads < 0) {
    throw std::invalid_argument("options.threads: expected 0 or more, got " +
                                std::to_string(options.threads));
  }
  if (options.max_vertices < 0) {
    throw std::invalid_argument("options.max_vertices: expected 0 or more, got " +
                                std::to_string(options.max_vertices));
  }
}

LayerLoop layer_loop(const Options& options, std::int64_t samples, double from, double to) {
  constexpr std::int64_t kWorthSharing = 1 << 12;  // below, waking threads costs more than the work
  const int threads = samples < kWorthSharing ? 1 : resolve_threads(options.threads);
  return [&options, threads, from, to, reached = from](
             std::int64_t count,
             const std::function<void(std::int64_t, std::int64_t)>& body) mutable {
    constexpr std::int64_t kGrain = 1;
    if (!options.progress) {
      parallel_ranges(count, kGrain, threads, body);
      return true;
    }
    // Threads go on working while the calling one reports between two ranges of its own.
    constexpr std::int64_t kReports = 16;
    const std::int64_t step = std::max<std::int64_t>(1, (count + kReports - 1) / kReports);
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<std::int64_t> done{0};
    std::atomic<bool> cancelled{false};
    std::int64_t reported = 0;  // the calling thread's own
    const auto report = [&](std::int64_t layers) {
      reported = layers;
      const double share = static_cast<double>(layers) / static_cast<double>(count);
      reached = std::max(reached, from + (to - from) * share);  // several loops may share the range
      if (!options.progress(reached)) cancelled = true;
    };
    parallel_ranges(count, kGrain, threads, [&](std::int64_t first, std::int64_t last) {
      for (std::int64_t next = 0; first < last && !cancelled; first = next) {
        next = std::min(first + step, last);
        body(first, next);
        const std::int64_t layers = done += next - first;
        if (std::this_thread::get_id() == caller && layers < count && layers - reported >= step)
          report(layers);
      }
    });
    if (!cancelled && count > 0) report(count);
    if (cancelled) return false;
    return true;
  };
}

}  // namespace shape3d::zmc::detail
