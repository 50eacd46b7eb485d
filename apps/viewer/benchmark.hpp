#pragma once

#include <string>

namespace shape3d::apps::viewer {

class MainWindow;

/// Measures, in a window that is shown, how fast volumes open, isosurfaces follow a dragged slider
/// and a surface of a million triangles turns, and how much memory that takes; with generated
/// volumes.
/// @param renderer  Name of the OpenGL renderer.
/// @return a table in Markdown.
[[nodiscard]] std::string measure(MainWindow& window, const std::string& renderer);

}  // namespace shape3d::apps::viewer
