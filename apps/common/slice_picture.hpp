#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <shape3d/zmc/volume_view.hpp>

#include "picture.hpp"

namespace shape3d::apps {

/// Lines over a slice.
struct SliceOutline {
  std::string label;  ///< In the legend below the picture; empty: not there.
  Color color{0.1, 0.35, 0.9};
  /// Millimetres right and down from the corner of the slice, as SlicePlane::project() gives them;
  /// closed lines repeat their first point.
  std::vector<std::vector<std::array<double, 2>>> lines;
};

/// A slice of a volume in grey with outlines.
struct SlicePanel {
  std::string title;
  zmc::VolumeView volume;  ///< Borrowed.
  int axis = 2;            ///< Across the slice.
  std::int64_t slice = 0;
  double black = 0.0, white = 1.0;  ///< Intensities; linear between.
  std::vector<SliceOutline> outlines;
};

struct SlicePage {
  int columns = 3;                ///< 1 … 16.
  int width = 520, height = 560;  ///< Pixels of each panel, 128 … 4096; of all, at most 16384.
  bool private_display = false;   ///< Never the display of the environment.
};

/// Draws slices in a grid, row by row, each seen as SlicePlane sees it, as large as it fits with
/// its proportions in millimetres. Lines are 1.6 pixels wide.
/// @return PNG bytes.
/// @throws std::invalid_argument  there is no panel; a size or the number of columns is out of
///         range; axis or slice is out of range; white is not above black.
/// @throws PictureError  no display works.
[[nodiscard]] std::string draw_slices(const std::vector<SlicePanel>& panels,
                                      const SlicePage& page = {});

/// The lines in which the surface of isovalue v cuts a slice of a volume, for an outline.
/// @param whole   The volume whose slice is drawn; its place gives the corner.
/// @param volume  The samples whose contour is wanted, perhaps of a part of `whole` only.
[[nodiscard]] std::vector<std::vector<std::array<double, 2>>> outline_of(
    const zmc::VolumeView& whole, const zmc::VolumeView& volume, double isovalue, int axis,
    std::int64_t slice);

}  // namespace shape3d::apps
