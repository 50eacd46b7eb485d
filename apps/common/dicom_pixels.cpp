#include "dicom_pixels.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

#include <vtkDICOMReader.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>

#include "error.hpp"
#include "isolated.hpp"
#include "vtk_messages.hpp"

namespace shape3d::apps {
namespace {

// The library's reader does not look whether GDCM could decompress: a buffer that stays as it was
// tells.
class Reader : public vtkDICOMReader {
 public:
  static Reader* New();
  Reader(const Reader&) = delete;
  void operator=(const Reader&) = delete;

  // Files that could not be decompressed.
  [[nodiscard]] const std::string& failed() const { return failed_; }

 protected:
  Reader() = default;
  ~Reader() override = default;

  bool ReadFileDelegated(const char* name, int index, unsigned char* buffer,
                         vtkIdType size) override {
    if (!decompress(name, index, buffer, size, 0xa5)) return false;
    // Data that look like the filling do so only once.
    const auto tail = std::min<vtkIdType>(size, 16);
    const auto untouched = [&](unsigned char fill) {
      return std::all_of(buffer + size - tail, buffer + size,
                         [fill](unsigned char byte) { return byte == fill; });
    };
    if (!untouched(0xa5)) return true;
    if (!decompress(name, index, buffer, size, 0x5a)) return false;
    if (untouched(0x5a) && failed_.empty()) failed_ = name;
    return true;
  }

 private:
  bool decompress(const char* name, int index, unsigned char* buffer, vtkIdType size,
                  unsigned char fill) {
    std::fill(buffer, buffer + std::max<vtkIdType>(size, 0), fill);
    return vtkDICOMReader::ReadFileDelegated(name, index, buffer, size);
  }

  std::string failed_;
};

vtkStandardNewMacro(Reader);

// Frames of all files, in the order of the files, as VTK reads them, written to `out` in the order
// of the volume. Throws std::runtime_error with the reason.
void read_with_vtk(const std::vector<DicomFile>& files, const std::vector<std::size_t>& order,
                   std::byte* out, std::uint64_t bytes) {
  const VtkMessages messages;
  const auto names = vtkSmartPointer<vtkStringArray>::New();
  for (const DicomFile& file : files) names->InsertNextValue(file.path.string());
  const auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileNames(names);
  reader->SortingOff();
  reader->AutoRescaleOff();
  reader->AutoYBRToRGBOff();
  reader->SetMemoryRowOrderToFileNative();
  reader->Update();
  for (const std::string& error : {messages.first_error(), messages.first_gdcm_error()}) {
    if (!error.empty()) throw std::runtime_error(error);
  }
  if (!reader->failed().empty()) {
    throw std::runtime_error(std::filesystem::path(reader->failed()).filename().string() +
                             " cannot be decompressed");
  }
  if (reader->GetErrorCode() != 0) throw std::runtime_error("they are damaged");
  vtkDataArray* array = reader->GetOutput()->GetPointData()->GetScalars();
  const std::uint64_t found = array == nullptr
                                  ? 0
                                  : static_cast<std::uint64_t>(array->GetNumberOfValues()) *
                                        static_cast<std::uint64_t>(array->GetDataTypeSize());
  if (found != bytes) {
    throw std::runtime_error("they gave " + std::to_string(found) + " bytes; expected " +
                             std::to_string(bytes));
  }
  if (array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE) {
    throw std::runtime_error("they are reals; expected integers");
  }
  const std::size_t slice = bytes / order.size();
  const auto* pixels = static_cast<const std::byte*>(array->GetVoidPointer(0));
  for (std::size_t k = 0; k < order.size(); ++k) {
    std::memcpy(out + k * slice, pixels + order[k] * slice, slice);
  }
}

}  // namespace

std::vector<std::byte> read_dicom_pixels(const std::vector<DicomFile>& files,
                                         const std::vector<std::size_t>& order,
                                         const std::filesystem::path& path, std::uint64_t bytes) {
  std::vector<std::byte> data;
  std::string error;
  if (std::any_of(files.begin(), files.end(), [](const DicomFile& f) { return f.compressed; })) {
    // The decoders behind VTK's reader abort on damaged data.
    constexpr std::uint64_t kBytesPerSecond = 1000000;
    SharedBytes shared(bytes);
    error = run_isolated([&] { read_with_vtk(files, order, shared.data(), bytes); },
                         60 + bytes / kBytesPerSecond);
    if (error.empty()) data.assign(shared.data(), shared.data() + bytes);
  } else {
    data.resize(bytes);
    try {
      read_with_vtk(files, order, data.data(), bytes);
    } catch (const std::exception& caught) {
      error = caught.what();
    }
  }
  if (!error.empty()) throw FileError(path, "its pixel data cannot be read: " + error);
  return data;
}

}  // namespace shape3d::apps
