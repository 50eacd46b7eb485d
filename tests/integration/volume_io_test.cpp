#include "common/volume_io.hpp"

#include <unistd.h>

#include <cmath>
#include <string>
#include <type_traits>
#include <utility>

#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "common/volume_info.hpp"
#include "made_volumes.hpp"

namespace {

using namespace shape3d::apps;
using namespace shape3d::test;

using shape3d::zmc::SampleType;

/// Numbers that pass through 16 decimal digits and a few products; metres and the size of the
/// volumes.
constexpr double kPlace = 1e-9;

bool same(double a, double b, double tolerance) {
  if (std::isnan(b)) return std::isnan(a);
  if (std::isinf(b)) return a == b;
  return std::abs(a - b) <= tolerance * std::max(1.0, std::abs(b));
}

/// float32 results are compared at float precision.
void check_values(const Volume& volume, const std::vector<double>& expected) {
  const std::vector<double> values = sample_values(volume);
  REQUIRE(values.size() == expected.size());
  const double tolerance = volume.view.type == SampleType::float32 ? 1e-6 : 0.0;
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < values.size(); ++n) {
    // Scaled reals are rounded once more or less than by the other library.
    const double allowed = volume.view.type == SampleType::float64 ? 1e-14 : tolerance;
    if (!same(values[n], expected[n], allowed) && wrong++ == 0) {
      INFO("sample " << n << ": " << values[n] << ", expected " << expected[n]);
      CHECK(wrong == 0);
    }
  }
  CHECK(wrong == 0);
}

void check_good(const MadeVolumes& made, const nlohmann::json& entry) {
  INFO(entry.at("file").get<std::string>() << " " << entry.at("series").get<std::string>());
  VolumeReadOptions options;
  options.series = entry.at("series").get<std::string>();
  ConsoleCapture console;
  Volume volume;
  std::string error;
  try {
    volume = read_volume(made.folder / entry.at("file").get<std::string>(), options);
  } catch (const std::exception& caught) {
    error = caught.what();
  }
  const std::string printed = console.stop();
  CHECK(printed.empty());
  REQUIRE(error.empty());

  CHECK(volume.format == entry.at("format").get<std::string>());
  CHECK(volume.view.data == volume.samples.data());
  CHECK(to_string(volume.view.type) == entry.at("type").get<std::string>());
  REQUIRE(volume.view.dims == entry.at("dims").get<std::array<std::int64_t, 3>>());
  CHECK_NOTHROW(shape3d::zmc::validate(volume.view));
  check_values(volume, read_doubles(made.folder / entry.at("values").get<std::string>()));
  for (const auto& row : entry.at("points")) {
    const auto p = row.get<std::array<double, 6>>();
    const Eigen::Vector3d place = volume.view.world({p[0], p[1], p[2]});
    INFO("voxel " << p[0] << " " << p[1] << " " << p[2] << " at " << place.transpose());
    CHECK(same(place[0], p[3], kPlace));
    CHECK(same(place[1], p[4], kPlace));
    CHECK(same(place[2], p[5], kPlace));
  }
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(volume.view.direction.col(axis).norm() == Approx(1.0).epsilon(1e-12));
  }
  const auto& warnings = entry.at("warnings");
  REQUIRE(volume.warnings.size() == warnings.size());
  for (std::size_t n = 0; n < warnings.size(); ++n) {
    CHECK_THAT(volume.warnings[n], Catch::Contains(warnings[n].get<std::string>()));
  }
}

void check_bad(const MadeVolumes& made, const nlohmann::json& entry) {
  const std::filesystem::path path = made.folder / entry.at("file").get<std::string>();
  VolumeReadOptions options;
  options.series = entry.at("series").get<std::string>();
  INFO(path << " " << options.series);
  std::string message;
  ConsoleCapture console;
  try {
    static_cast<void>(read_volume(path, options));
  } catch (const FileError& error) {
    message = error.what();
  } catch (const std::exception& error) {
    message = std::string("not a FileError: ") + error.what();
  }
  const std::string printed = console.stop();
  CHECK(printed.empty());
  REQUIRE_FALSE(message.empty());
  // The file itself, or the one beside it that is at fault.
  CHECK_THAT(message, Catch::StartsWith(made.folder.path().string()));
  for (const auto& text : entry.at("says"))
    CHECK_THAT(message, Catch::Contains(text.get<std::string>()));
}

