#pragma once

#include <shape3d/levelset/segment.hpp>

#include "chart.hpp"

namespace shape3d::apps {

/// H, its mixture, P_in and P_out, and the levels as estimated and as calibrated (Fig. 3.1a).
[[nodiscard]] Chart histogram_chart(const levelset::Segmentation& segmentation);

/// S(w), by the intensity of the boundary where each offset has one (Fig. 3.9).
/// @pre  segmentation.calibration.curve is not empty.
[[nodiscard]] Chart overlap_chart(const levelset::Segmentation& segmentation);

}  // namespace shape3d::apps
