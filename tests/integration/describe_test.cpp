#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <thread>

#include <sys/stat.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <shape3d/descriptors/descriptor.hpp>

#include "common/feature_table.hpp"
#include "common/mesh_io.hpp"
#include "mesh_families.hpp"
#include "png_image.hpp"
#include "program_run.hpp"
#include "support/test_data.hpp"

namespace {
using namespace shape3d::test;
namespace apps = shape3d::apps;
namespace fs = std::filesystem;

using Catch::Matchers::Contains;

// A folder with some meshes, in which the program runs.
class Meshes {
 public:
  Meshes() {
    options_.folder = folder_.path();
    write("cube.off", cube());
    write("torus.ply", torus(24, 12));
    write("tetrahedron.obj", tetrahedron());
  }

  void write(const std::string& name, const apps::Mesh& mesh) const {
    apps::write_mesh((folder_ / name).string(), apps::view_of(mesh));
  }
  void spill(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  Run run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "describe");
    return run_shape3d(arguments, options_);
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] apps::FeatureTable table(const std::string& name) const {
    return apps::read_features((folder_ / name).string());
  }
  RunOptions& options() { return options_; }

 private:
  TemporaryFolder folder_;
  RunOptions options_;
};

nlohmann::json read_with_python(const fs::path& table) {
  const std::string command = std::string(SHAPE3D_TEST_PYTHON) + " " + SHAPE3D_TEST_SCRIPTS +
                              "/read_features.py '" + table.string() + "'";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string text;
  char buffer[4096];
  for (std::size_t got; (got = fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    text.append(buffer, got);
  REQUIRE(pclose(pipe) == 0);
  return nlohmann::json::parse(text);
}

const std::vector<std::string> kSpecs{"hsh:K=4,voxels=32", "d2:pairs=20000,bins=16",
                                      "csm:R=4,K=3,voxels=32", "egi:K=5", "random:length=7"};

std::vector<std::string> with_specs(std::vector<std::string> arguments) {
  for (const std::string& spec : kSpecs) {
    arguments.push_back("--descriptor");
    arguments.push_back(spec);
  }
  return arguments;
}

TEST_CASE("describe writes what the library computes, in every format", "[describe]") {
  Meshes meshes;
  for (const std::string format : {"csv", "npy", "h5"}) {
    const std::string name = "table." + format;
    const Run run = meshes.run(with_specs(
        {"cube.off", "torus.ply", "tetrahedron.obj", "-o", name, "--json", format + ".json"}));
    INFO(run.out << run.err);
    REQUIRE(run.status == 0);
    CHECK(run.err.empty());
    CHECK_THAT(run.out, Contains("described") && Contains("3"));
    CHECK_FALSE(fs::exists(meshes.path(name + ".part")));
    const nlohmann::json read = read_with_python(meshes.path(name));
    CHECK(read["files"] == nlohmann::json{"cube.off", "torus.ply", "tetrahedron.obj"});
    CHECK(read["sizes"][0] == fs::file_size(meshes.path("cube.off")));
    REQUIRE(read["specs"].size() == kSpecs.size());
    for (std::size_t s = 0; s < kSpecs.size(); ++s) {
      const auto descriptor = shape3d::descriptors::Descriptor::parse(kSpecs[s]);
      CHECK(read["specs"][s] == descriptor.to_string());
      // What is stored parses back to an equal descriptor.
      CHECK_FALSE(shape3d::descriptors::Descriptor::parse(read["specs"][s].get<std::string>())
                      .difference(descriptor));
      for (std::size_t m = 0; m < 3; ++m) {
        const apps::Mesh mesh =
            apps::read_mesh(meshes.path(read["files"][m].get<std::string>()).string()).mesh;
        const Eigen::VectorXd expected = descriptor.compute(mesh.V, mesh.F);
        const auto numbers = read["vectors"][s][m].get<std::vector<double>>();
        CHECK(Eigen::Map<const Eigen::VectorXd>(
                  numbers.data(), static_cast<Eigen::Index>(numbers.size())) == expected);
      }
    }
    const nlohmann::json report = read_json(meshes.path(format + ".json"));
    CHECK(report["command"] == "describe");
    CHECK(report["meshes"] == 3);
    CHECK(report["described"] == 3);
    CHECK(report["kept"] == 0);
    CHECK(report["failed"].empty());
    CHECK(report["descriptors"][0]["length"] == 15);
  }
}

TEST_CASE("describe gives the same table for any number of threads", "[describe]") {
  Meshes meshes;
  for (const std::string threads : {"1", "3"}) {
    const Run run = meshes.run(with_specs({"cube.off", "torus.ply", "tetrahedron.obj", "-o",
                                           threads + ".npy", "--threads", threads, "--quiet"}));
    REQUIRE(run.status == 0);
    CHECK(run.out.empty());
  }
  CHECK(slurp(meshes.path("1.npy")) == slurp(meshes.path("3.npy")));
}

TEST_CASE("describe takes a list, once each", "[describe]") {
  Meshes meshes;
  meshes.spill("list.txt", "# two\n\ncube.off\r\n  torus.ply  \ncube.off\n");
  const Run run =
      meshes.run({"cube.off", "--list", "list.txt", "--descriptor", "random", "-o", "a.csv"});
  REQUIRE(run.status == 0);
  CHECK_THAT(run.err, Contains("warning: 2 meshes are named more than once"));
  REQUIRE(meshes.table("a.csv").files.size() == 2);
  CHECK(meshes.table("a.csv").files[1].path == "torus.ply");
}

TEST_CASE("describe keeps vectors of unchanged files", "[describe]") {
  Meshes meshes;
  const std::vector<std::string> all{"cube.off",     "torus.ply", "tetrahedron.obj",
                                     "--descriptor", "egi:K=5",   "-o",
                                     "a.h5",         "--json",    "report.json"};
  REQUIRE(meshes.run({"cube.off", "torus.ply", "--descriptor", "egi:K=5", "-o", "a.h5"}).status ==
          0);
  Run run = meshes.run(all);
  REQUIRE(run.status == 0);
  CHECK(read_json(meshes.path("report.json"))["kept"] == 2);
  CHECK(read_json(meshes.path("report.json"))["described"] == 1);
  CHECK_THAT(run.out, Contains("kept"));
  const apps::FeatureTable before = meshes.table("a.h5");

  // Another mesh under the same name.
  meshes.write("cube.off", torus(9, 7));
  run = meshes.run(all);
  REQUIRE(run.status == 0);
  CHECK(read_json(meshes.path("report.json"))["kept"] == 2);
  const apps::FeatureTable after = meshes.table("a.h5");
  CHECK(after.sets[0].vectors.row(0) != before.sets[0].vectors.row(0));
  CHECK(after.sets[0].vectors.row(1) == before.sets[0].vectors.row(1));

  // The same bytes at another time count as changed too.
  std::vector<std::string> again = all;
  again.push_back("--restart");
  REQUIRE(meshes.run(again).status == 0);
  CHECK(read_json(meshes.path("report.json"))["kept"] == 0);
}

TEST_CASE("describe goes on where an interrupted run ended", "[describe]") {
  Meshes meshes;
  std::string list;
  for (int i = 0; i < 60; ++i) {
    const std::string name = "m" + std::to_string(i) + ".off";
    meshes.write(name, torus(20 + i, 15));
    list += name + "\n";
  }
  meshes.spill("list.txt", list);
  const std::vector<std::string> arguments{
      "--list",    "list.txt", "--descriptor", "hsh:K=8,voxels=64", "-o", "a.h5",
      "--threads", "1",        "--json",       "report.json"};
  // Stopped once the journal holds some records: 45 numbers each.
  meshes.options().while_running = [&](int process) {
    for (int i = 0; i < 2000; ++i) {
      std::error_code none;
      const auto size = fs::file_size(meshes.path("a.h5.part"), none);
      if (!none && size > 3000) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    kill(process, SIGINT);
  };
  Run run = meshes.run(arguments);
  meshes.options().while_running = nullptr;
  REQUIRE(run.status == 130);
  CHECK_FALSE(fs::exists(meshes.path("a.h5")));
  REQUIRE(fs::exists(meshes.path("a.h5.part")));

  SECTION("whole records are kept, a broken one is not") {
    // A record that was being written.
    std::ofstream(meshes.path("a.h5.part"), std::ios::binary | std::ios::app) << "half a record";
    run = meshes.run(arguments);
    INFO(run.out << run.err);
    REQUIRE(run.status == 0);
    const nlohmann::json report = read_json(meshes.path("report.json"));
    CHECK(report["kept"] >= 3);
    CHECK(report["described"].get<int>() + report["kept"].get<int>() == 60);
    CHECK_FALSE(fs::exists(meshes.path("a.h5.part")));
    // The same as without interruption.
    std::vector<std::string> whole = arguments;
    whole[5] = "b.h5";
    REQUIRE(meshes.run(whole).status == 0);
    CHECK(meshes.table("a.h5").files == meshes.table("b.h5").files);
    CHECK(meshes.table("a.h5").sets[0].vectors == meshes.table("b.h5").sets[0].vectors);
  }
  SECTION("another descriptor is refused") {
    std::vector<std::string> other = arguments;
    other[3] = "hsh:K=9,voxels=64";
    run = meshes.run(other);
    CHECK(run.status == 1);
    CHECK_THAT(run.err,
               Contains("a.h5.part: holds vectors of 'hsh:") &&
                   Contains(": K is 8 in one and 9 in the other; --restart describes anew"));
    other.push_back("--restart");
    CHECK(meshes.run(other).status == 0);
  }
  SECTION("a second run at the same time is refused") {
    meshes.options().while_running = [&](int process) {
      for (int i = 0; i < 2000; ++i) {
        std::error_code none;
        if (fs::file_size(meshes.path("a.h5.part"), none) > 6000 && !none) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
      RunOptions second;
      second.folder = meshes.options().folder;
      std::vector<std::string> same = arguments;
      same.insert(same.begin(), "describe");
      const Run refused = run_shape3d(same, second);
      CHECK(refused.status == 1);
      CHECK_THAT(refused.err,
                 Contains("a.h5.part: is being written by another run of 'shape3d describe'"));
      kill(process, SIGINT);
    };
    CHECK(meshes.run(arguments).status == 130);
  }
}

TEST_CASE("one bad file never stops describe", "[describe]") {
  Meshes meshes;
  meshes.spill("broken.off", "OFF\n3 1 0\n0 0 0\n");
  meshes.spill("empty.off", "");
  meshes.spill("no_faces.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n");
  meshes.spill("flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
  meshes.spill("index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  meshes.spill("nan.off", "OFF\n3 1 0\n0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n");
  meshes.spill("quad.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  const std::vector<std::string> arguments{
      "cube.off", "broken.off", "empty.off",  "no_faces.off", "flat.off",     "index.off",
      "nan.off",  "quad.off",   "absent.off", "cube.stp",     "--descriptor", "hsh:K=4,voxels=16",
      "-o",       "a.h5",       "--json",     "report.json"};
  Run run = meshes.run(arguments);
  INFO(run.out << run.err);
  CHECK(run.status == 1);
  CHECK_THAT(run.err, Contains("shape3d: broken.off: ") && Contains("shape3d: empty.off: ") &&
                          Contains("shape3d: absent.off: ") && Contains("shape3d: flat.off: ") &&
                          Contains("shape3d: cube.stp: ") &&
                          Contains("shape3d: 8 of 10 meshes could not be described; --keep-going "
                                   "makes that no failure"));
  CHECK_THAT(run.err, Contains("shape3d: index.off: ") && Contains("shape3d: nan.off: "));
  // Polygons become triangles.
  CHECK_THAT(run.err, Contains("warning: quad.off: 1 faces of more than three vertices"));
  const apps::FeatureTable table = meshes.table("a.h5");
  REQUIRE(table.files.size() == 2);
  CHECK(table.files[1].path == "quad.off");
  CHECK(table.failed.size() == 8);
  const nlohmann::json report = read_json(meshes.path("report.json"));
  REQUIRE(report["failed"].size() == 8);
  CHECK(report["failed"][0]["file"] == "broken.off");
  CHECK_FALSE(report["failed"][0]["reason"].get<std::string>().empty());

  // The second run keeps the good ones and tries the others again.
  std::vector<std::string> again = arguments;
  again.push_back("--keep-going");
  run = meshes.run(again);
  CHECK(run.status == 0);
  CHECK_THAT(run.err, Contains("shape3d: broken.off: "));
  CHECK(read_json(meshes.path("report.json"))["kept"] == 2);
}

TEST_CASE("describe refuses contradictions and what it cannot write", "[describe][error]") {
  Meshes meshes;
  const auto refuses = [&](int status, const std::vector<std::string>& arguments,
                           const std::string& sentence) {
    const std::vector<std::string> before = listing(meshes.path(""));
    const Run run = meshes.run(arguments);
    std::string command;
    for (const std::string& argument : arguments) command += " " + argument;
    INFO("describe" << command << "\n" << run.out << run.err);
    CHECK(run.status == status);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(sentence));
    CHECK(run.err.rfind("shape3d: ", 0) == 0);
    CHECK(listing(meshes.path("")) == before);
  };
  refuses(2, {"cube.off", "-o", "a.csv"}, "--descriptor is required");
  refuses(2, {"cube.off", "--descriptor", "d2"}, "--output is required");
  refuses(2, {"--descriptor", "d2", "-o", "a.csv"},
          "no mesh is named, expected MESH or --list FILE");
  refuses(2, {"cube.off", "--descriptor", "d2", "-o", "a.txt"},
          "-o a.txt: expected a name that ends in .csv, .npy or .h5");
  refuses(2, {"cube.off", "--descriptor", "zernike", "-o", "a.csv"},
          "--descriptor zernike: descriptor kind is 'zernike', expected hsh, csm,");
  refuses(2, {"cube.off", "--descriptor", "hsh:Q=3", "-o", "a.csv"},
          "--descriptor hsh:Q=3: descriptor key is 'Q', expected ");
  refuses(2, {"cube.off", "--descriptor", "hsh:K=40,voxels=32", "-o", "a.csv"},
          "--descriptor hsh:K=40,voxels=32: K is 40");
  refuses(2, {"cube.off", "--descriptor", "sni:size=64,K=32", "-o", "a.csv"},
          "--descriptor sni:size=64,K=32: K is 32, expected 0 … 31, the bandwidth of 64 rows");
  refuses(2, {"cube.off", "--descriptor", "sni:size=63", "-o", "a.csv"},
          "--descriptor sni:size=63: size is 63, expected an even number of rows");
  refuses(2, {"cube.off", "--descriptor", "sci:form=roots", "-o", "a.csv"},
          "form is 'roots', which the one component of sci does not have");
  refuses(2, {"cube.off", "--descriptor", "d2", "--descriptor", "d2:bins=64", "-o", "a.csv"},
          "--descriptor d2:bins=64 is given twice");
  refuses(2, {"cube.off", "--descriptor", "d2", "-o", "a.csv", "--picture", "a.png"},
          "--picture a.png: expected with --show SPEC");
  refuses(1, {"--list", "none.txt", "--descriptor", "d2", "-o", "a.csv"}, "none.txt: ");
  meshes.spill("empty.txt", "# nothing\n");
  refuses(1, {"--list", "empty.txt", "--descriptor", "d2", "-o", "a.csv"},
          "empty.txt: names no mesh");
  refuses(1, {"cube.off", "--descriptor", "d2", "-o", "none/a.csv"}, "none/a.csv: ");
  meshes.spill("other.csv", "a,b\n1,2\n");
  refuses(1, {"cube.off", "--descriptor", "d2", "-o", "other.csv"},
          "other.csv: line 1: is not a table of 'shape3d describe': expected '# shape3d describe, "
          "version 1'; --restart overwrites it");
  meshes.spill("b.csv.part", "something else\n\n");
  refuses(1, {"cube.off", "--descriptor", "d2", "-o", "b.csv"},
          "b.csv.part: is not a journal of 'shape3d describe'; remove it to begin anew");

  REQUIRE(meshes.run({"cube.off", "--descriptor", "egi:K=4", "-o", "c.npy"}).status == 0);
  refuses(1, {"cube.off", "--descriptor", "egi:K=5", "-o", "c.npy"},
          "c.npy: holds vectors of 'egi:K=4,align=none', expected 'egi:K=5,align=none': K is 4 in "
          "one and 5 in the other; --restart describes anew");
  refuses(1, {"cube.off", "--descriptor", "egi:K=4", "--descriptor", "d2", "-o", "c.npy"},
          "c.npy: holds vectors of 1 descriptors, expected 2; --restart describes anew");
  CHECK(meshes.run({"cube.off", "--descriptor", "egi:K=5", "-o", "c.npy", "--restart"}).status ==
        0);

  refuses(2, {"--show", "d2:bins=1", "cube.off", "--picture", "a.png"},
          "--show d2:bins=1: bins is 1");
  refuses(2, {"--show", "d2", "--picture", "a.png"}, "--show is given 0 meshes, expected 1");
  refuses(2, {"--show", "d2", "cube.off", "torus.ply", "--picture", "a.png"},
          "--show is given 2 meshes, expected 1");
  refuses(2, {"--show", "d2", "cube.off"}, "--picture : expected a name that ends in .png");
  refuses(2, {"--show", "d2", "cube.off", "--picture", "a.jpg"},
          "--picture a.jpg: expected a name that ends in .png");
  refuses(2, {"--show", "d2", "cube.off", "--picture", "a.png", "-o", "a.csv"},
          "--output: not used with --show");
  refuses(2, {"--show", "d2", "cube.off", "--picture", "a.png", "--descriptor", "d2"},
          "--descriptor: not used with --show");
  refuses(2, {"--show", "d2", "cube.off", "--picture", "a.png", "--restart"},
          "--restart: not used with --show");
  meshes.spill("flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
  refuses(1, {"--show", "hsh", "flat.off", "--picture", "a.png"}, "flat.off: ");
}

TEST_CASE("describe reports a full disk", "[describe][error]") {
  Meshes meshes;
  meshes.options().file_size_limit = 4096;
  const Run run = meshes.run({"cube.off", "--descriptor", "random:length=100000", "-o", "a.csv"});
  CHECK(run.status == 1);
  CHECK_THAT(run.err, Contains("a.csv"));
  CHECK_FALSE(fs::exists(meshes.path("a.csv")));
}

TEST_CASE("describe aligns, and maps to the sphere", "[describe]") {
  Meshes meshes;
  // An ellipsoid-like body without symmetry, and the same turned.
  apps::Mesh body = bumpy_ball(18), turned = body;
  const Eigen::Matrix3d R = Eigen::Quaterniond(0.4, -0.3, 0.8, 0.2).normalized().toRotationMatrix();
  turned.V = (body.V * R.transpose() * 3.0).rowwise() + Eigen::RowVector3d(5, -2, 1);
  meshes.write("body.off", body);
  meshes.write("turned.off", turned);
  const Run run =
      meshes.run({"body.off", "turned.off", "--descriptor", "sni:form=amplitudes,K=6,align=cpca",
                  "--descriptor", "sni:form=amplitudes,K=6", "--descriptor", "sni:K=6",
                  "--descriptor", "sgi:K=6", "--descriptor", "sci:K=6", "-o", "a.npy"});
  INFO(run.out << run.err);
  REQUIRE(run.status == 0);
  const apps::FeatureTable table = meshes.table("a.npy");
  const auto change = [&](std::size_t set) {
    const auto& vectors = table.sets[set].vectors;
    return (vectors.row(0) - vectors.row(1)).norm() / vectors.row(0).norm();
  };
  CHECK(change(0) < 1e-3);  // aligned
  CHECK(change(1) > 0.1);   // amplitudes are those of the pose
  CHECK(change(2) < 0.01);  // invariants, but for the pixels
  CHECK(change(3) < 0.01);
  CHECK(change(4) < 0.01);
  CHECK(table.sets[0].vectors.cols() == 8 * 7);

  // A torus has no spherical map.
  const Run torus = meshes.run({"torus.ply", "--descriptor", "sni", "-o", "b.npy"});
  CHECK(torus.status == 1);
  CHECK_THAT(torus.err, Contains("shape3d: torus.ply: ") && Contains("genus 1"));
}

TEST_CASE("describe shows how a vector comes about", "[describe][picture]") {
  Meshes meshes;
  meshes.write("body.off", bumpy_ball(12));
  for (const std::string spec : {"hsh:K=4,voxels=32", "csm:R=4,K=4,voxels=32", "d2:pairs=10000",
                                 "egi", "random", "sni:K=8", "sci:K=8", "sgi:K=8"}) {
    const Run run =
        meshes.run({"--show", spec, "body.off", "--picture", "a.png", "--json", "a.json"});
    INFO(spec << "\n" << run.out << run.err);
    REQUIRE(run.status == 0);
    const PngImage picture = decode_png(slurp(meshes.path("a.png")));
    CHECK(picture.width >= 1440);
    CHECK(picture.height > 800);
    // The bars' blue, and not a blank page.
    CHECK(picture.count({0.1, 0.35, 0.75}) > 500);
    const nlohmann::json report = read_json(meshes.path("a.json"));
    const auto descriptor = shape3d::descriptors::Descriptor::parse(spec);
    CHECK(report["descriptor"] == descriptor.to_string());
    CHECK(static_cast<Eigen::Index>(report["vector"].size()) == descriptor.length());
    if (spec[0] == 'h' || spec[0] == 's') {
      CHECK(report["residual"] > 0.0);
      CHECK(report["residual"] < 1.0);
    }
  }
}

}  // namespace
