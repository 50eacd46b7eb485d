#pragma once

#include <functional>
#include <string>

#include "child_process.hpp"
#include "private_display.hpp"
#include "raster.hpp"

class vtkRenderWindow;

namespace shape3d::apps {

/// Runs a function that opens a VTK window in a child process: on the display of the environment
/// variable DISPLAY if that is set and works, on a private Xvfb otherwise. A window that cannot be
/// opened ends the child, not this process.
///
/// Only the calling thread exists in the child; VTK's own threads are off there.
/// @param private_display  never the display of the environment.
/// @return what `draw` returned.
/// @throws PictureError  no display works, or `draw` threw.
[[nodiscard]] std::string draw_offscreen(const std::function<std::string()>& draw,
                                         bool private_display = false);

/// The same on the display of this name, once.
[[nodiscard]] ChildResult draw_on(const std::string& display,
                                  const std::function<std::string()>& draw);

/// The pixels of a rendered window.
/// @param samples  A pixel of the result is the mean of samples × samples pixels of the window,
///                 whose sides are multiples of it.
[[nodiscard]] Raster raster_of(vtkRenderWindow* window, int samples = 1);

/// The same as a PNG.
[[nodiscard]] std::string png_of(vtkRenderWindow* window, int samples = 1);

}  // namespace shape3d::apps
