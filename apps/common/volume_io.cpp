#include "volume_io.hpp"

#include <exception>
#include <memory>
#include <new>
#include <system_error>
#include <utility>

#include "byte_source.hpp"
#include "error.hpp"
#include "payload.hpp"
#include "text.hpp"
#include "volume_formats.hpp"
#include "volume_header.hpp"

namespace shape3d::apps {
namespace {

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

// The first bytes of a file, decompressed when it is a gzip stream.
std::string read_decompressed_head(const std::filesystem::path& path, std::size_t count) {
  std::string bytes = read_head(path, count);
  if (!begins_like_gzip(bytes)) return bytes;
  InflateSource source(std::make_unique<FileSource>(path), path);
  bytes.assign(count, '\0');
  bytes.resize(source.read(bytes.data(), bytes.size()));
  return bytes;
}

// The beginning of a text of "Key = value" lines that holds MetaImage's required keys.
bool begins_like_metaimage(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, 4096);
  return head.find("NDims") != std::string_view::npos &&
         head.find("DimSize") != std::string_view::npos;
}

std::optional<VolumeFormat> format_by_content(std::string_view bytes) {
  if (bytes.size() >= 132 && bytes.substr(128, 4) == "DICM") return VolumeFormat::dicom;
  if (bytes.substr(0, 7) == "NRRD000") return VolumeFormat::nrrd;
  if (begins_like_nifti(bytes)) return VolumeFormat::nifti;
  const std::string_view text = trim(bytes.substr(0, 4096));
  if (text.substr(0, 1) == "<") {
    // Other VTK XML files are meshes.
    const std::size_t tag = text.find("<VTKFile");
    if (tag == std::string_view::npos) return std::nullopt;
    const std::string_view attributes = text.substr(tag, text.find('>', tag) - tag);
    if (attributes.find("ImageData") != std::string_view::npos) return VolumeFormat::vti;
    return std::nullopt;
  }
  if (begins_like_metaimage(bytes)) return VolumeFormat::metaimage;
  return std::nullopt;
}

std::optional<VolumeFormat> format_by_name(const std::filesystem::path& path) {
  const std::string name = lower_case(path.filename().string());
  for (const char* end : {".nii", ".nii.gz", ".hdr", ".hdr.gz"}) {
    if (ends_with(name, end)) return VolumeFormat::nifti;
  }
  for (const char* end : {".nrrd", ".nhdr"}) {
    if (ends_with(name, end)) return VolumeFormat::nrrd;
  }
  for (const char* end : {".mha", ".mhd"}) {
    if (ends_with(name, end)) return VolumeFormat::metaimage;
  }
  for (const char* end : {".dcm", ".ima", ".dicom"}) {
    if (ends_with(name, end)) return VolumeFormat::dicom;
  }
  if (ends_with(name, ".vti")) return VolumeFormat::vti;
  return std::nullopt;
}

// The file with the samples beside the .hdr of a pair.
std::string pair_file(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  const std::string lower = lower_case(name);
  const std::string gz = ends_with(lower, ".gz") ? name.substr(name.size() - 3) : "";
  name.resize(name.size() - gz.size());
  if (!ends_with(lower_case(name), ".hdr")) {
    throw FileError(path, "is the header of a NIfTI pair; expected its name to end in .hdr");
  }
  const bool upper = ends_with(name, ".HDR");
  const std::string stem = name.substr(0, name.size() - 4);
  const std::string image = stem + (upper ? ".IMG" : ".img");
  // Either of the two may be compressed alone.
  for (const std::string& candidate : {image + gz, image, image + ".gz"}) {
    std::error_code error;
    if (std::filesystem::exists(path.parent_path() / candidate, error)) return candidate;
  }
  return image + gz;
}

std::string expected_formats() {
  return "expected a DICOM series, .nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd or .vti";
}

Volume dispatch(const std::filesystem::path& path, const VolumeReadOptions& options) {
  const std::optional<VolumeFormat> format = detect_volume_format(path);
  if (!format) {
    const std::string extension = path.extension().string();
    throw FileError(path, "is no volume of a known format (its extension is " +
                              in_quotes(extension) + "); " + expected_formats());
  }
  if (*format != VolumeFormat::dicom && !options.series.empty()) {
    throw FileError(path, "is " + std::string(to_string(*format)) + "; a series (" +
                              in_quotes(options.series) + ") can be chosen from DICOM files only");
  }
  switch (*format) {
    case VolumeFormat::dicom:
      return read_dicom(path, options.series, options.memory_limit);
    case VolumeFormat::nifti:
      return read_nifti(path, options.memory_limit);
    case VolumeFormat::nrrd:
      return read_nrrd(path, options.memory_limit);
    case VolumeFormat::metaimage:
      return read_metaimage(path, options.memory_limit);
    case VolumeFormat::vti:
      break;
  }
  return read_vti(path, options.memory_limit);
}

}  // namespace

std::string_view to_string(VolumeFormat format) {
  switch (format) {
    case VolumeFormat::dicom:
      return "DICOM series";
    case VolumeFormat::nifti:
      return "NIfTI";
    case VolumeFormat::nrrd:
      return "NRRD";
    case VolumeFormat::metaimage:
      return "MetaImage";
    case VolumeFormat::vti:
      return "VTI";
  }
  return "unknown";
}

std::optional<VolumeFormat> detect_volume_format(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return VolumeFormat::dicom;
  constexpr std::size_t kEnough = 4096;
  const std::string bytes = read_head(path, kEnough);
  const std::optional<VolumeFormat> by_content = format_by_content(bytes);
  if (by_content) return by_content;
  const std::optional<VolumeFormat> by_name = format_by_name(path);
  if (by_name || !begins_like_gzip(bytes)) return by_name;
  try {
    if (begins_like_nifti(read_decompressed_head(path, 348))) return VolumeFormat::nifti;
  } catch (const FileError&) {
    // Damaged, and nothing says that it is a volume.
  }
  return std::nullopt;
}

Volume read_volume(const std::filesystem::path& path, const VolumeReadOptions& options) {
  try {
    return dispatch(path, options);
  } catch (const FileError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw FileError(path, "needs more memory than there is");
  } catch (const std::exception& error) {
    throw FileError(path, std::string("cannot be read: ") + error.what());
  }
}

Volume read_nifti(const std::filesystem::path& path, std::uint64_t memory_limit) {
  constexpr std::size_t kHeader = 540;
  VolumeHeader header = parse_nifti_header(read_decompressed_head(path, kHeader), path);
  const bool pair = header.payload.pair;
  if (pair) header.payload.files = {pair_file(path)};
  const std::filesystem::path data = pair ? path.parent_path() / header.payload.files[0] : path;
  if (begins_like_gzip(read_head(data, 2))) {
    header.payload.encoding = Encoding::compressed;
    header.payload.stream_skip = std::exchange(header.payload.byte_skip, 0);
  }
  return load_volume(std::move(header), path, memory_limit);
}

Volume read_nrrd(const std::filesystem::path& path, std::uint64_t memory_limit) {
  return load_volume(parse_nrrd_header(read_head(path, kLongestHeader), path), path, memory_limit);
}

Volume read_metaimage(const std::filesystem::path& path, std::uint64_t memory_limit) {
  return load_volume(parse_metaimage_header(read_head(path, kLongestHeader), path), path,
                     memory_limit);
}

}  // namespace shape3d::apps
