#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace shape3d::levelset::detail {

/// Foretells when the front will rest, from how the number of active tiles falls.
class Forecast {
 public:
  explicit Forecast(int limit) : limit_(limit) {}

  void add(int iteration, std::int64_t tiles, double seconds) {
    work_ += static_cast<double>(tiles);
    history_.push_back({iteration, tiles});
    const double per_tile = work_ > 0.0 ? seconds / work_ : 0.0;
    // The tiles of ten records ago against those of now: a line to zero.
    const std::size_t back = std::min<std::size_t>(history_.size() - 1, 10);
    const auto& past = history_[history_.size() - 1 - back];
    double left = limit_ - iteration;
    if (back > 0 && past.second > tiles) {
      const double fall =
          static_cast<double>(past.second - tiles) / static_cast<double>(iteration - past.first);
      left = std::min(left, static_cast<double>(tiles) / fall);
    }
    seconds_left = left * per_tile * 0.5 * static_cast<double>(tiles);
    if (seconds + seconds_left > 0.0)
      share = std::max(share, std::min(seconds / (seconds + seconds_left), 0.999));
  }

  double share = 0.0, seconds_left = 0.0;

 private:
  int limit_;
  double work_ = 0.0;
  std::vector<std::pair<int, std::int64_t>> history_;
};

}  // namespace shape3d::levelset::detail
