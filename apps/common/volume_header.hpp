#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace shape3d::apps {

/// Sample type in a file.
enum class StoredType {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

/// "int16", "uint64" … as spelled in the enumeration.
[[nodiscard]] std::string_view to_string(StoredType type);

/// Bytes of one sample.
[[nodiscard]] std::size_t sample_size(StoredType type);

/// How the samples stand in their file.
enum class Encoding {
  raw,         ///< As in memory, perhaps in the other byte order.
  compressed,  ///< The same inside a gzip or zlib stream.
  text         ///< Decimal numbers separated by white space or commas.
};

/// Where the samples are.
struct Payload {
  static constexpr std::int64_t kAtEnd = -1;

  Encoding encoding = Encoding::raw;
  bool big_endian = false;         ///< Of raw and compressed samples wider than a byte.
  std::vector<std::string> files;  ///< Relative to the header's folder, in order, equal shares;
                                   ///< empty: the header's own file.
  bool pair = false;               ///< The samples are in the .img file beside the header.
  std::int64_t line_skip = 0;      ///< Lines of each file before the data.
  std::int64_t byte_skip =
      0;  ///< Bytes after those before the data; kAtEnd: raw data are the file's end.
  std::int64_t stream_skip = 0;  ///< Decompressed bytes before the data.
};

/// What the header of a volume file says, as LPS and millimetres. Sample (i, j, k) lies at
/// origin + direction · (spacing ∘ (i, j, k)); its value is slope · stored + intercept.
struct VolumeHeader {
  std::string format;
  std::array<std::int64_t, 3> dims{0, 0, 0};
  StoredType type = StoredType::int16;
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();
  double slope = 1.0;
  double intercept = 0.0;
  Payload payload;
  std::vector<std::string> warnings;
};

/// Splits an affine into spacing (lengths of the columns) and direction (columns of unit length,
/// not necessarily orthogonal: shear stays). `columns` are the steps from sample to sample along i,
/// j and k. Unit columns are kept as they are, so that spacing (1, 1, 1) and clean matrices pass
/// exactly.
/// @throws FileError  a step is not finite or zero; the three steps lie in a plane; the origin is
/// not finite.
void set_affine(VolumeHeader& header, const Eigen::Matrix3d& columns, const Eigen::Vector3d& origin,
                const std::filesystem::path& path);

/// @throws FileError  a dimension is below 1 ("zero or negative") or exactly 1 (a volume one sample
/// thick), the
///         number of bytes does not fit 63 bits, a spacing is not finite and positive, the origin
///         or direction is not finite, the direction is singular, slope or intercept is not finite.
void check_header(const VolumeHeader& header, const std::filesystem::path& path);

/// dims product × sample size; header checked.
[[nodiscard]] std::uint64_t payload_bytes(const VolumeHeader& header);

/// "512 x 512 x 28 int16 samples", for messages.
[[nodiscard]] std::string samples_text(const std::array<std::int64_t, 3>& dims, StoredType type);

// Header parsers. `bytes` is the beginning of a file (all of it when it is shorter than
// kLongestHeader), `path` names it in messages and is not opened. They read nothing outside `bytes`
// and throw FileError for everything they do not understand; check_header() is still to be called.

constexpr std::size_t kLongestHeader = std::size_t{1} << 20;

/// NIfTI-1 and -2 (decompressed), .nii or the .hdr of a pair. RAS is turned into LPS, units into
/// millimetres. sform_code > 0: the sform; else qform_code > 0: the qform; else the voxel axes are
/// taken for R, A, S from the first sample on, with a warning. Source: nifti1.h and nifti2.h of the
/// NIfTI Data Format Working Group.
[[nodiscard]] VolumeHeader parse_nifti_header(std::string_view bytes,
                                              const std::filesystem::path& path);
/// True when the bytes begin with a NIfTI header, in either byte order.
[[nodiscard]] bool begins_like_nifti(std::string_view bytes);

/// NRRD 1 to 5, attached or detached; raw, gzip and text encodings.
/// Source: "Definition of NRRD File Format" of the Teem project.
[[nodiscard]] VolumeHeader parse_nrrd_header(std::string_view bytes,
                                             const std::filesystem::path& path);

/// MetaImage (.mha, .mhd). The rows of TransformMatrix are the volume's axes in LPS.
/// Source: the MetaIO documentation of Kitware.
[[nodiscard]] VolumeHeader parse_metaimage_header(std::string_view bytes,
                                                  const std::filesystem::path& path);

}  // namespace shape3d::apps
