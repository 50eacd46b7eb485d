#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <catch2/catch.hpp>

#include "common/label_map.hpp"
#include "common/mesh_check.hpp"
#include "common/mesh_io.hpp"
#include "common/text.hpp"
#include "common/volume_io.hpp"
#include "png_image.hpp"
#include "program_run.hpp"
#include "support/lung_phantom.hpp"
#include "support/test_data.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::test;
using Catch::Matchers::Contains;

// Turned by a quarter and mirrored: no axis stays where it is.
constexpr const char* kPlace =
    "TransformMatrix = 0 1 0 -1 0 0 0 0 -1\nOffset = 12.5 -30 700.25\nElementSpacing = 0.7 0.9 "
    "1.2\n";

// A bright ball of radius 9 mm in noise, in a volume of 40 × 36 × 30.
float ball_in_noise(int i, int j, int k) {
  const double x = 0.7 * (i - 19.5), y = 0.9 * (j - 17.5), z = 1.2 * (k - 14.5);
  const unsigned hash = (static_cast<unsigned>(i) * 73856093U) ^
                        (static_cast<unsigned>(j) * 19349663U) ^
                        (static_cast<unsigned>(k) * 83492791U);
  const double noise = 30.0 * (static_cast<double>((hash >> 5) % 1000) / 1000.0 - 0.5);
  // A border of one millimetre, as a scanner would blur it.
  const double inside = std::clamp(0.5 + (9.0 - std::sqrt(x * x + y * y + z * z)), 0.0, 1.0);
  return static_cast<float>(-800 + 850 * inside + noise);
}

float true_ball(int i, int j, int k) {
  const double x = 0.7 * (i - 19.5), y = 0.9 * (j - 17.5), z = 1.2 * (k - 14.5);
  return x * x + y * y + z * z <= 81 ? 1.0F : 0.0F;
}

Run run_in(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
  RunOptions options;
  options.folder = folder.path();
  return run_shape3d(arguments, options);
}

void make_ball(const TemporaryFolder& folder) {
  make_volume(folder / "ball.mhd", {40, 36, 30}, ball_in_noise, kPlace);
  make_volume(folder / "truth.mhd", {40, 36, 30}, true_ball, kPlace);
}

std::int64_t count(const Volume& labels) {
  const auto* data = static_cast<const std::uint8_t*>(labels.view.data);
  const auto size = labels.view.dims[0] * labels.view.dims[1] * labels.view.dims[2];
  return std::count(data, data + size, std::uint8_t{1});
}

TEST_CASE("segment: a ball, its labels, surface, distance function and report", "[segment]") {
  const TemporaryFolder folder;
  make_ball(folder);
  const Run run = run_in(folder, {"segment",    "ball.mhd", "-o",         "l.nrrd", "--classes",
                                  "2",          "--truth",  "truth.mhd",  "--psi",  "psi.nrrd",
                                  "--mesh",     "m.ply",    "--contours", "z=14",   "z.svg",
                                  "--contours", "x=20",     "x.svg",      "--json", "r.json"});
  INFO(run.out << run.err);
  REQUIRE(run.status == 0);
  CHECK(run.err.empty());
  CHECK_THAT(run.out, Contains("Dice") && Contains("calibrated level") &&
                          Contains("the front came to rest"));
  const nlohmann::json r = read_json(folder / "r.json");
  const double ball = 4.0 / 3 * kPi * 729;
  CHECK(r["status"] == "converged");
  CHECK(r["agreement"]["dice"].get<double>() > 0.97);
  CHECK(r["agreement"]["hausdorff95"].get<double>() <= 1.2);
  CHECK(r["segmentation"]["volume"].get<double>() == Approx(ball).epsilon(0.04));
  CHECK(r["segmentation"]["equivalent_diameter"].get<double>() == Approx(18).epsilon(0.02));
  CHECK(r["segmentation"]["axial_diameter"].get<double>() == Approx(18).margin(1.2));
  CHECK(r["segmentation"]["components"] == 1);
  CHECK(r["calibration"]["levels"][0].get<double>() == Approx(-375).margin(60));
  CHECK(r["model"]["classes"].size() == 2);
  CHECK(r["model"]["classes"][1]["inside"] == true);
  for (const char* key : {"histogram", "mixture", "gradient", "calibration", "speed", "evolution"})
    CHECK(r["seconds"].contains(key));

  const Volume image = read_volume(folder / "ball.mhd"), labels = read_volume(folder / "l.nrrd");
  CHECK(labels.view.type == zmc::SampleType::uint8);
  CHECK(labels.view.dims == image.view.dims);
  CHECK((labels.view.direction - image.view.direction).norm() < 1e-12);
  CHECK((labels.view.origin - image.view.origin).norm() < 1e-12);
  CHECK(count(labels) == r["segmentation"]["samples"]);

  const Volume psi = read_volume(folder / "psi.nrrd");
  CHECK(psi.view.type == zmc::SampleType::float32);
  const auto* p = static_cast<const float*>(psi.view.data);
  const auto* l = static_cast<const std::uint8_t*>(labels.view.data);
  for (std::int64_t n = 0; n < 40 * 36 * 30; ++n) REQUIRE((p[n] <= 0) == (l[n] == 1));

  // The surface is in LPS: round the place of the middle of the ball.
  const Mesh mesh = read_mesh((folder / "m.ply").string()).mesh;
  CHECK(mesh.space == "LPS");
  const MeshCheck check = check_mesh(view_of(mesh));
  CHECK(check.closed);
  CHECK(check.oriented);
  CHECK(*check.volume == Approx(ball).epsilon(0.04));
  const Eigen::Vector3d middle = mesh.V.colwise().mean().transpose();
  CHECK((middle - image.view.world({19.5, 17.5, 14.5})).norm() < 0.3);
  CHECK_THAT(slurp(folder / "z.svg"), Contains("Front at z = 14"));
  CHECK_THAT(slurp(folder / "x.svg"), Contains("Front at x = 20") && Contains("<path"));
}