void check_all(const std::string& kind, std::size_t least_good, std::size_t least_bad) {
  const MadeVolumes& made = made_volumes(kind);
  const auto& good = made.expected.at("good");
  const auto& bad = made.expected.at("bad");
  CHECK(good.size() >= least_good);
  CHECK(bad.size() >= least_bad);
  for (const auto& entry : good) check_good(made, entry);
  for (const auto& entry : bad) check_bad(made, entry);
}

/// The message of the FileError that reading throws; empty when it does not.
std::string error_of(const std::filesystem::path& path, const VolumeReadOptions& options = {}) {
  try {
    static_cast<void>(read_volume(path, options));
  } catch (const FileError& error) {
    CHECK(error.path().parent_path() == path.parent_path());
    return error.what();
  }
  return {};
}

TEST_CASE("NIfTI volumes have the values and places that nibabel finds, bad ones are refused",
          "[volume]") {
  check_all("nifti", 40, 40);
}

TEST_CASE("NRRD volumes have the values and places in their headers, bad ones are refused",
          "[volume]") {
  check_all("nrrd", 60, 50);
}

TEST_CASE("MetaImage volumes have the values and places in their headers, bad ones are refused",
          "[volume]") {
  check_all("metaimage", 60, 25);
}

TEST_CASE("DICOM series have the values and places that pydicom finds, bad ones are refused",
          "[volume]") {
  check_all("dicom", 25, 35);
}

TEST_CASE("what is no volume is refused with its path", "[volume]") {
  const TemporaryFolder folder;
  CHECK_THAT(error_of(folder / "gone.nii"), Catch::Contains("gone.nii: no such file"));
  CHECK_THAT(error_of(folder / "no" / "folder.nii"), Catch::Contains("no such file"));
  CHECK_THAT(error_of("/dev/null"), Catch::Contains("expected a regular file"));
  write_bytes(folder / "mesh.ply", "ply\nformat ascii 1.0\n");
  CHECK_THAT(
      error_of(folder / "mesh.ply"),
      Catch::Contains("\".ply\"") && Catch::Contains(".nii.gz, .nrrd, .nhdr, .mha, .mhd or .vti"));
  write_bytes(folder / "mesh.vtp", "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\"></VTKFile>");
  CHECK_FALSE(detect_volume_format(folder / "mesh.vtp"));
  write_bytes(folder / "empty", "");
  CHECK_FALSE(detect_volume_format(folder / "empty"));
  write_bytes(folder / "x.raw", std::string(120, 'x'));
  CHECK_THAT(error_of(folder / "x.raw"), Catch::Contains("known format"));
}

TEST_CASE("an unreadable file is refused with the reason", "[volume]") {
  if (geteuid() == 0) {
    WARN("root reads every file: nothing to test");
    return;
  }
  const TemporaryFolder folder;
  write_bytes(folder / "x.nii", std::string(500, 'x'));
  std::filesystem::permissions(folder / "x.nii", std::filesystem::perms::none);
  CHECK_THAT(error_of(folder / "x.nii"), Catch::Contains("Permission denied"));
}

TEST_CASE("only DICOM has series", "[volume]") {
  const TemporaryFolder folder;
  write_bytes(folder / "x.nrrd", "NRRD0004\n");
  VolumeReadOptions options;
  options.series = "2";
  CHECK_THAT(error_of(folder / "x.nrrd", options), Catch::Contains("is NRRD; a series (\"2\")"));
}

TEST_CASE("a file name out of a header does not speak to the terminal", "[volume]") {
  const TemporaryFolder folder;
  write_bytes(
      folder / "x.mhd",
      "NDims = 3\nDimSize = 2 2 2\nElementType = MET_SHORT\nElementDataFile = a\x1b[31mb\x7f\n");
  const std::string error = error_of(folder / "x.mhd");
  CHECK_THAT(error, Catch::Contains("a?[31mb?: no such file"));
  CHECK(error.find('\x1b') == std::string::npos);
}

