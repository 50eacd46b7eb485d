// Damaged files are read or refused with a FileError: no crash, no other exception, no print, no
// hang.

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/dicom_elements.hpp"
#include "common/error.hpp"
#include "common/isolated.hpp"
#include "common/volume_io.hpp"
#include "made_volumes.hpp"

namespace {

using namespace shape3d::apps;
using namespace shape3d::test;

/// A few bytes of the beginning changed, lost or added.
std::string damaged(std::string bytes, unsigned seed, std::size_t beginning) {
  std::mt19937 random(seed);
  const unsigned changes = 1 + static_cast<unsigned>(random() % 5);
  for (unsigned n = 0; n < changes; ++n) {
    const std::size_t at = random() % std::min(beginning, bytes.size());
    const auto value = static_cast<char>(random() & 0xffU);
    switch (random() % 6) {
      case 0:
        bytes[at] = value;
        break;
      case 1:
        bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ (1U << random() % 8));
        break;
      case 2:
        bytes[at] = 0;
        break;
      case 3:
        bytes[at] = static_cast<char>(0xff);
        break;
      case 4:
        bytes.erase(at, 1 + random() % 4);
        break;
      default:
        bytes.insert(at, 1 + random() % 4, value);
        break;
    }
    if (bytes.empty()) break;
  }
  return bytes;
}

/// @param directory  read instead of the file; the file is in it.
void read_damaged(const std::filesystem::path& file, const std::filesystem::path& directory,
                  std::size_t beginning, unsigned count) {
  const std::string good = read_bytes(file);
  VolumeReadOptions options;
  options.memory_limit = std::uint64_t{1} << 28;
  unsigned refused = 0;
  std::string strange;
  ConsoleCapture console;
  for (unsigned seed = 0; seed < count && strange.empty(); ++seed) {
    write_bytes(file, damaged(good, seed, beginning));
    try {
      const Volume volume = read_volume(directory.empty() ? file : directory, options);
      shape3d::zmc::validate(volume.view);
    } catch (const FileError&) {
      ++refused;
    } catch (const std::exception& error) {
      strange = "seed " + std::to_string(seed) + ": " + error.what();
    }
  }
  const std::string printed = console.stop();
  write_bytes(file, good);
  CHECK(strange.empty());
  CHECK(printed.empty());
  // Most changes of a header matter.
  CHECK(refused > count / 4);
}

TEST_CASE("damaged volume files are read or refused", "[damaged]") {
  const auto [kind, name] =
      GENERATE(table<std::string, std::string>({{"nifti", "int16.nii"},
                                                {"nifti", "uint8.nii.gz"},
                                                {"nifti", "two_int16.nii.gz"},
                                                {"nrrd", "int16_raw_big.nrrd"},
                                                {"nrrd", "int16_ascii_big.nrrd"},
                                                {"nrrd", "pattern2.nhdr"},
                                                {"metaimage", "int16_big_z.mha"},
                                                {"metaimage", "pattern.mhd"}}));
  INFO(name);
  const TemporaryFolder folder;
  std::filesystem::copy(made_volumes(kind).folder / name, folder / name);
  read_damaged(folder / name, {}, 500, 1000);
}

TEST_CASE("damaged DICOM files are read or refused", "[damaged]") {
  const auto [directory, name] =
      GENERATE(table<std::string, std::string>({{"oblique", "e"},
                                                {"implicit", "02.dcm"},
                                                {"big_endian", "02.dcm"},
                                                {"rle", "02.dcm"},
                                                {"enhanced", "frames.dcm"}}));
  INFO(directory);
  const TemporaryFolder folder;
  std::filesystem::copy(made_volumes("dicom").folder / directory, folder.path());
  read_damaged(folder / name, folder.path(), 3000, 400);
}