TEST_CASE("segment: labels of the truth are a list, and the scope limits the calibration",
          "[segment]") {
  const TemporaryFolder folder;
  make_ball(folder);
  make_volume(
      folder / "parts.mhd", {40, 36, 30},
      [](int i, int j, int k) {
        return true_ball(i, j, k) == 0.0F ? (k < 2 ? 7.0F : 0.0F) : i < 20 ? 1.0F : 3.0F;
      },
      kPlace);
  const auto report = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"segment",   "ball.mhd", "-o",     "l.nrrd",
                                   "--classes", "2",        "--json", "r.json"};
    words.insert(words.end(), more.begin(), more.end());
    const Run run = run_in(folder, words);
    INFO(run.out << run.err);
    REQUIRE(run.status == 0);
    return read_json(folder / "r.json");
  };
  const auto dice = [](const nlohmann::json& r) { return r["agreement"]["dice"].get<double>(); };
  const double whole = dice(report({"--truth", "truth.mhd"}));
  CHECK(dice(report({"--truth", "parts.mhd", "--truth-label", "1,3"})) == whole);
  CHECK(dice(report({"--truth", "parts.mhd", "--truth-label", "1"})) ==
        Approx(2.0 / 3).margin(0.05));  // half of the ball
  CHECK(dice(report({"--truth", "parts.mhd"})) < whole - 0.05);

  // Half the level is -375: the curve stays nearer to it, in λ, the less the scope is.
  const auto width = [](const nlohmann::json& r) {
    double least = 0, most = 0;
    for (const auto& place : r["calibration"]["curve"]) {
      least = std::min(least, place["lambda"].get<double>());
      most = std::max(most, place["lambda"].get<double>());
    }
    return most - least;
  };
  const nlohmann::json wide = report({}), narrow = report({"--max-scope", "0.09"}),
                       constant = report({"--scope-constant", "1e-9"});
  CHECK(narrow["calibration"]["scope"].get<double>() == Approx(0.09));
  CHECK(width(narrow) < 0.2 * width(wide));
  CHECK(constant["calibration"]["scope"].get<double>() < 1e-6);
  CHECK(width(constant) < 1e-3 * width(wide));
}