TEST_CASE("control characters do not come out in errors", "[volume]") {
  const FileError error("a\nb\x1b", "begins with \x1b[31m\x7f and lists\n  1: \u00e9\r");
  CHECK(std::string(error.what()) == "a?b?: begins with ?[31m? and lists\n  1: \u00e9?");
}

TEST_CASE("more memory than there is: the error says how much is needed and how much there is",
          "[volume]") {
  const TemporaryFolder folder;
  const std::string header = "NDims = 3\nElementSpacing = 1 1 1\nElementType = MET_SHORT\n";
  // A file with a hole, as long as its header says.
  write_bytes(folder / "huge.mhd",
              header + "DimSize = 100000 100000 100\nElementDataFile = huge.raw\n");
  write_bytes(folder / "huge.raw", "");
  std::error_code error;
  std::filesystem::resize_file(folder / "huge.raw", 2'000'000'000'000, error);
  if (error) {
    WARN("no file of 2 TB here: " << error.message());
  } else {
    CHECK_THAT(
        error_of(folder / "huge.mhd"),
        Catch::Contains("needs 1.8 TiB of memory for 100000 x 100000 x 100 int16 samples, but ") &&
            Catch::Contains("B is available"));
  }
  write_bytes(folder / "small.mha",
              header + "DimSize = 20 20 20\nElementDataFile = LOCAL\n" + std::string(16000, '\1'));
  VolumeReadOptions options;
  options.memory_limit = 15999;
  CHECK_THAT(
      error_of(folder / "small.mha", options),
      Catch::Contains(
          "needs 15.6 KiB of memory for 20 x 20 x 20 int16 samples, but 15.6 KiB is available"));
  options.memory_limit = 16000;
  CHECK(error_of(folder / "small.mha", options).empty());
}

TEST_CASE("the copy of a DICOM series counts as memory", "[volume]") {
  // 5 x 4 x 6 samples of two bytes, twice.
  VolumeReadOptions options;
  options.memory_limit = 479;
  const std::filesystem::path path = made_volumes("dicom").folder / "oblique";
  CHECK_THAT(error_of(path, options), Catch::Contains("needs 480 bytes of memory") &&
                                          Catch::Contains("479 bytes is available"));
  options.memory_limit = 480;
  CHECK(error_of(path, options).empty());
}

TEST_CASE("every beginning of a file is refused", "[volume]") {
  // Text encodings are left out: a number that lost its last digit is a number.
  const auto [kind, name, extension] = GENERATE(
      table<std::string, std::string, std::string>({{"nifti", "int16.nii", ".nii"},
                                                    {"nifti", "uint8.nii.gz", ".nii.gz"},
                                                    {"nifti", "two_int16.nii.gz", ".nii.gz"},
                                                    {"nrrd", "int16_raw_little.nrrd", ".nrrd"},
                                                    {"nrrd", "int16_gzip_big.nrrd", ".nrrd"},
                                                    {"metaimage", "int16_little_raw.mha", ".mha"},
                                                    {"metaimage", "int16_big_z.mha", ".mha"}}));
  const MadeVolumes& made = made_volumes(kind);
  const std::string bytes = read_bytes(made.folder / name);
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / ("cut" + extension);
  INFO(name);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    write_bytes(path, bytes.substr(0, length));
    INFO("the first " << length << " of " << bytes.size() << " bytes");
    REQUIRE_FALSE(error_of(path).empty());
  }
  write_bytes(path, bytes);
  CHECK(error_of(path).empty());
}

TEST_CASE("a moved volume keeps its samples and empties the other", "[volume]") {
  STATIC_REQUIRE_FALSE(std::is_copy_constructible_v<Volume>);
  Volume first = read_volume(made_volumes("nifti").folder / "int16.nii");
  const std::vector<double> values = sample_values(first);
  const void* data = first.view.data;
  Volume second = std::move(first);
  CHECK(second.view.data == data);
  CHECK(second.view.data == second.samples.data());
  CHECK(sample_values(second) == values);
  CHECK(first.view.data ==
        nullptr);  // NOLINT(bugprone-use-after-move): what a moved-from volume is.
  CHECK(first.samples.empty());
  first = std::move(second);
  CHECK(sample_values(first) == values);
  CHECK(second.view.data == nullptr);  // NOLINT(bugprone-use-after-move)
}

}  // namespace
