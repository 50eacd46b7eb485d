#include <cmath>
#include <fstream>

#include <unistd.h>

#include <catch2/catch.hpp>

#include "program_run.hpp"
#include "support/test_data.hpp"

namespace {
using namespace shape3d::test;
namespace fs = std::filesystem;

using Catch::Matchers::Contains;

// Bad input ends with the status, one sentence that contains the text, and no new file.
class BadInput {
 public:
  BadInput() {
    make_volume(folder_ / "ball.mhd", {12, 12, 12}, ball(12, 4));
    options_.folder = folder_.path();
  }

  void expect(int status, const std::vector<std::string>& arguments, const std::string& sentence) {
    const std::vector<std::string> before = listing(folder_.path());
    const Run run = run_shape3d(arguments, options_);
    std::string command;
    for (const std::string& argument : arguments) command += " " + argument;
    INFO("shape3d" << command << "\n" << run.out << run.err);
    CHECK(run.status == status);
    CHECK_THAT(run.err, Contains(sentence));
    CHECK(run.err.rfind("shape3d: ", 0) == 0);
    CHECK(run.err.find("ERR|") == std::string::npos);
    CHECK(run.out.empty());
    CHECK(listing(folder_.path()) == before);
  }
  void spill(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }
  RunOptions& options() { return options_; }

 private:
  TemporaryFolder folder_;
  RunOptions options_;
};

TEST_CASE("wrong command lines: status 2", "[program][error]") {
  BadInput bad;
  bad.expect(2, {}, "subcommand is required");
  bad.expect(2, {"extrude"}, "unknown command 'extrude', expected info, extract, contours, check,");
  bad.expect(2, {"library"}, "'library' is not all of a command, expected add, list, info,");
  bad.expect(2, {"library", "ad"}, "unknown command 'ad', expected add, list, info, remove,");
  bad.expect(2, {"extract"}, "VOLUME is required");
  bad.expect(2, {"extract", "ball.mhd", "-o", "a.ply"}, "--iso is required");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "0"}, "--output is required");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "bone", "-o", "a.ply"}, "bone");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "nan", "-o", "a.ply"},
             "--iso nan: expected a finite number");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "0", "--iso", "0", "-o", "a.ply"},
             "--iso 0 is given twice");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "0", "-o", "a.xyz"},
             "-o a.xyz: unknown extension '.xyz', expected .ply, .obj, .off, .stl or .vtp");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "0", "-o", "a"}, "has no extension");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "0", "-o", "a.ply", "--picture", "a.jpg"},
             "--picture a.jpg: expected a name that ends in .png");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "0", "-o", "a.ply", "--ties", "negative"},
             "--ties");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "0", "-o", "a.ply", "--inside", "out"},
             "--inside");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "0", "-o", "a.ply", "--space", "xyz"}, "--space");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "0", "-o", "a.ply", "--threads", "-1"},
             "--threads");
  bad.expect(2, {"extract", "ball.mhd", "--iso", "0", "-o", "a.ply", "--roi", "1,2,3"}, "--roi");
  bad.expect(2,
             {"contours", "ball.mhd", "--iso", "0", "--slice", "1", "--axis", "w", "-o", "a.svg"},
             "--axis");
  bad.expect(2, {"contours", "ball.mhd", "--iso", "0", "--slice", "1", "-o", "a.png"},
             "-o a.png: expected a name that ends in .svg or .vtp");
  bad.expect(2, {"contours", "ball.mhd", "--iso", "inf", "--slice", "1", "-o", "a.svg"},
             "--iso inf: expected a finite number");
  bad.expect(2, {"compare", "ball.mhd", "--iso", "nan"}, "--iso nan: expected a finite number");
  bad.expect(2, {"render", "a.ply", "-o", "a.jpg"}, "-o a.jpg: expected a name that ends in .png");
  bad.expect(2, {"render", "a.ply", "-o", "a.png", "--size", "10"},
             "--size 10: expected WIDTHxHEIGHT in pixels, each from 16 to 8192");
  bad.expect(2, {"render", "a.ply", "-o", "a.png", "--size", "0x99999"}, "--size 0x99999");
  bad.expect(2, {"render", "a.ply", "-o", "a.png", "--view", "behind"},
             "--view behind: expected one of front, back");
  bad.expect(2, {"render", "a.ply", "-o", "a.png", "--color", "#12345"},
             "--color #12345: expected #rrggbb or one of bone");
  bad.expect(2, {"render", "a.ply", "-o", "a.png", "--color", "red", "--color", "blue"},
             "--color is given 2 times for 1 meshes");
  bad.expect(2, {"render", "a.ply", "-o", "a.png", "--opacity", "2"}, "--opacity");
  bad.expect(2, {"render", "-o", "a.png"}, "no mesh is named, expected meshes or --sheet DIR");
  bad.expect(2, {"render", "a.ply", "--sheet", "b", "-o", "a.png"},
             "expected meshes or --sheet DIR, not both");
  bad.expect(2, {"render", "--sheet", "b", "-o", "a.png", "--opacity", "0.5"},
             "--opacity: not used with --sheet");
  bad.expect(2, {"render", "--sheet", "b", "-o", "a.png", "--color", "red", "--color", "blue"},
             "--color is given 2 times; a sheet has one color");
  bad.expect(1, {"render", "--sheet", "none", "-o", "a.png"},
             "none: cannot be looked through: No such file or directory");
}

