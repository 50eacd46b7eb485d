#pragma once

#include <string>

namespace shape3d::apps::viewer {

/// What windows are made with: VTK's format without samples, for VTK smooths edges itself and a
/// software renderer pays for each sample. Call before QApplication is made.
void set_surface_format();

/// Tries in a child process whether windows of Qt with OpenGL 3.2 can be made on the display of the
/// environment, where a failure would end the process. Call before anything of Qt, with no other
/// thread running.
/// @return the name of the renderer ("llvmpipe (LLVM 15.0.6, 256 bits)").
/// @throws PictureError  there is no display, it cannot be opened, or it has no OpenGL 3.2.
std::string require_display();

}  // namespace shape3d::apps::viewer
