#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <shape3d/levelset/segment.hpp>
#include <shape3d/zmc/volume_view.hpp>

#include "common/label_map.hpp"
#include "common/nodule.hpp"
#include "common/segmentation_measures.hpp"
#include "report.hpp"
#include "segment_arguments.hpp"

namespace shape3d::apps {

/// What `shape3d segment` found, for its report and plots.
struct SegmentResult {
  const SegmentArguments* arguments = nullptr;
  std::string format;      ///< Of the volume.
  zmc::VolumeView volume;  ///< Borrowed.
  Region region;
  zmc::VolumeView roi;  ///< The region of the volume.
  levelset::Segmentation segmentation;
  Mask mask;            ///< ψ ≤ 0 in the region, after --keep-connected and --nodule.
  zmc::VolumeView psi;  ///< Negative in the mask, in the place of the region.
  std::optional<Nodule> nodule;
  std::int64_t components = 0;
  MaskSize size;
  std::optional<Mask> truth;  ///< In the region.
  std::optional<SegmentationMeasures> agreement;
  MaskSize truth_size;
  std::int64_t truth_outside = 0;  ///< Samples of the truth outside the region.
  std::int64_t mesh_vertices = 0, mesh_triangles = 0;
  std::vector<std::string> warnings;
};

[[nodiscard]] Json to_json(const SegmentResult& result);
[[nodiscard]] std::string to_lines(const SegmentResult& result);

/// A picture as a PNG and its file name.
struct Plot {
  std::string name, png;
};

/// histogram.png (H, its mixture, the classes, the levels; Fig. 3.1a), overlap.png (S(w); 3.9),
/// slices.png (six slices with the contour in blue and the truth in red; Figs. 3.5, 3.6).
/// @throws PictureError
[[nodiscard]] std::vector<Plot> plot_segmentation(const SegmentResult& result);

}  // namespace shape3d::apps
