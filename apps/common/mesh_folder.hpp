#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shape3d::apps {

/// The files below a folder whose extensions are of meshes, in the order of their paths.
/// @throws FileError  the folder is none, cannot be looked through, or holds no mesh.
[[nodiscard]] std::vector<std::filesystem::path> meshes_below(const std::string& folder);

}  // namespace shape3d::apps
