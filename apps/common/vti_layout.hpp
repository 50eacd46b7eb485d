#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "byte_source.hpp"
#include "volume_header.hpp"

namespace shape3d::apps {

/// Smallest and largest sample index along i, j and k: i0 i1 j0 j1 k0 k1.
using Extent = std::array<std::int64_t, 6>;

/// How the samples of an array are written.
enum class VtiForm {
  text,     ///< Decimal numbers inside the tag.
  base64,   ///< Binary data inside the tag.
  appended  ///< In AppendedData.
};

/// A DataArray of the points of a piece.
struct VtiArray {
  std::string name;
  std::string type;  ///< As written: "Int16".
  std::int64_t components = 1;
  VtiForm form = VtiForm::text;
  std::uint64_t position =
      0;  ///< Of the first byte: in the file, or from the first of AppendedData.
};

struct VtiPiece {
  Extent extent{};
  std::vector<VtiArray> arrays;
};

/// The tags of a VTK XML image file.
struct VtiLayout {
  VolumeHeader header;  ///< dims, spacing, origin (of the first sample), direction, type: checked.
  Extent extent{};      ///< WholeExtent.
  std::vector<VtiPiece> pieces;
  std::string scalars;  ///< Name of the array to read.
  bool big_endian = false;
  bool compressed = false;
  std::size_t word = 4;           ///< Bytes of a length word: 4 or 8.
  bool appended_raw = false;      ///< AppendedData is there and not base64.
  std::uint64_t appended_at = 0;  ///< File position of its first byte.
};

/// Reads the tags from the beginning of a file up to the appended data and checks them. The array
/// is the one PointData calls its Scalars, or the only one.
/// @throws FileError  the tags are not well formed, the file is not an image or cut off, the
/// geometry is
///         refused by check_header(), pieces do not fill the image, no array or several to choose
///         from, several components, an unknown type.
[[nodiscard]] VtiLayout parse_vti(ByteSource& source, const std::filesystem::path& path);

}  // namespace shape3d::apps