TEST_CASE("arguments that do not fit the volume: status 2", "[program][error]") {
  BadInput bad;
  const auto roi = [&bad](const std::string& box, const std::string& sentence) {
    bad.expect(2, {"extract", "ball.mhd", "--iso", "0", "-o", "a.ply", "--roi", box}, sentence);
    bad.expect(2, {"compare", "ball.mhd", "--iso", "0", "--roi", box}, sentence);
  };
  roi("0,13,0,12,0,12",
      "--roi: x from 0 to 13 (the end is not included) reaches outside the 12 samples in x, "
      "expected 0 ≤ start < end ≤ 12");
  roi("0,12,-1,12,0,12", "--roi: y from -1 to 12");
  roi("0,12,0,12,5,6",
      "--roi: z from 5 to 6 (the end is not included) holds 1 samples in z, expected 2 or more");
  roi("0,12,0,12,9,3", "holds 0 samples in z");
  bad.expect(2, {"contours", "ball.mhd", "--iso", "0", "--slice", "12", "-o", "a.svg"},
             "--slice 12: expected an index from 0 to 11 for axis z of ball.mhd");
  bad.expect(2, {"contours", "ball.mhd", "--iso", "0", "--slice", "-1", "-o", "a.svg"},
             "--slice -1");
}

TEST_CASE("volumes that cannot be read: status 1", "[program][error]") {
  BadInput bad;
  const auto extract = [&bad](const std::string& name, const std::string& sentence) {
    bad.expect(1, {"extract", name, "--iso", "0", "-o", "a.ply", "--json", "a.json"}, sentence);
    bad.expect(1, {"info", name}, sentence);
    bad.expect(1, {"contours", name, "--iso", "0", "--slice", "1", "-o", "a.svg"}, sentence);
  };
  const auto header = [](const std::string& dims, const std::string& spacing,
                         const std::string& data) {
    return "ObjectType = Image\nNDims = 3\nDimSize = " + dims + "\nElementSpacing = " + spacing +
           "\nElementType = MET_SHORT\nElementDataFile = " + data + "\n";
  };
  extract("none.mhd", "none.mhd: ");
  bad.spill("short.raw", std::string(100, '\0'));
  bad.spill("truncated.mhd", header("8 8 8", "1 1 1", "short.raw"));
  extract("truncated.mhd", "short.raw");
  bad.spill("zero.mhd", header("8 0 8", "1 1 1", "short.raw"));
  extract("zero.mhd", "zero.mhd: ");
  bad.spill("negative.mhd", header("8 -8 8", "1 1 1", "short.raw"));
  extract("negative.mhd", "negative.mhd: ");
  bad.spill("spacing.mhd", header("5 5 2", "1 0 1", "short.raw"));
  extract("spacing.mhd", "spacing.mhd: ");
  bad.spill("thin.mhd", header("5 10 1", "1 1 1", "short.raw"));
  extract("thin.mhd", "thin.mhd: ");
  bad.spill("huge.mhd", header("2000000 2000000 2000000", "1 1 1", "short.raw"));
  extract("huge.mhd", "huge.mhd: dimensions 2000000 x 2000000 x 2000000");
  bad.spill("bytes.nii.gz", "\x1f\x8b not a gzip file");
  extract("bytes.nii.gz", "bytes.nii.gz: ");
  fs::create_directory(bad.path("empty"));
  extract("empty", "empty: ");
  bad.spill("notes.txt", "hello");
  bad.expect(1, {"extract", "notes.txt", "--iso", "0", "-o", "a.ply"}, "notes.txt: ");
  bad.expect(1, {"info", "notes.txt"}, "notes.txt: is neither a volume");
  if (geteuid() != 0) {
    bad.spill("secret.mhd", header("5 5 2", "1 1 1", "short.raw"));
    fs::permissions(bad.path("secret.mhd"), fs::perms::none);
    extract("secret.mhd", "secret.mhd: ");
  }
}