TEST_CASE("data elements that no parser should see are named", "[damaged]") {
  const auto unknown = [](std::uint32_t) { return std::optional<bool>(); };
  // Explicit, little-endian, without a preamble: a study date.
  const std::string date(
      "\x08\x00\x20\x00"
      "DA\x08\x00"
      "20260101",
      16);
  CHECK(check_dicom_elements(date, unknown).empty());
  CHECK(check_dicom_elements("", unknown).empty());
  for (std::size_t length = 1; length < date.size(); ++length) {
    // Nothing tells the two syntaxes apart before the sixth byte.
    INFO(length);
    CHECK_THAT(check_dicom_elements(date.substr(0, length), unknown),
               Catch::Contains("is cut off"));
  }
  std::string bytes = date + date;
  bytes.replace(20, 2, "D?");
  CHECK(check_dicom_elements(bytes, unknown) ==
        "its data element (0008,0020) at byte 16 has the unknown value representation \"D?\"");
  bytes = date + std::string(
                     "\x28\x00\x10\x00"
                     "US\x03\x00"
                     "abc",
                     11);
  CHECK_THAT(check_dicom_elements(bytes, unknown),
             Catch::Contains("has 3 bytes; expected a multiple of 2"));
  bytes = date + std::string(
                     "\x00\x00\x10\x00"
                     "US\x02\x00"
                     "ab",
                     10);
  CHECK_THAT(check_dicom_elements(bytes, unknown),
             Catch::Contains("a group that data sets do not have"));
  bytes = date + std::string(
                     "\x10\x00\x00\x00"
                     "UI\x02\x00"
                     "ab",
                     10);
  CHECK_THAT(check_dicom_elements(bytes, unknown),
             Catch::Contains("is no group length of type UL"));
  // Behind pixel data: zeros, another element, what is none, and nothing where they are cut off.
  const std::string pixels(
      "\xe0\x7f\x10\x00"
      "OW\0\0\x02\0\0\0ab",
      14);
  CHECK(check_dicom_elements(date + pixels, unknown).empty());
  CHECK(check_dicom_elements(date + pixels + std::string(13, '\0'), unknown).empty());
  const std::string padding(
      "\xfc\xff\xfc\xff"
      "OB\0\0\x02\0\0\0ab",
      14);
  CHECK(check_dicom_elements(date + pixels + padding, unknown).empty());
  CHECK(check_dicom_elements(date + pixels.substr(0, 13), unknown).empty());
  CHECK_THAT(check_dicom_elements(date + pixels + std::string(20, '\xff'), unknown),
             Catch::Contains("(ffff,ffff) at byte 30"));
  CHECK_THAT(check_dicom_elements(date + pixels + padding.substr(0, 9), unknown),
             Catch::Contains("is cut off"));
  // Sequences in sequences, of no length and with no end.
  const std::string open(
      "\x08\x00\x15\x11"
      "SQ\0\0\xff\xff\xff\xff\xfe\xff\x00\xe0\xff\xff\xff\xff",
      20);
  const std::string close("\xfe\xff\x0d\xe0\0\0\0\0\xfe\xff\xdd\xe0\0\0\0\0", 16);
  const auto nested = [&](int depth) {
    std::string result = date;
    for (int n = 0; n < depth; ++n) result += open;
    for (int n = 0; n < depth; ++n) result += close;
    return result;
  };
  CHECK(check_dicom_elements(nested(1), unknown).empty());
  CHECK(check_dicom_elements(nested(32), unknown).empty());
  CHECK_THAT(check_dicom_elements(nested(33), unknown),
             Catch::Contains("nested more than 32 deep"));
  CHECK_THAT(check_dicom_elements(date + open, unknown), Catch::Contains("an item has no end"));
  CHECK_THAT(check_dicom_elements(date + open + close.substr(0, 8), unknown),
             Catch::Contains("a sequence has no end"));
  CHECK_THAT(check_dicom_elements(date + open.substr(0, 12) + date, unknown),
             Catch::Contains("stands where an item of a sequence is expected"));
  // The dictionary's word counts.
  const auto all = [](std::uint32_t) { return std::optional<bool>(true); };
  const auto none = [](std::uint32_t) { return std::optional<bool>(false); };
  CHECK_THAT(check_dicom_elements(date, all), Catch::Contains("is no sequence"));
  CHECK_THAT(check_dicom_elements(nested(1), none), Catch::Contains("is a sequence"));
}

TEST_CASE("work in a child process leaves its bytes, its errors and nothing else", "[damaged]") {
  SharedBytes shared(3);
  int mine = 1;
  const auto write = [&] {
    shared.data()[1] = std::byte{42};
    mine = 2;
  };
  CHECK(run_isolated(write, 10).empty());
  CHECK(shared.data()[1] == std::byte{42});
  CHECK(mine == 1);
  CHECK(run_isolated([] { throw std::runtime_error("a reason"); }, 10) == "a reason");
  ConsoleCapture console;
  const std::string aborted = run_isolated(
      [] {
        std::fputs("noise\n", stderr);
        std::abort();
      },
      10);
  const std::string killed = run_isolated([] { std::raise(SIGSEGV); }, 10);
  const std::string endless = run_isolated(
      [] {
        for (volatile unsigned n = 0;; n = n + 1) {
        }
      },
      1);
  CHECK(console.stop().empty());
  CHECK(aborted == "the decoder crashed (Aborted)");
  CHECK(killed == "the decoder crashed (Segmentation fault)");
  CHECK(endless == "decoding took too long");
}

}  // namespace
