#pragma once

#include <filesystem>

#include "vti_layout.hpp"

namespace shape3d::apps {

/// Checks that the array to read is there in every piece, as long as the extents say: the lengths
/// that stand before binary data, the base64 digits or bytes that follow, every number of a text.
/// (VTK fills what is missing with zeros or does not look.) Compressed data are not decoded here.
/// @throws FileError  with the length found and the length expected.
void check_vti_arrays(const VtiLayout& layout, const std::filesystem::path& path);

}  // namespace shape3d::apps
