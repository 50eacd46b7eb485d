#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "volume.hpp"

namespace shape3d::apps {

// One reader for each format; read_volume() says what they share.

[[nodiscard]] Volume read_nifti(const std::filesystem::path& path, std::uint64_t memory_limit);
[[nodiscard]] Volume read_nrrd(const std::filesystem::path& path, std::uint64_t memory_limit);
[[nodiscard]] Volume read_metaimage(const std::filesystem::path& path, std::uint64_t memory_limit);
[[nodiscard]] Volume read_vti(const std::filesystem::path& path, std::uint64_t memory_limit);

/// @param path    a directory, or one file of a series.
/// @param series  SeriesInstanceUID or number in the list of series from 1 on; empty: the series of
/// the
///                file, or the only one of the directory.
[[nodiscard]] Volume read_dicom(const std::filesystem::path& path, const std::string& series,
                                std::uint64_t memory_limit);

}  // namespace shape3d::apps