TEST_CASE("segment: a region by indices and by millimetres is the same, labels are of full size",
          "[segment]") {
  const TemporaryFolder folder;
  make_ball(folder);
  REQUIRE(run_in(folder, {"segment", "ball.mhd", "-o", "a.mha", "--roi", "6,36,5,33,4,27",
                          "--classes", "2", "--psi", "psi.nrrd", "--json", "a.json"})
              .status == 0);
  // The region's outermost samples, in the order of the world's axes.
  const Volume image = read_volume(folder / "ball.mhd");
  const Eigen::Vector3d one = image.view.world({6, 5, 4}), other = image.view.world({35, 32, 26});
  std::string box;
  for (int axis = 0; axis < 3; ++axis) {
    box += (axis > 0 ? "," : "") + std::to_string(std::min(one[axis], other[axis])) + "," +
           std::to_string(std::max(one[axis], other[axis]));
  }
  REQUIRE(run_in(folder, {"segment", "ball.mhd", "-o", "b.mha", "--roi-mm", box, "--classes", "2",
                          "--json", "b.json"})
              .status == 0);
  CHECK(read_json(folder / "b.json")["roi"] == read_json(folder / "a.json")["roi"]);
  CHECK(slurp(folder / "a.mha") == slurp(folder / "b.mha"));
  CHECK(read_volume(folder / "a.mha").view.dims == image.view.dims);
  const Volume psi = read_volume(folder / "psi.nrrd");
  CHECK(psi.view.dims == std::array<std::int64_t, 3>{30, 28, 23});
  CHECK((psi.view.origin - one).norm() < 1e-9);
}

TEST_CASE("segment: nibabel reads the labels at the place of the volume", "[segment]") {
  const TemporaryFolder folder;
  make_ball(folder);
  REQUIRE(run_in(folder, {"segment", "ball.mhd", "-o", "l.nii.gz", "--roi", "3,38,2,35,4,29",
                          "--classes", "2", "--json", "r.json"})
              .status == 0);
  const std::string out = (folder / "nibabel.json").string();
  const std::string command = std::string("/usr/bin/python3 ") + SHAPE3D_SOURCE_FOLDER +
                              "/tests/integration/read_written_volume.py " +
                              (folder / "l.nii.gz").string() + " > " + out;
  REQUIRE(std::system(command.c_str()) == 0);  // NOLINT(cert-env33-c): names made here
  const nlohmann::json read = read_json(out);
  CHECK(read["shape"] == std::vector<int>{40, 36, 30});
  CHECK(read["type"] == "uint8");
  // kPlace in LPS; nibabel's affine is in RAS: the first two rows have the other sign.
  const double expected[3][4] = {{0, 0.9, 0, -12.5}, {-0.7, 0, 0, 30}, {0, 0, -1.2, 700.25}};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column)
      CHECK(read["affine"][row][column].get<double>() ==
            Approx(expected[row][column]).margin(1e-4));
  }
  // The samples, x fastest, are those of the ball; there are as many as the report says.
  std::int64_t inside = 0, in_both = 0;
  for (int k = 0, n = 0; k < 30; ++k) {
    for (int j = 0; j < 36; ++j) {
      for (int i = 0; i < 40; ++i, ++n) {
        const bool label = read["samples"][static_cast<std::size_t>(n)] == 1.0;
        inside += label ? 1 : 0;
        in_both += label && true_ball(i, j, k) > 0 ? 1 : 0;
      }
    }
  }
  CHECK(inside == read_json(folder / "r.json")["segmentation"]["samples"].get<std::int64_t>());
  CHECK(static_cast<double>(in_both) > 0.97 * static_cast<double>(inside));
}

