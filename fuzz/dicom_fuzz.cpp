// A folder of up to four DICOM files: the check of their data elements, vtk-dicom's parser behind
// it, the geometry of the slices, and the pixels (compressed ones in a child process).

#include "common/volume_formats.hpp"
#include "scratch_folder.hpp"
#include "volume_checks.hpp"

namespace {

using namespace shape3d::fuzz;

void run(const std::vector<std::string_view>& files) {
  write_scratch({"slice0", "slice1", "slice2", "slice3"}, files, 0);
  // The first series, when there are several.
  for (const char* series : {"", "1"}) {
    read_or_refuse(
        [&] { return shape3d::apps::read_dicom(scratch_folder(), series, kVolumeMemory); });
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto files = split_files(data, size);
  expect_no_exception([&] { run(files); }, "dicom");
  return 0;
}