TEST_CASE("meshes that cannot be read: status 1", "[program][error]") {
  BadInput bad;
  bad.expect(1, {"check", "none.ply"}, "none.ply: cannot be opened: No such file or directory");
  bad.expect(1, {"check", "none.xyz"}, "none.xyz: unknown extension '.xyz', expected .ply");
  bad.spill("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  bad.expect(1, {"check", "a.off"}, "a.off: line 6: expected a vertex index from 0 to 2, found 7");
  bad.expect(1, {"info", "a.off"}, "a.off: line 6");
  bad.expect(1, {"render", "a.off", "-o", "a.png"}, "a.off: line 6");
  bad.spill("none.off", "OFF\n0 0 0\n");
  bad.expect(1, {"render", "none.off", "-o", "a.png"}, "there is no triangle to draw");
}

TEST_CASE("output that cannot be written: status 1", "[program][error]") {
  BadInput bad;
  fs::create_symlink("/dev/full", bad.path("full.ply"));
  fs::create_symlink("/dev/full", bad.path("full.json"));
  bad.expect(1, {"extract", "ball.mhd", "--iso", "0", "-o", "no/a.ply"},
             "no/a.ply: the directory no does not exist");
  bad.expect(1, {"extract", "ball.mhd", "--iso", "0", "-o", "ball.mhd/a.ply"}, "ball.mhd/a.ply: ");
  bad.expect(1, {"extract", "ball.mhd", "--iso", "0", "-o", "full.ply"},
             "full.ply: cannot be written: No space left on device");
  bad.expect(1, {"extract", "ball.mhd", "--iso", "0", "-o", "a.ply", "--json", "full.json"},
             "full.json: cannot be written");
  bad.expect(1, {"extract", "ball.mhd", "--iso", "0", "-o", "a.ply", "--json", "no/r.json"},
             "no/r.json: the directory no does not exist");
  bad.expect(1, {"extract", "ball.mhd", "--iso", "0", "-o", "a.ply", "--picture", "no/a.png"},
             "no/a.png: ");
  bad.expect(1, {"contours", "ball.mhd", "--iso", "0", "--slice", "6", "-o", "no/a.svg"},
             "no/a.svg: the directory no does not exist");
  bad.expect(1, {"info", "ball.mhd", "--quiet", "--json", "no/a.json"}, "no/a.json: ");
  bad.options().file_size_limit = 3000;
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl", "a.vtp"}) {
    bad.expect(1, {"extract", "ball.mhd", "--iso", "0", "-o", name},
               std::string(name) + ": cannot be written");
  }
  bad.expect(1, {"extract", "ball.mhd", "--iso", "0", "--iso", "1", "-o", "a.ply"},
             "cannot be written");
}

// The address sanitizer itself takes terabytes of address space.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kAddressSpaceCanBeLimited = false;
#else
constexpr bool kAddressSpaceCanBeLimited = true;
#endif

TEST_CASE("more memory than there is: status 1, and how much is needed", "[program][error]") {
  if (!kAddressSpaceCanBeLimited) return;
  BadInput bad;
  // A sparse file of 64 GiB, as large as its header says.
  {
    std::ofstream(bad.path("large.raw")).put('\0');
    fs::resize_file(bad.path("large.raw"), std::uintmax_t{1} << 36);
  }
  bad.spill("large.mhd",
            "ObjectType = Image\nNDims = 3\nDimSize = 4096 4096 2048\nElementSpacing = 1 1 "
            "1\nElementType = MET_SHORT\n"
            "ElementDataFile = large.raw\n");
  bad.options().memory_limit = std::uint64_t{8} << 30;
  bad.expect(1, {"extract", "large.mhd", "--iso", "0", "-o", "a.ply"},
             "large.mhd: needs 64.0 GiB of memory");
}

TEST_CASE("memory that ends anywhere in a run: status 1 and a sentence, or a whole surface",
          "[program][error][memory]") {
  if (!kAddressSpaceCanBeLimited) return;
  const TemporaryFolder folder;
  const int n = 90;
  // Waves: a surface through most cells, so that each stage takes memory.
  make_volume(folder / "waves.mhd", {n, n, n}, [](int i, int j, int k) {
    return static_cast<float>(std::sin(0.9 * i) + std::sin(0.8 * j) + std::sin(0.7 * k));
  });
  const auto run_with = [&](std::uint64_t limit) {
    RunOptions options;
    options.folder = folder.path();
    options.memory_limit = limit;
    return run_shape3d({"extract", "waves.mhd", "--iso", "0.1", "--threads", "2", "-o", "a.ply"},
                       options);
  };
  // The least limit under which the program starts at all.
  constexpr std::uint64_t kStep = std::uint64_t{1} << 20;
  const auto starts_with = [&](std::uint64_t limit) {
    RunOptions options;
    options.memory_limit = limit;
    return run_shape3d({"--version"}, options).status == 0;
  };
  std::uint64_t low = kStep, high = std::uint64_t{16} << 30;
  REQUIRE(starts_with(high));
  while (high - low > kStep) {
    const std::uint64_t middle = low + (high - low) / 2;
    (starts_with(middle) ? high : low) = middle;
  }
  int refused = 0, whole = 0;
  for (std::uint64_t limit = high; whole < 3; limit += 5 * kStep) {
    REQUIRE(limit < std::uint64_t{32} << 30);
    const Run run = run_with(limit);
    INFO((limit - high) / kStep << " MiB more than the program takes to start; " << run.err);
    if (run.status == 0) {
      ++whole;
      CHECK(fs::exists(folder / "a.ply"));
      fs::remove(folder / "a.ply");
      continue;
    }
    ++refused;
    REQUIRE(run.status == 1);
    CHECK_THAT(run.err, Catch::Contains("memory"));
    CHECK(listing(folder.path()).size() == 2);  // the volume: nothing half written
  }
  CHECK(refused > 3);
}

}  // namespace