TEST_CASE("segment: the component at the seed, and a start from a sphere", "[segment]") {
  const TemporaryFolder folder;
  // Two balls.
  make_volume(folder / "two.mhd", {48, 24, 24}, [](int i, int j, int k) {
    const double y = j - 11.5, z = k - 11.5;
    const double d = std::min(std::hypot(i - 11.5, y, z) - 6, std::hypot(i - 35.5, y, z) - 8);
    return static_cast<float>(100 * std::clamp(0.5 - d, 0.0, 1.0) + (i + j + k) % 3);
  });
  const std::vector<std::string> base{"segment", "two.mhd", "-o", "l.nii.gz", "--json", "r.json"};
  const auto report = [&](std::vector<std::string> more) {
    more.insert(more.begin(), base.begin(), base.end());
    if (std::find(more.begin(), more.end(), "--classes") == more.end())
      more.insert(more.end(), {"--classes", "2"});
    const Run run = run_in(folder, more);
    INFO(run.err);
    REQUIRE(run.status == 0);
    return read_json(folder / "r.json");
  };
  const double small = 4.0 / 3 * kPi * 216, large = 4.0 / 3 * kPi * 512;
  const auto volume = [](const nlohmann::json& r) {
    return r["segmentation"]["volume"].get<double>();
  };
  const nlohmann::json both = report({});
  CHECK(both["segmentation"]["components"] == 2);
  CHECK(volume(both) == Approx(small + large).epsilon(0.05));
  const nlohmann::json one = report({"--seed-point", "12,12,12", "--keep-connected"});
  CHECK(one["segmentation"]["components"] == 1);
  CHECK(volume(one) == Approx(small).epsilon(0.05));
  CHECK(volume(report({"--seed-point", "35,11,12", "--keep-connected"})) ==
        Approx(large).epsilon(0.05));
  // A sphere inside one ball grows to that ball alone, and only to it.
  const nlohmann::json sphere = report({"--seed-point", "35.5,11.5,11.5", "--radius", "3"});
  CHECK(volume(sphere) == Approx(large).epsilon(0.05));
  // The dark round the balls: a front that grows closes round them. One that starts as the box has
  // the balls inside and nothing to pass through to reach them.
  const nlohmann::json dark =
      report({"--inside", "dark", "--seed-point", "2,2,2", "--radius", "2"});
  CHECK(volume(dark) == Approx(48 * 24 * 24 - small - large).epsilon(0.02));
  CHECK(volume(report({"--inside", "0", "--seed-point", "2,2,2", "--radius", "2"})) ==
        volume(dark));
  CHECK(report({"--inside", "dark"})["status"] == "front_filled");
  const nlohmann::json automatic = report({"--classes", "auto", "--estimator", "em"});
  CHECK(automatic["model"]["bic_by_classes"].size() >= 2);
}

TEST_CASE("segment: a nodule without its vessel, with its pictures", "[segment]") {
  const TemporaryFolder folder;
  const auto distance = [](int i, int j, int k) {
    return std::hypot(i - 19.5, j - 19.5, k - 14.5) - 7;
  };
  make_volume(folder / "n.mhd", {40, 40, 30}, [&](int i, int j, int k) {
    const double d = std::min(distance(i, j, k), std::hypot(j - 19.5, k - 14.5) - 2);
    return static_cast<float>(-800 + 850 * std::clamp(0.5 - d, 0.0, 1.0) +
                              20 * ((i + 2 * j + 3 * k) % 5));
  });
  make_volume(folder / "t.mhd", {40, 40, 30},
              [&](int i, int j, int k) { return distance(i, j, k) <= 0 ? 1.0F : 0.0F; });
  const std::vector<std::string> arguments{"segment",   "n.mhd", "-o",           "l.nrrd",
                                           "--classes", "2",     "--seed-point", "20,20,15",
                                           "--truth",   "t.mhd", "--json",       "r.json"};
  REQUIRE(run_in(folder, arguments).status == 0);
  const double with_vessel = read_json(folder / "r.json")["agreement"]["dice"];
  std::vector<std::string> cut = arguments;
  cut.insert(cut.end(), {"--nodule", "--plot", "plots", "--mesh", "m.stl"});
  const Run run = run_in(folder, cut);
  INFO(run.err);
  REQUIRE(run.status == 0);
  const nlohmann::json r = read_json(folder / "r.json");
  CHECK(with_vessel < 0.92);
  CHECK(r["agreement"]["dice"].get<double>() > 0.95);
  CHECK(r["nodule"]["inscribed_radius"].get<double>() == Approx(7).margin(1));
  CHECK(check_mesh(view_of(read_mesh((folder / "m.stl").string()).mesh)).components == 1);
  CHECK(listing(folder / "plots") ==
        std::vector<std::string>{"histogram.png", "overlap.png", "slices.png"});
  const PngImage slices = decode_png(slurp(folder / "plots/slices.png"));
  CHECK(slices.count({0.1, 0.35, 0.9}) > 200);  // the segmentation, in blue
  CHECK(slices.count({0.85, 0.1, 0.1}) > 200);  // the truth, in red
  CHECK(decode_png(slurp(folder / "plots/histogram.png")).width == 1100);
}

