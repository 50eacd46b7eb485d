// VTI: the header and array checks in this process, VTK's reader in a child process.

#include <string>

#include "common/volume_formats.hpp"
#include "scratch_folder.hpp"
#include "volume_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace shape3d::fuzz;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::filesystem::path path = write_scratch("input.vti", bytes);
  expect_no_exception(
      [&] { read_or_refuse([&] { return shape3d::apps::read_vti(path, kVolumeMemory); }); }, "vti");
  return 0;
}
