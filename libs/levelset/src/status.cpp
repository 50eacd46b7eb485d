#include "shape3d/levelset/status.hpp"

namespace shape3d::levelset {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::converged:
      return "the front came to rest";
    case Status::iteration_limit:
      return "the front still moved when the limit of iterations was reached";
    case Status::front_vanished:
      return "the front vanished: no voxel is inside";
    case Status::front_filled:
      return "the front filled the region: every voxel is inside";
    case Status::constant_image:
      return "the image is constant: there is nothing to separate";
    case Status::too_few_bins:
      return "the histogram has fewer occupied bins than classes were asked for";
    case Status::one_sided:
      return "all classes are on one side of the front";
    case Status::cancelled:
      return "cancelled by the caller";
  }
  return "unknown status";
}

}  // namespace shape3d::levelset
