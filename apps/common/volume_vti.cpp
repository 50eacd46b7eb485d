#include <cstring>
#include <stdexcept>
#include <utility>

#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataReader.h>

#include "error.hpp"
#include "isolated.hpp"
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

// In a child process: the samples, `bytes` of them, to `out`. Throws std::runtime_error with the
// reason.
void read_with_vtk(const std::filesystem::path& path, const std::string& scalars, std::byte* out,
                   std::uint64_t bytes) {
  const VtkMessages messages;
  const auto reader = vtkSmartPointer<vtkXMLImageDataReader>::New();
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  reader->GetCellDataArraySelection()->DisableAllArrays();
  vtkDataArraySelection* arrays = reader->GetPointDataArraySelection();
  arrays->DisableAllArrays();
  arrays->EnableArray(scalars.c_str());
  reader->Update();
  const std::string error =
      messages.first_error().empty() ? messages.first_warning() : messages.first_error();
  if (!error.empty()) throw std::runtime_error(error);
  if (reader->GetErrorCode() != 0) throw std::runtime_error("its data are damaged");
  vtkDataArray* array = reader->GetOutput()->GetPointData()->GetArray(scalars.c_str());
  const std::uint64_t found = array == nullptr
                                  ? 0
                                  : static_cast<std::uint64_t>(array->GetNumberOfValues()) *
                                        static_cast<std::uint64_t>(array->GetDataTypeSize());
  if (found != bytes) {
    throw std::runtime_error("VTK found " + std::to_string(found) + " bytes of data; expected " +
                             std::to_string(bytes) + ", says the header");
  }
  std::memcpy(out, array->GetVoidPointer(0), bytes);
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
  // VTK's parser may still see the file differently, and does not look where it writes.
  constexpr std::uint64_t kBytesPerSecond = 1000000;
  std::vector<std::byte> data;
  {
    SharedBytes shared(bytes);
    const std::string error =
        run_isolated([&] { read_with_vtk(path, layout.scalars, shared.data(), bytes); },
                     60 + bytes / kBytesPerSecond);
    if (!error.empty()) throw FileError(path, "cannot be read: " + error);
    data.assign(shared.data(), shared.data() + bytes);
  }
  TypedSamples samples =
      convert_samples(std::move(data), header.type, {Scale{}}, path, memory_limit);
  return make_volume(std::move(header), std::move(samples));
}

}  // namespace shape3d::apps
