#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/volume.hpp"
#include "support/test_data.hpp"

namespace shape3d::test {

/// A folder of files that make_volumes.py wrote and its expected.json, made once in each process.
struct MadeVolumes {
  /// @param kind  "nifti", "nrrd", "metaimage" or "dicom".
  explicit MadeVolumes(const std::string& kind);

  TemporaryFolder folder;
  nlohmann::json expected;
};

/// The volumes of a kind.
const MadeVolumes& made_volumes(const std::string& kind);

/// Every sample as double, x fastest.
std::vector<double> sample_values(const apps::Volume& volume);

/// Little-endian doubles of a file.
std::vector<double> read_doubles(const std::filesystem::path& path);

/// All bytes of a file.
std::string read_bytes(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

/// What standard output and standard error of the process get while one exists goes to memory:
/// descriptors, so that libraries are heard, too.
class ConsoleCapture {
 public:
  ConsoleCapture();
  ~ConsoleCapture();
  ConsoleCapture(const ConsoleCapture&) = delete;
  ConsoleCapture& operator=(const ConsoleCapture&) = delete;

  /// Ends the capture. @return what was printed.
  std::string stop();

 private:
  int file_ = -1;
  int saved_[2] = {-1, -1};
};

}  // namespace shape3d::test
