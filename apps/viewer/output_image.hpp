#pragma once

#include <string>

class QImage;

namespace shape3d::apps::viewer {

/// Writes a picture as a PNG, whole or not at all.
/// @throws FileError  as OutputFile does.
void write_png(const std::string& path, const QImage& image);

}  // namespace shape3d::apps::viewer
