#pragma once

#include <string>
#include <vector>

#include <shape3d/learning/som_maps.hpp>

#include "common/raster.hpp"

namespace shape3d::apps {

/// How a map is drawn.
struct SomPictureOptions {
  int height = 1400;                ///< Of the picture, pixels; at most that.
  std::vector<std::string> labels;  ///< Of each unit; empty texts are not drawn.
  std::vector<int> groups;          ///< Of each unit for its color; -1: white.
};

/// The U-matrix and the labels of a map side by side, as in Fig. 4.6: left the distances between
/// prototypes as colors with their bar, right the units with their labels, the number of models,
/// and lines between clusters.
[[nodiscard]] Raster draw_som(const learning::SomModel& model, const SomPictureOptions& options);

}  // namespace shape3d::apps