TEST_CASE("segment: nodules of every kind by seed and radius", "[segment]") {
  const TemporaryFolder folder;
  LungPhantomOptions options;
  options.dims = {120, 136, 48};
  const LungPhantom lungs = make_lung_phantom(options);
  REQUIRE(lungs.nodules.size() >= 4);
  std::string place;
  for (const double h : lungs.spacing) place += " " + to_text(h);
  const auto write = [&](const std::string& name, const auto& samples) {
    make_volume(
        folder / name, {120, 136, 48},
        [&](int i, int j, int k) {
          return static_cast<float>(samples[static_cast<std::size_t>(i + 120 * (j + 136 * k))]);
        },
        "ElementSpacing =" + place + "\n");
  };
  write("lungs.mhd", lungs.samples);
  for (const PhantomNodule& nodule : lungs.nodules) {
    write("t.mhd", lungs.nodule(nodule));
    const Run run = run_in(
        folder, {"segment", "lungs.mhd", "-o", "l.nrrd", "--nodule", "--seed-point",
                 to_text(nodule.centre.x()) + "," + to_text(nodule.centre.y()) + "," +
                     to_text(nodule.centre.z()),
                 "--radius", to_text(nodule.radius), "--truth", "t.mhd", "--json", "r.json"});
    INFO(to_string(nodule.kind) << ", radius " << nodule.radius << ": " << run.err);
    REQUIRE(run.status == 0);
    const nlohmann::json r = read_json(folder / "r.json");
    CHECK(r["options"]["classes"] == "at the seed");
    CHECK(r["model"]["stop"] == "given");
    CHECK(r["agreement"]["dice"].get<double>() >
          (nodule.kind == NoduleKind::at_pleura ? 0.7 : 0.9));
  }
}

TEST_CASE("segment: fronts that vanish or fill the region are named, and written", "[segment]") {
  const TemporaryFolder folder;
  make_ball(folder);
  // Gradient alone, shrinking, with nothing to hold it; and a region inside the ball.
  const Run run = run_in(
      folder, {"segment", "ball.mhd", "-o", "l.nrrd", "--inside", "dark", "--classes", "2",
               "--seed-point", "20,18,15", "--radius", "2", "--mesh", "m.ply", "--json", "r.json"});
  INFO(run.out << run.err);
  CHECK(run.status == 0);
  CHECK_THAT(run.err, Contains("shape3d: warning: ball.mhd: ") && Contains("vanished"));
  const nlohmann::json r = read_json(folder / "r.json");
  CHECK(r["status"] == "front_vanished");
  CHECK(r["segmentation"]["samples"] == 0);
  CHECK_FALSE(r["warnings"].empty());
  CHECK(count(read_volume(folder / "l.nrrd")) == 0);
}

TEST_CASE("segment: the same bytes for any number of threads, and for a seed", "[segment]") {
  const TemporaryFolder folder;
  make_ball(folder);
  for (const auto& [threads, name] :
       {std::pair{"1", "a"}, std::pair{"2", "b"}, std::pair{"3", "c"}}) {
    REQUIRE(run_in(folder, {"segment", "ball.mhd", "-o", std::string(name) + ".nrrd", "--psi",
                            std::string(name) + "psi.nrrd", "--seed", "5", "--threads", threads})
                .status == 0);
  }
  for (const char* name : {"b", "c"}) {
    CHECK(slurp(folder / (std::string(name) + ".nrrd")) == slurp(folder / "a.nrrd"));
    CHECK(slurp(folder / (std::string(name) + "psi.nrrd")) == slurp(folder / "apsi.nrrd"));
  }
}

class BadInput {
 public:
  BadInput() {
    make_ball(folder_);
    make_volume(folder_ / "constant.mhd", {12, 12, 12}, [](int, int, int) { return 7.0F; });
    make_volume(folder_ / "two.mhd", {12, 12, 12},
                [](int i, int, int) { return i < 6 ? 0.0F : 1.0F; });
    make_volume(folder_ / "nan.mhd", {12, 12, 12}, [](int i, int j, int k) {
      return i == 3 && j == 4 && k == 5 ? std::nanf("") : static_cast<float>(i + j * k);
    });
    make_volume(
        folder_ / "empty.mhd", {40, 36, 30}, [](int, int, int) { return 0.0F; }, kPlace);
  }

