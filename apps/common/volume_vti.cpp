#include <cstring>
#include <exception>
#include <utility>

#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataReader.h>

#include "error.hpp"
#include "memory_limit.hpp"
#include "payload.hpp"
#include "text.hpp"
#include "volume_formats.hpp"
#include "vti_layout.hpp"
#include "vtk_messages.hpp"

namespace shape3d::apps {
namespace {

// The strongest compressor VTK knows gets a constant volume to about this fraction.
constexpr std::uint64_t kMostExpansion = 10000;

// Length words of an array appended as it is.
class LengthWords {
 public:
  LengthWords(const VtiLayout& layout, const std::filesystem::path& path, std::uint64_t offset)
      : layout_(layout), source_(path, offset) {}

  // False at the end of the file.
  bool next(std::uint64_t& word) {
    unsigned char bytes[8] = {};
    if (source_.read(bytes, layout_.word) < layout_.word) return false;
    word = 0;
    for (std::size_t n = 0; n < layout_.word; ++n) {
      const std::size_t from = layout_.big_endian ? n : layout_.word - 1 - n;
      word = word << 8 | bytes[from];
    }
    return true;
  }

 private:
  const VtiLayout& layout_;
  FileSource source_;
};

// Decoded and stored bytes of an appended array, by its length words.
struct StoredArray {
  std::uint64_t decoded = 0;
  std::uint64_t end = 0;  ///< File position behind it.
};

StoredArray stored_array(const VtiLayout& layout, const VtiArray& array, std::uint64_t file_bytes,
                         const std::filesystem::path& path) {
  const auto cut_off = [&] {
    return FileError(path, "is cut off: array " + in_quotes(array.name) + " begins at byte " +
                               std::to_string(layout.appended_at + array.offset) + " of " +
                               std::to_string(file_bytes));
  };
  if (array.offset > file_bytes) throw cut_off();
  const std::uint64_t start = layout.appended_at + array.offset;
  LengthWords words(layout, path, start);
  StoredArray result;
  if (!layout.compressed) {
    if (start > file_bytes || !words.next(result.decoded)) throw cut_off();
    result.end = start + layout.word + std::min(result.decoded, std::uint64_t{1} << 62);
    return result;
  }
  std::uint64_t blocks = 0;
  std::uint64_t block = 0;
  std::uint64_t last = 0;
  if (start > file_bytes || !words.next(blocks) || !words.next(block) || !words.next(last))
    throw cut_off();
  if (blocks > (file_bytes - start) / layout.word) throw cut_off();
  // Blocks are full but for the last, which is full when its size is 0.
  if (__builtin_mul_overflow(blocks, block, &result.decoded) ||
      (last > 0 && (blocks == 0 || last > block))) {
    throw FileError(path, "array " + in_quotes(array.name) + " has impossible block lengths");
  }
  if (last > 0) result.decoded -= block - last;
  result.end = start + (3 + blocks) * layout.word;
  for (std::uint64_t n = 0; n < blocks; ++n) {
    std::uint64_t size = 0;
    if (!words.next(size) || size > file_bytes) throw cut_off();
    result.end += size;
  }
  return result;
}

// Lengths of the appended arrays against the extents of their pieces and the length of the file.
void check_appended(const VtiLayout& layout, std::uint64_t file_bytes,
                    const std::filesystem::path& path) {
  for (const VtiPiece& piece : layout.pieces) {
    for (const VtiArray& array : piece.arrays) {
      if (array.name != layout.scalars || !array.appended || !layout.appended_raw) continue;
      std::uint64_t expected = sample_size(layout.header.type);
      for (std::size_t n = 0; n < 3; ++n) {
        expected *= static_cast<std::uint64_t>(piece.extent[2 * n + 1] - piece.extent[2 * n] + 1);
      }
      const StoredArray stored = stored_array(layout, array, file_bytes, path);
      if (stored.decoded != expected) {
        throw FileError(path, "array " + in_quotes(array.name) + " holds " +
                                  std::to_string(stored.decoded) + " bytes; expected " +
                                  std::to_string(expected) + ", says the extent");
      }
      if (stored.end > file_bytes) {
        throw FileError(path, "is cut off: array " + in_quotes(array.name) + " ends at byte " +
                                  std::to_string(stored.end) + "; the file has " +
                                  std::to_string(file_bytes) + " bytes");
      }
    }
  }
}

vtkSmartPointer<vtkImageData> read_with_vtk(const std::filesystem::path& path,
                                            const VtiLayout& layout) {
  const VtkMessages messages;
  const auto reader = vtkSmartPointer<vtkXMLImageDataReader>::New();
  reader->SetFileName(path.c_str());
  try {
    reader->UpdateInformation();
    reader->GetCellDataArraySelection()->DisableAllArrays();
    vtkDataArraySelection* arrays = reader->GetPointDataArraySelection();
    arrays->DisableAllArrays();
    arrays->EnableArray(layout.scalars.c_str());
    reader->Update();
  } catch (const std::exception& error) {
    throw FileError(path, std::string("cannot be read: ") + error.what());
  }
  const std::string error =
      messages.first_error().empty() ? messages.first_warning() : messages.first_error();
  if (!error.empty()) throw FileError(path, "cannot be read: " + error);
  if (reader->GetErrorCode() != 0) throw FileError(path, "cannot be read: its data are damaged");
  return reader->GetOutput();
}

}  // namespace

Volume read_vti(const std::filesystem::path& path, std::uint64_t memory_limit) {
  const std::uint64_t file_bytes = readable_size(path);
  VtiLayout layout;
  {
    FileSource source(path);
    layout = parse_vti(source, path);
  }
  VolumeHeader& header = layout.header;
  const std::uint64_t bytes = payload_bytes(header);
  check_appended(layout, file_bytes, path);
  // VTK's image and its copy.
  require_memory(path, 2 * bytes, memory_limit,
                 "reading " + samples_text(header.dims, header.type));
  if (bytes / kMostExpansion > file_bytes) {
    throw FileError(path, "is " + std::to_string(file_bytes) + " bytes long; it cannot hold the " +
                              samples_text(header.dims, header.type) + " the header says");
  }
  vtkSmartPointer<vtkImageData> image = read_with_vtk(path, layout);
  vtkDataArray* array = image->GetPointData()->GetArray(layout.scalars.c_str());
  const std::uint64_t found = array == nullptr
                                  ? 0
                                  : static_cast<std::uint64_t>(array->GetNumberOfValues()) *
                                        static_cast<std::uint64_t>(array->GetDataTypeSize());
  if (found != bytes) {
    throw FileError(path, "holds " + std::to_string(found) + " bytes of data; expected " +
                              std::to_string(bytes) + ", says the header");
  }
  std::vector<std::byte> data(bytes);
  std::memcpy(data.data(), array->GetVoidPointer(0), bytes);
  image = nullptr;
  TypedSamples samples =
      convert_samples(std::move(data), header.type, {Scale{}}, path, memory_limit);
  return make_volume(std::move(header), std::move(samples));
}

}  // namespace shape3d::apps
