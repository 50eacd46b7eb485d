#pragma once

#include <array>
#include <optional>
#include <string_view>

#include <shape3d/zmc/volume_view.hpp>

namespace shape3d::apps::viewer {

/// Which intensities are shown, as radiologists name them: from level − width/2, black, to level +
/// width/2, white.
struct Window {
  double level = 0.0;
  double width = 1.0;  ///< Positive.

  [[nodiscard]] double black() const { return level - width / 2.0; }
  [[nodiscard]] double white() const { return level + width / 2.0; }
  friend bool operator==(const Window& a, const Window& b) {
    return a.level == b.level && a.width == b.width;
  }
};

struct WindowPreset {
  std::string_view name, title;
  Window window;  ///< Hounsfield units.
};

/// The windows that CT is read with: lung, bone, soft tissue, abdomen.
inline constexpr std::array<WindowPreset, 4> kWindowPresets{
    {{"lung", "Lung", {-600.0, 1500.0}},
     {"bone", "Bone", {500.0, 2000.0}},
     {"soft-tissue", "Soft tissue", {40.0, 400.0}},
     {"abdomen", "Abdomen", {60.0, 350.0}}}};

/// By its name; empty for another word.
[[nodiscard]] std::optional<Window> window_preset(std::string_view name);

/// From the first to the 99.5th percentile of the finite samples, taken of at most about 200,000
/// samples spread evenly over the volume. A constant, or no finite sample, gives a width of 1.
/// O(1) in the size of the volume.
[[nodiscard]] Window automatic_window(const zmc::VolumeView& volume);

/// What a drag of the mouse makes of a window: right widens it, up (dy < 0) lowers the level, so
/// that the picture becomes brighter, as in 3D Slicer.
/// @param dx, dy  As shares of the side of the picture.
/// @param range   Of the intensities of the volume, which a drag over the whole side goes through.
[[nodiscard]] Window dragged(const Window& start, double dx, double dy, double range);

}  // namespace shape3d::apps::viewer