  void expect(int status, const std::vector<std::string>& more, const std::string& sentence,
              const std::string& volume = "ball.mhd") {
    std::vector<std::string> arguments{"segment", volume};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (std::find(more.begin(), more.end(), "-o") == more.end())
      arguments.insert(arguments.end(), {"-o", "l.nrrd"});
    const std::vector<std::string> before = listing(folder_.path());
    const Run run = run_in(folder_, arguments);
    std::string command;
    for (const std::string& argument : arguments) command += " " + argument;
    INFO("shape3d" << command << "\n" << run.out << run.err);
    CHECK(run.status == status);
    CHECK_THAT(run.err, Contains(sentence));
    CHECK(run.out.empty());
    CHECK(listing(folder_.path()) == before);
  }
  [[nodiscard]] const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
};

TEST_CASE("segment: wrong command lines", "[segment][error]") {
  BadInput bad;
  bad.expect(2, {"-o", "l.vti"},
             "-o l.vti: unknown extension '.vti', expected .nrrd, .nii.gz, .nii");
  bad.expect(2, {"--roi", "0,0,0,36,0,30"},
             "--roi: x from 0 to 0 (the end is not included), expected 0 ≤ start < end ≤ 40");
  bad.expect(2, {"--roi", "30,10,0,36,0,30"}, "--roi: x from 30 to 10");
  bad.expect(2, {"--roi", "0,40,0,37,0,30"}, "--roi: y from 0 to 37");
  bad.expect(2, {"--roi", "0,40,0,36"}, "--roi");
  bad.expect(2, {"--roi-mm", "5,-5,0,10,0,10"},
             "--roi-mm: x from 5 to -5 mm, expected a finite start below a finite end");
  bad.expect(2, {"--roi-mm", "900,950,0,10,0,10"}, "--roi-mm: the box holds 0 samples of ball.mhd");
  bad.expect(2, {"--roi", "0,40,0,36,0,30", "--roi-mm", "0,1,0,1,0,1"},
             "--roi and --roi-mm are both given");
  bad.expect(2, {"--seed-point", "50,3,3", "--keep-connected"},
             "--seed-point: x is 50, outside the region, expected 0 to 39");
  bad.expect(2, {"--roi", "0,20,0,36,0,30", "--seed-point", "25,3,3", "--radius", "2"},
             "--seed-point: x is 25, outside the region, expected 0 to 19");
  bad.expect(2, {"--radius", "2"}, "--radius needs --seed-point");
  bad.expect(2, {"--seed-point", "3,3,3", "--radius", "-2"},
             "--radius -2: expected a finite positive number of millimetres");
  bad.expect(2, {"--seed-point", "3,nan,3"}, "--seed-point: expected three finite numbers");
  bad.expect(2, {"--keep-connected"}, "--keep-connected needs --seed-point");
  bad.expect(2, {"--nodule"}, "--nodule needs --seed-point");
  bad.expect(2, {"--classes", "9"}, "--classes 9: expected auto or a number from 1 to 8");
  bad.expect(2, {"--classes", "many"}, "--classes many: expected auto or a number from 1 to 8");
  bad.expect(2, {"--inside", "grey"}, "--inside grey: expected bright, dark or numbers of classes");
  bad.expect(2, {"--inside", "0,,1"}, "--inside 0,,1: expected");
  bad.expect(2, {"--curvature", "-1"}, "--curvature -1: expected a finite number of millimetres");
  bad.expect(2, {"--scope-constant", "0"}, "--scope-constant 0: expected a finite positive number");
  bad.expect(2, {"--max-scope", "0"}, "--max-scope 0: expected a share above 0 and up to 1");
  bad.expect(2, {"--max-scope", "1.5"}, "--max-scope 1.5: expected a share above 0 and up to 1");
  bad.expect(2, {"--truth", "truth.mhd", "--truth-label", "1,nan"},
             "--truth-label: expected finite numbers");
  bad.expect(2, {"--method", "magic"}, "--method");
  bad.expect(2, {"--psi", "p.mha"}, "--psi p.mha: expected a name that ends in .nrrd");
  bad.expect(2, {"--mesh", "m.xyz"}, "--mesh m.xyz: unknown extension '.xyz'");
  bad.expect(2, {"--contours", "26", "z.svg"}, "--contours 26: expected x=, y= or z= and an index");
  bad.expect(2, {"--contours", "z=14", "z.png"},
             "--contours z=14 z.png: expected a name that ends in .svg");
  bad.expect(2, {"--contours", "z=30", "z.svg"},
             "--contours z=30: outside the region, expected 0 to 29");
}

