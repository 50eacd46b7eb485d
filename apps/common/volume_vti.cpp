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
#include "vti_arrays.hpp"
#include "vtk_messages.hpp"

namespace shape3d::apps {
namespace {

// The strongest compressor VTK knows gets a constant volume to about this fraction.
constexpr std::uint64_t kMostExpansion = 10000;

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
  // VTK's image and its copy.
  require_memory(path, 2 * bytes, memory_limit,
                 "reading " + samples_text(header.dims, header.type));
  if (bytes / kMostExpansion > file_bytes) {
    throw FileError(path, "is " + std::to_string(file_bytes) + " bytes long; it cannot hold the " +
                              samples_text(header.dims, header.type) + " the header says");
  }
  check_vti_arrays(layout, path);
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
