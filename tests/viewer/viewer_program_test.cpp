#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

#include <catch2/catch.hpp>

#include "../integration/png_image.hpp"
#include "../integration/program_run.hpp"

namespace {
using namespace shape3d::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

// Takes a folder away when the process ends.
struct Remover {
  fs::path folder;
  ~Remover() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    fs::remove_all(folder.string() + "-moved", ignored);
  }
};

// One a process: test cases run side by side.
fs::path fresh_folder() {
  const fs::path folder =
      fs::temp_directory_path() / ("shape3d-viewer-program-test-" + std::to_string(getpid()));
  static const Remover remover{folder};
  fs::remove_all(folder);
  fs::create_directories(folder);
  make_volume(folder / "ball.mhd", {32, 32, 32}, ball(32, 10.0));
  return folder;
}

RunOptions in(const fs::path& folder) {
  RunOptions options;
  options.folder = folder;
  options.unset = {"DISPLAY", "WAYLAND_DISPLAY"};
  return options;
}

TEST_CASE("each view is drawn without a display", "[viewer][program]") {
  const fs::path folder = fresh_folder();
  for (const std::string view : {"volume", "surface", "segmentation"}) {
    const Run run =
        run_shape3d({"--offscreen", "--view", view, "-o", view + ".png", "ball.mhd"}, in(folder));
    INFO(view << ": " << run.err);
    CHECK(run.status == 0);
    CHECK(run.err.empty());
    CHECK(run.out.empty());
    const PngImage image = decode_png(slurp(folder / (view + ".png")));
    CHECK(image.width == 1280);
    CHECK(image.height == 720);
  }
  // The 3D scene of the surface shows the ball in its colour, lit: bright and warm.
  const PngImage surface = decode_png(slurp(folder / "surface.png"));
  int warm = 0;
  for (int y = 60; y < 350; ++y) {
    for (int x = 490; x < 970; ++x) {
      const auto& pixel = surface.at(x, y);
      warm += pixel[0] > 120 && pixel[0] > pixel[2] + 12 ? 1 : 0;
    }
  }
  CHECK(warm > 5000);
}

TEST_CASE("a segmentation is run and its charts are drawn without a display", "[viewer][program]") {
  const fs::path folder = fresh_folder();
  const Run run = run_shape3d(
      {"--offscreen", "--view", "segmentation", "--state",
       R"({"roi": [0, 32, 0, 32, 0, 32], "classes": "2", "run": true})", "-o", "s.png", "ball.mhd"},
      in(folder));
  INFO(run.err);
  REQUIRE(run.status == 0);
  const PngImage image = decode_png(slurp(folder / "s.png"));
  // The curve of S(w), the front in the slices.
  CHECK(image.count({0.1, 0.35, 0.9}, 0.06) > 100);
  CHECK(image.count({80 / 255.0, 160 / 255.0, 1.0}, 0.06) > 100);
}

TEST_CASE("4K pictures are drawn twice as large", "[viewer][program]") {
  const fs::path folder = fresh_folder();
  const Run run = run_shape3d(
      {"--offscreen", "--view", "volume", "--size", "3840x2160", "-o", "large.png", "ball.mhd"},
      in(folder));
  INFO(run.err);
  REQUIRE(run.status == 0);
  const PngImage image = decode_png(slurp(folder / "large.png"));
  CHECK(image.width == 3840);
  CHECK(image.height == 2160);
}

TEST_CASE("parameters and sessions reach the picture", "[viewer][program]") {
  const fs::path folder = fresh_folder();
  Run run = run_shape3d({"--offscreen", "--view", "surface", "--state", R"({"isovalue": 4})",
                         "--light", "--save-session", "s.json", "-o", "a.png", "ball.mhd"},
                        in(folder));
  INFO(run.err);
  REQUIRE(run.status == 0);
  const auto session = read_json(folder / "s.json");
  CHECK(session["view"] == "surface");
  CHECK(session["files"][0] == "ball.mhd");
  CHECK(session["dark"] == false);
  CHECK(session["views"]["surface"]["surfaces"][0]["isovalue"] == 4.0);
  run = run_shape3d({"--offscreen", "--load-session", "s.json", "-o", "b.png"}, in(folder));
  INFO(run.err);
  REQUIRE(run.status == 0);
  // The same picture, but for the milliseconds in the text.
  const PngImage a = decode_png(slurp(folder / "a.png")), b = decode_png(slurp(folder / "b.png"));
  std::size_t different = 0;
  for (std::size_t n = 0; n < a.pixels.size(); ++n) different += a.pixels[n] != b.pixels[n] ? 1 : 0;
  CHECK(different < 2000);
}

TEST_CASE("errors of the viewer are sentences with a status", "[viewer][program]") {
  const fs::path folder = fresh_folder();
  const auto check = [&folder](const std::vector<std::string>& arguments, int status,
                               const std::string& sentence) {
    const Run run = run_shape3d(arguments, in(folder));
    INFO(run.err);
    CHECK(run.status == status);
    CHECK_THAT(run.err, StartsWith("shape3d-viewer: "));
    CHECK_THAT(run.err, Contains(sentence));
    CHECK_FALSE(fs::exists(folder / "x.png"));
  };
  check({"ball.mhd"}, 1, "there is no display: DISPLAY is not set");
  check({"--offscreen", "ball.mhd"}, 2, "--offscreen needs --out");
  check({"-o", "x.png", "ball.mhd"}, 2, "--out is for --offscreen");
  check({"--offscreen", "-o", "x.jpg", "ball.mhd"}, 2, "expected a name that ends in .png");
  check({"--offscreen", "-o", "x.png", "--size", "9x9"}, 2, "--size 9x9: expected");
  check({"--offscreen", "-o", "x.png", "--view", "moon", "ball.mhd"}, 2,
        "--view moon: expected one of volume, surface, segmentation, sphere");
  check({"--offscreen", "-o", "x.png", "--state", "{", "ball.mhd"}, 2, "expected JSON");
  check({"--offscreen", "-o", "x.png", "--view", "surface", "--state", R"({"method": "mc33"})",
         "ball.mhd"},
        2, "expected zmc or flying-edges");
  check({"--offscreen", "-o", "x.png"}, 1, "Open a volume");
  check({"--offscreen", "-o", "x.png", "none.mhd"}, 1, "none.mhd: ");
  check({"--offscreen", "-o", "no/x.png", "ball.mhd"}, 1, "no/x.png");
  check({"--nonsense"}, 2, "--nonsense");
  RunOptions wrong = in(folder);
  wrong.set = {"DISPLAY=:4711"};
  const Run run = run_shape3d({"ball.mhd"}, wrong);
  CHECK(run.status == 1);
  CHECK_THAT(run.err, Contains("no window can be opened on display :4711"));
  RunOptions old = in(folder);
  old.set = {"MESA_GL_VERSION_OVERRIDE=2.1"};
  const Run early = run_shape3d({"--offscreen", "-o", "x.png", "ball.mhd"}, old);
  CHECK(early.status == 1);
  CHECK_THAT(early.err, Contains("it offers OpenGL 2.1, expected 3.2 or later"));
  // Without Xvfb: said, not crashed.
  RunOptions bare = in(folder);
  bare.set = {"PATH=/nonexistent"};
  const Run none = run_shape3d({"--offscreen", "-o", "x.png", "ball.mhd"}, bare);
  CHECK(none.status == 1);
  CHECK_THAT(none.err, Contains("Xvfb, which is not installed"));
}

}  // namespace
