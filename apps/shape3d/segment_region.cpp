#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/text.hpp"
#include "segment_arguments.hpp"

namespace shape3d::apps {
namespace {

Region by_index(const SegmentArguments& arguments, const zmc::VolumeView& volume) {
  Region region;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    region.lower[axis] = arguments.roi[2 * axis];
    region.upper[axis] = arguments.roi[2 * axis + 1];
    const std::string name(1, "xyz"[axis]);
    if (region.lower[axis] < 0 || region.upper[axis] > volume.dims[axis] ||
        region.lower[axis] + 2 > region.upper[axis]) {
      throw UsageError("--roi: " + name + " from " + std::to_string(region.lower[axis]) + " to " +
                       std::to_string(region.upper[axis]) +
                       " (the end is not included), expected 0 ≤ start < end ≤ " +
                       std::to_string(volume.dims[axis]) + " with two samples or more, as " +
                       arguments.volume + " has " + to_text(volume.dims));
    }
  }
  return region;
}

Region by_place(const SegmentArguments& arguments, const zmc::VolumeView& volume) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lower = arguments.roi_mm[2 * axis], upper = arguments.roi_mm[2 * axis + 1];
    if (!(std::isfinite(lower) && std::isfinite(upper) && lower < upper)) {
      throw UsageError(std::string("--roi-mm: ") + "xyz"[axis] + " from " + to_text(lower) +
                       " to " + to_text(upper) + " mm, expected a finite start below a finite end");
    }
  }
  const Eigen::Matrix3d to_lattice = (volume.direction * volume.spacing.asDiagonal()).inverse();
  Eigen::Vector3d least = Eigen::Vector3d::Constant(1e300), most = -least;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d world(arguments.roi_mm[corner & 1],
                                arguments.roi_mm[2 + (corner >> 1 & 1)],
                                arguments.roi_mm[4 + (corner >> 2 & 1)]);
    const Eigen::Vector3d p = to_lattice * (world - volume.origin);
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  Region region;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    // Places on the samples themselves count in spite of rounding.
    constexpr double kRounding = 1e-6;
    const auto size = static_cast<double>(volume.dims[axis]);
    region.lower[axis] =
        static_cast<std::int64_t>(std::ceil(std::clamp(least[a] - kRounding, 0.0, size)));
    region.upper[axis] =
        static_cast<std::int64_t>(std::floor(std::clamp(most[a] + kRounding, -1.0, size - 1.0))) +
        1;
    if (region.lower[axis] + 2 > region.upper[axis]) {
      throw UsageError(
          std::string("--roi-mm: the box holds ") +
          std::to_string(std::max<std::int64_t>(region.upper[axis] - region.lower[axis], 0)) +
          " samples of " + arguments.volume + " along " + "xyz"[axis] + ", expected two or more");
    }
  }
  return region;
}

// A few times a nodule, that there is something round it.
Region round_nodule(const SegmentArguments& arguments, const zmc::VolumeView& volume) {
  Region region;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double reach =
        std::max(2.5 * arguments.radius / volume.spacing[static_cast<Eigen::Index>(axis)], 5.0);
    const auto last = static_cast<double>(volume.dims[axis] - 1);
    const double seed = std::clamp(arguments.seed[axis], 0.0, last);
    region.lower[axis] = static_cast<std::int64_t>(std::ceil(std::max(seed - reach, 0.0)));
    region.upper[axis] = static_cast<std::int64_t>(std::floor(std::min(seed + reach, last))) + 1;
  }
  return region;
}

}  // namespace

Region region_of(const SegmentArguments& arguments, const zmc::VolumeView& volume) {
  if (!arguments.roi.empty()) return by_index(arguments, volume);
  if (!arguments.roi_mm.empty()) return by_place(arguments, volume);
  if (arguments.nodule && arguments.radius > 0.0) return round_nodule(arguments, volume);
  return {{0, 0, 0}, volume.dims};
}

}  // namespace shape3d::apps
