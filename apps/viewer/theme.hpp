#pragma once

#include <QColor>

class QApplication;

namespace shape3d::apps::viewer {

/// Colours of the window and of what is drawn in it.
struct Theme {
  bool dark = true;
  QColor window, panel, field, text, faint_text, accent;
  QColor slice_background;       ///< Round slices and behind thumbnails.
  QColor scene_low, scene_high;  ///< Of 3D scenes, below and above.
  QColor error_background, error_text;
};

[[nodiscard]] Theme make_theme(bool dark);

/// Gives all widgets of the program the colours of a theme.
void apply_theme(QApplication& application, const Theme& theme);

/// Colours of the three axes across slices, as 3D Slicer has them: sagittal yellow, coronal green,
/// axial red.
[[nodiscard]] QColor axis_color(int world_axis);

/// Colours of surfaces in turn.
[[nodiscard]] QColor surface_color(int number);

}  // namespace shape3d::apps::viewer
