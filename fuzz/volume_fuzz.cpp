// NIfTI, NRRD and MetaImage files, told apart by their content as the program does. The first file
// of an input is the header, with or without samples; the others are data files beside it.

#include "common/volume_formats.hpp"
#include "scratch_folder.hpp"
#include "volume_checks.hpp"

namespace {

using namespace shape3d::apps;
using namespace shape3d::fuzz;

void run(const std::vector<std::string_view>& files) {
  write_scratch({"input.hdr", "input.img", "data2", "data3"}, files, 0);
  const std::filesystem::path path = scratch_folder() / "input.hdr";
  read_or_refuse([&] {
    // The readers themselves: read_volume() would make a FileError of any exception.
    switch (detect_volume_format(path).value_or(VolumeFormat::nifti)) {
      case VolumeFormat::nrrd:
        return read_nrrd(path, kVolumeMemory);
      case VolumeFormat::metaimage:
        return read_metaimage(path, kVolumeMemory);
      default:
        return read_nifti(path, kVolumeMemory);
    }
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto files = split_files(data, size);
  expect_no_exception([&] { run(files); }, "volume");
  return 0;
}
