#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "dicom_series.hpp"

namespace shape3d::apps {

/// The stored pixels of checked files, frame after frame as `order` says: frame k is number
/// order[k] of all frames of the files in turn. Rows from top to bottom; values as stored, host
/// byte order.
///
/// Compressed pixels are decompressed in a child process: on damaged data the decoders abort, which
/// is then an error like others.
/// @param bytes  of all frames together.
/// @throws FileError  naming `path`: VTK or GDCM cannot read a file or gives another amount.
[[nodiscard]] std::vector<std::byte> read_dicom_pixels(const std::vector<DicomFile>& files,
                                                       const std::vector<std::size_t>& order,
                                                       const std::filesystem::path& path,
                                                       std::uint64_t bytes);

}  // namespace shape3d::apps
