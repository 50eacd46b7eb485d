#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <shape3d/levelset/segment.hpp>
#include <shape3d/zmc/volume_view.hpp>

#include "program.hpp"

namespace shape3d::apps {

/// A plane whose contour is wanted, and where: "z=26", "out.svg".
struct ContourWish {
  int axis = 2;
  std::int64_t slice = 0;
  std::string path;
};

/// The command line of `shape3d segment`.
struct SegmentArguments {
  std::string volume, series, output;
  std::vector<std::int64_t> roi;  ///< Empty, or x0 x1 y0 y1 z0 z1, half-open.
  std::vector<double> roi_mm;  ///< Empty, or the same in LPS millimetres: the box of nodes inside.
  std::vector<double> seed;    ///< Empty, or x y z in samples of the volume.
  double radius = 0.0;         ///< mm, of the start sphere; 0: the front starts as the box.
  std::string classes;  ///< "auto", a number, or empty: 3, with --nodule the two at the seed.
  std::string inside = "bright";  ///< "bright", "dark" or "i,j,…".
  bool keep_connected = false;
  bool nodule = false;
  std::string psi, mesh, truth, plot;
  std::vector<double> truth_labels;   ///< Empty: all that is not 0.
  std::vector<std::string> contours;  ///< Pairs of plane and file.

  /// The mixture is that of the seed and what is round it, not of the region.
  [[nodiscard]] bool local_classes() const {
    return nodule && classes.empty() && (inside == "bright" || inside == "dark");
  }
  levelset::SegmentOptions options;
};

/// A region of the volume by indices, half-open.
struct Region {
  std::array<std::int64_t, 3> lower{}, upper{};
};

/// What --roi or --roi-mm says. Without either the whole volume; with --nodule and --radius R the
/// samples within 2.5 R of the seed point along each axis, and at least five of them.
/// @throws UsageError  naming the axis and the numbers: the box is empty, inverted or reaches
///         outside the volume; in millimetres, no sample lies in it.
[[nodiscard]] Region region_of(const SegmentArguments& arguments, const zmc::VolumeView& volume);

/// "z=26" and "out.svg", … by pairs.
/// @throws UsageError  another word than x=N, y=N or z=N; a file that is not .svg.
[[nodiscard]] std::vector<ContourWish> contour_wishes(const std::vector<std::string>& words);

/// Segments, measures, writes, plots and reports.
/// @throws UsageError, FileError, PictureError
void segment_volume(const SegmentArguments& arguments, const Settings& settings);

}  // namespace shape3d::apps
