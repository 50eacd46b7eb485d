#pragma once

#include <optional>
#include <string>

#include <shape3d/zmc/volume_view.hpp>

#include "output_file.hpp"
#include "volume_io.hpp"

namespace shape3d::apps {

/// Format to write a volume in, by the extension, in any case of letters: .nrrd, .nii.gz and .nii,
/// .mha; empty for another one.
[[nodiscard]] std::optional<VolumeFormat> written_volume_format(const std::string& path);

/// "unknown extension '.xyz', expected .nrrd, .nii.gz, .nii or .mha".
[[nodiscard]] std::string unknown_volume_extension(const std::string& path);

/// Writes samples with their whole affine; does not commit the file.
///
/// NRRD has space left-posterior-superior, space directions and origin; gzip. NIfTI-1 has the same
/// affine as sform (with scanner as its code), and as qform if the axes are orthogonal, both in
/// RAS; float32 as the format has it; gzip unless the name ends in .nii. MetaImage has
/// TransformMatrix, Offset and ElementSpacing; zlib. The numbers of text headers read back as the
/// same doubles.
/// @param view  Any strides; written x fastest, in the byte order of this machine.
/// @throws FileError  writing failed; a dimension exceeds what NIfTI-1 can hold (32767); a
///         format that is not written (DICOM, VTI).
/// @throws std::invalid_argument  validate(view) of zmc fails.
void write_volume(OutputFile& file, VolumeFormat format, const zmc::VolumeView& view);

}  // namespace shape3d::apps