TEST_CASE("segment: volumes that hold no object to find", "[segment][error]") {
  BadInput bad;
  bad.expect(1, {}, "constant.mhd: the image is constant: there is nothing to separate",
             "constant.mhd");
  bad.expect(1, {"--classes", "3"},
             "two.mhd: the histogram has fewer occupied bins than classes were asked for",
             "two.mhd");
  bad.expect(1, {}, "nan.mhd: image: sample (3, 4, 5) is NaN; expected a finite number", "nan.mhd");
  bad.expect(1, {"--classes", "2", "--inside", "0,1"},
             "ball.mhd: all classes are on one side of the front");
  bad.expect(1, {"--classes", "2", "--inside", "5"}, "ball.mhd: ");
  bad.expect(1, {"--classes", "2", "--inside", "1,1"}, "ball.mhd: ");
  bad.expect(1, {"--truth", "two.mhd"},
             "two.mhd: has 12 x 12 x 12 samples; expected 40 x 36 x 30, as ball.mhd has");
  bad.expect(1, {"--truth", "empty.mhd"}, "empty.mhd: has no sample other than 0");
  bad.expect(1, {"--truth", "truth.mhd", "--truth-label", "4"},
             "truth.mhd: has no sample of label 4");
  bad.expect(1, {"--truth", "truth.mhd", "--truth-label", "4,7"},
             "truth.mhd: has no sample of label 4 or 7");
  bad.expect(1, {"--classes", "2", "--seed-point", "1,1,1", "--keep-connected"},
             "ball.mhd: nothing is inside within 3.6 mm of the seed point");
  bad.expect(1, {"--seed-point", "1,1,1", "--radius", "2", "--nodule"},
             "ball.mhd: what is at the seed point is not brighter than what is round it by more "
             "than the noise; expected a seed point in a nodule, or --classes");
  bad.expect(1, {"--seed-point", "20,18,15", "--nodule", "--inside", "dark"},
             "ball.mhd: what is at the seed point is not darker than");
  bad.expect(1, {}, "none.mhd: ", "none.mhd");
  bad.expect(1, {"--psi", "no/p.nrrd"}, "no/p.nrrd: ");
  bad.expect(1, {"--plot", "ball.mhd"}, "ball.mhd: cannot be made");
}

TEST_CASE("segment: spacings over 20 to 1 are a warning", "[segment]") {
  const TemporaryFolder folder;
  make_volume(
      folder / "flat.mhd", {24, 24, 8},
      [](int i, int j, int) {
        return std::hypot(i - 11.5, j - 11.5) < 7 ? 100.0F + static_cast<float>(i % 3)
                                                  : static_cast<float>(j % 3);
      },
      "ElementSpacing = 0.5 0.5 12\n");
  const Run run = run_in(folder, {"segment", "flat.mhd", "-o", "l.nrrd", "--classes", "2"});
  CHECK(run.status == 0);
  CHECK_THAT(run.err, Contains("shape3d: warning: flat.mhd: ") && Contains("20"));
}

TEST_CASE("segment: an interrupt leaves nothing half-written", "[segment][interrupt]") {
  const TemporaryFolder folder;
  LungPhantomOptions phantom;
  phantom.dims = {160, 180, 48};
  const LungPhantom lungs = make_lung_phantom(phantom);
  make_volume(folder / "lungs.mhd", {160, 180, 48}, [&](int i, int j, int k) {
    return static_cast<float>(lungs.samples[static_cast<std::size_t>(i + 160 * (j + 180 * k))]);
  });
  int interrupted = 0;
  for (const int milliseconds : {50, 150, 300, 500}) {
    RunOptions options;
    options.folder = folder.path();
    options.while_running = [milliseconds](int process) {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      kill(process, SIGINT);
    };
    const Run run =
        run_shape3d({"segment", "lungs.mhd", "-o", "l.nrrd", "--psi", "p.nrrd"}, options);
    if (run.status != 130) {
      CHECK(run.status == 0);
      std::filesystem::remove(folder / "l.nrrd");
      std::filesystem::remove(folder / "p.nrrd");
      continue;
    }
    ++interrupted;
    CHECK(listing(folder.path()) == std::vector<std::string>{"lungs.mhd", "lungs.raw"});
  }
  CHECK(interrupted > 0);
}

}  // namespace
