#pragma once

namespace shape3d::apps::viewer {

/// Parses the command line, shows the window or draws a picture.
/// @return 0, or 2 for a wrong command line, or 1 for a failure, with a sentence on standard error.
int run_viewer(int argc, char** argv);

}  // namespace shape3d::apps::viewer
