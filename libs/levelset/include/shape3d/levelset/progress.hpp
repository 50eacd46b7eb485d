#pragma once

#include <functional>
#include <limits>
#include <string_view>

namespace shape3d::levelset {

/// What a long computation says of itself.
struct Progress {
  std::string_view stage;  ///< "histogram", "mixture", "gradient", "calibration", "speed",
                           ///< "evolution".
  double share = 0.0;      ///< Of the stage, 0 … 1, never falling.
  /// Estimate of the seconds that the stage still takes; NaN while there is none.
  double seconds_left = std::numeric_limits<double>::quiet_NaN();
};

/// Called now and then from the calling thread; false cancels.
using ProgressFunction = std::function<bool(const Progress&)>;

}  // namespace shape3d::levelset
