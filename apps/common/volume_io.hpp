#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "volume.hpp"

namespace shape3d::apps {

enum class VolumeFormat { dicom, nifti, nrrd, metaimage, vti };

/// "DICOM series", "NIfTI", "NRRD", "MetaImage" or "VTI".
[[nodiscard]] std::string_view to_string(VolumeFormat format);

/// Format of a volume by its content and, where that says nothing, by its extension. A directory
/// counts as a DICOM series. Nothing when it is no volume that read_volume() knows.
/// @throws FileError  there is no such file or it cannot be read.
[[nodiscard]] std::optional<VolumeFormat> detect_volume_format(const std::filesystem::path& path);

struct VolumeReadOptions {
  std::string series;  ///< DICOM: SeriesInstanceUID or number in the list of series, from 1 on.
                       ///< Empty: the series of the given file, the only one of a directory.
  std::uint64_t memory_limit =
      0;  ///< Bytes that reading may use; 0: what the machine has available.
};

/// Reads a volume: a DICOM series (its directory or one of its files), NIfTI (.nii, .nii.gz,
/// .hdr/.img), NRRD (.nrrd, .nhdr), MetaImage (.mha, .mhd) or a VTK XML image (.vti).
///
/// The result is in LPS and millimetres: sample (i, j, k) lies at view.world((i, j, k)). Directions
/// have unit columns, which are not orthogonal when the file's axes are not (a tilted gantry); a
/// determinant of either sign is kept. Samples keep their type; slope and intercept are applied and
/// uint32, int64 and uint64 converted as convert_samples() says. Non-finite samples are kept:
/// describe_volume() counts them.
///
/// @throws FileError  the file is missing, unreadable, of unknown format, damaged, cut off or
/// contradicts
///         itself; a dimension is below 2; a spacing is not finite and positive; more than one
///         component or frame; a DICOM directory holds several series and none is chosen, slices
///         are missing or uneven; more memory than there is. No other exception, and nothing on the
///         console.
///
/// Memory: the samples once, twice for DICOM, VTI and while a conversion widens them.
/// Not for several threads at a time where VTK reads (DICOM, VTI).
[[nodiscard]] Volume read_volume(const std::filesystem::path& path,
                                 const VolumeReadOptions& options = {});

}  // namespace shape3d::apps
