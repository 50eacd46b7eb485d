#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <set>
#include <thread>

#include <catch2/catch.hpp>

#include "common/mesh_check.hpp"
#include "common/mesh_io.hpp"
#include "common/picture.hpp"
#include "png_image.hpp"
#include "program_run.hpp"
#include "support/test_data.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::test;
namespace fs = std::filesystem;

using Catch::Matchers::Contains;
constexpr double kPi = 3.141592653589793;

Run run_in(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
  RunOptions options;
  options.folder = folder.path();
  const Run run = run_shape3d(arguments, options);
  INFO(run.out << run.err);
  CHECK(run.err.find("ERR|") == std::string::npos);  // VTK's log
  return run;
}

Mesh mesh_in(const TemporaryFolder& folder, const std::string& name) {
  return read_mesh((folder / name).string()).mesh;
}

std::multiset<std::array<int, 3>> unordered_triangles(const Mesh& mesh) {
  std::multiset<std::array<int, 3>> triangles;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    std::array<int, 3> f{mesh.F(t, 0), mesh.F(t, 1), mesh.F(t, 2)};
    std::sort(f.begin(), f.end());
    triangles.insert(f);
  }
  return triangles;
}

// -1, 0 and 1 in no order.
float scattered(int i, int j, int k) {
  const unsigned hash = (static_cast<unsigned>(i) * 73856093U) ^
                        (static_cast<unsigned>(j) * 19349663U) ^
                        (static_cast<unsigned>(k) * 83492791U);
  return static_cast<float>((hash >> 7) % 3) - 1.0F;
}

TEST_CASE("help and version", "[program]") {
  const Run version = run_shape3d({"--version"});
  CHECK(version.status == 0);
  CHECK_THAT(version.out, Catch::Matchers::StartsWith("shape3d 0."));
  for (const char* command :
       {"info", "extract", "contours", "check", "render", "compare", "segment", "describe", "map",
        "align", "repair", "simplify", "wrap"}) {
    INFO(command);
    const Run help = run_shape3d({command, "--help"});
    CHECK(help.status == 0);
    CHECK(help.err.empty());
    CHECK_THAT(help.out, Contains("Examples:") && Contains(std::string("shape3d ") + command) &&
                             Contains("--quiet") && Contains("--threads") && Contains("--json"));
  }
  CHECK_THAT(run_shape3d({"--help"}).out, Contains("extract") && Contains("Examples:"));
}

TEST_CASE("the README shows the program that is built, and commands that parse",
          "[program][readme]") {
  const fs::path source = SHAPE3D_SOURCE_FOLDER;
  const std::string readme = slurp(source / "README.md");
  CHECK_THAT(readme, Contains("```cpp\n" + slurp(source / "docs/examples/ball.cpp") + "```"));
  for (const char* command : {"info", "extract", "contours", "check", "render", "compare"}) {
    CHECK_THAT(readme, Contains(std::string("\nshape3d ") + command + " "));
  }
}

TEST_CASE("a ball: area, volume and the keys of the report", "[program][extract]") {
  const TemporaryFolder folder;
  make_volume(folder / "ball.mhd", {40, 40, 40}, ball(40, 15));
  const Run run =
      run_in(folder, {"extract", "ball.mhd", "--iso", "0", "-o", "ball.ply", "--json", "r.json"});
  CHECK(run.status == 0);
  CHECK(run.err.empty());
  CHECK_THAT(run.out,
             Contains("closed                  yes") && Contains("genus                   0"));
  const nlohmann::json report = read_json(folder / "r.json");
  for (const char* key :
       {"vertices", "triangles", "zero_faces", "odd_interior_edges", "nonmanifold_edges",
        "degenerate_triangles", "duplicate_triangles", "components", "seconds", "face_case_shares",
        "zero_vertices", "area", "volume", "coincident_vertices", "surfaces", "isovalue", "output",
        "input", "options"}) {
    INFO(key);
    CHECK(report.contains(key));
  }
  for (const char* stage : {"read", "classify", "count", "generate", "extract", "check", "write"}) {
    INFO(stage);
    CHECK(report["seconds"].contains(stage));
  }
  CHECK(report["components"] == 1);
  CHECK(report["genus"] == 0);
  CHECK(report["odd_interior_edges"] == 0);
  // The distance function is exact, so the error is that of linear interpolation: second order in
  // 1/r.
  CHECK(report["volume"].get<double>() == Approx(4.0 / 3 * kPi * 15 * 15 * 15).epsilon(4e-3));
  CHECK(report["area"].get<double>() == Approx(4 * kPi * 15 * 15).epsilon(4e-3));
  double shares = 0.0;
  for (const auto& share : report["face_case_shares"]) shares += share.get<double>();
  CHECK(shares == Approx(100.0));
  const MeshCheck check = check_mesh(view_of(mesh_in(folder, "ball.ply")));
  CHECK(check.vertices == report["vertices"]);
  CHECK(check.triangles == report["triangles"]);
  CHECK(*check.volume == report["volume"].get<double>());
}

TEST_CASE("every format holds the same surface, and says LPS", "[program][extract]") {
  const TemporaryFolder folder;
  make_volume(folder / "ball.mhd", {24, 24, 24}, ball(24, 8.3));
  Mesh first;
  for (const char* name : {"b.ply", "b.obj", "b.off", "b.vtp", "b.stl"}) {
    INFO(name);
    CHECK(run_in(folder, {"extract", "ball.mhd", "--iso", "0", "-o", name, "--quiet"}).status == 0);
    const Mesh mesh = mesh_in(folder, name);
    CHECK(mesh.space == "LPS");
    if (first.V.rows() == 0) first = mesh;
    CHECK(mesh.F.rows() == first.F.rows());
    if (std::string(name) != "b.stl") {
      CHECK(mesh.V == first.V);
      CHECK(mesh.F == first.F);
    }
  }
  const Mesh vtp = mesh_in(folder, "b.vtp");
  REQUIRE(vtp.triangle_arrays.size() == 2);
  CHECK(vtp.triangle_arrays[0].name == "isovalue");
  CHECK(vtp.triangle_arrays[1].name == "kind");
}

TEST_CASE("spacing, origin and direction place the mesh; RAS turns it", "[program][extract]") {
  const TemporaryFolder folder;
  const int n = 24;
  // A left-handed direction: the first axis runs to the right.
  make_volume(
      folder / "ball.mhd", {n, n, n}, ball(n, 8),
      "ElementSpacing = 0.5 2 3\nOffset = 100 -50 7\nTransformMatrix = -1 0 0 0 0 1 0 1 0\n");
  CHECK(run_in(folder, {"extract", "ball.mhd", "--iso", "0", "-o", "l.ply", "--json", "r.json"})
            .status == 0);
  CHECK(run_in(folder, {"extract", "ball.mhd", "--iso", "0", "-o", "r.ply", "--space", "ras"})
            .status == 0);
  const Mesh lps = mesh_in(folder, "l.ply"), ras = mesh_in(folder, "r.ply");
  const Eigen::RowVector3d centre = 0.5 * (lps.V.colwise().minCoeff() + lps.V.colwise().maxCoeff());
  const double c = 0.5 * (n - 1);
  // TransformMatrix holds the axes one after another: x is −e0, y is e2, z is e1.
  CHECK((centre - Eigen::RowVector3d(100 - 0.5 * c, -50 + 3 * c, 7 + 2 * c)).norm() < 1e-9);
  const Eigen::RowVector3d extent = lps.V.colwise().maxCoeff() - lps.V.colwise().minCoeff();
  CHECK((extent - 2 * 8 * Eigen::RowVector3d(0.5, 3, 2)).cwiseAbs().maxCoeff() < 0.2);
  CHECK(lps.space == "LPS");
  CHECK(ras.space == "RAS");
  CHECK(ras.V.col(0) == -lps.V.col(0));
  CHECK(ras.V.col(1) == -lps.V.col(1));
  CHECK(ras.V.col(2) == lps.V.col(2));
  // Outward in both.
  CHECK(check_mesh(view_of(lps)).volume.value_or(-1) ==
        Approx(4.0 / 3 * kPi * 512 * 3).epsilon(0.02));
  CHECK(check_mesh(view_of(ras)).volume.value_or(-1) > 0);
  CHECK(read_json(folder / "r.json")["odd_interior_edges"] == 0);
}

TEST_CASE("inside above and below are each other's reverse", "[program][extract]") {
  const TemporaryFolder folder;
  make_volume(folder / "ball.mhd", {20, 20, 20}, ball(20, 7));
  run_in(folder, {"extract", "ball.mhd", "--iso", "0", "-o", "above.ply"});
  run_in(folder, {"extract", "ball.mhd", "--iso", "0", "-o", "below.ply", "--inside", "below"});
  const double above = check_mesh(view_of(mesh_in(folder, "above.ply"))).volume.value();
  const double below = check_mesh(view_of(mesh_in(folder, "below.ply"))).volume.value();
  CHECK(above > 0);
  CHECK(below == Approx(-above));
}

TEST_CASE("a region of interest, open and capped", "[program][extract]") {
  const TemporaryFolder folder;
  make_volume(folder / "ball.mhd", {30, 30, 30}, ball(30, 10));
  // Half of the ball: x from 0 to the middle plane is not on the lattice, so take 15 … 30.
  CHECK(run_in(folder, {"extract", "ball.mhd", "--iso", "0", "-o", "open.ply", "--roi",
                        "15,30,0,30,0,30", "--json", "open.json"})
            .status == 0);
  CHECK(run_in(folder, {"extract", "ball.mhd", "--iso", "0", "-o", "capped.ply", "--roi",
                        "15,30,0,30,0,30", "--cap", "--json", "capped.json"})
            .status == 0);
  const nlohmann::json open = read_json(folder / "open.json"),
                       capped = read_json(folder / "capped.json");
  CHECK(open["odd_edges"] > 0);
  CHECK(open["odd_interior_edges"] == 0);
  CHECK(open["closed"] == false);
  CHECK(open["volume"].is_null());
  CHECK(capped["odd_edges"] == 0);
  CHECK(capped["odd_interior_edges"] == 0);
  CHECK(capped["closed"] == true);
  CHECK(capped["genus"] == 0);
  // The part of a ball beyond a plane at distance d of its centre: π (r − d)² (2 r + d) / 3.
  const double d = 0.5;
  CHECK(capped["volume"].get<double>() ==
        Approx(kPi * (10 - d) * (10 - d) * (20 + d) / 3).epsilon(0.01));
  const Mesh mesh = mesh_in(folder, "open.ply");
  CHECK(mesh.V.col(0).minCoeff() == 15.0);
  // The whole as a region is the whole.
  run_in(folder, {"extract", "ball.mhd", "--iso", "0", "-o", "a.ply"});
  run_in(folder, {"extract", "ball.mhd", "--iso", "0", "-o", "b.ply", "--roi", "0,30,0,30,0,30"});
  CHECK(slurp(folder / "a.ply") == slurp(folder / "b.ply"));
}

TEST_CASE("several isovalues: a file each, or one VTP", "[program][extract]") {
  const TemporaryFolder folder;
  make_volume(folder / "ball.mhd", {30, 30, 30}, ball(30, 10));
  const Run run = run_in(folder, {"extract", "ball.mhd", "--iso", "0", "--iso", "-2.5", "--iso",
                                  "4", "-o", "b.off", "--json", "r.json"});
  CHECK(run.status == 0);
  CHECK(listing(folder.path()) == std::vector<std::string>{"b_-2.5.off", "b_0.off", "b_4.off",
                                                           "ball.mhd", "ball.raw", "r.json"});
  const nlohmann::json report = read_json(folder / "r.json");
  REQUIRE(report["surfaces"].size() == 3);
  CHECK(report["surfaces"][1]["isovalue"] == -2.5);
  CHECK(report["surfaces"][1]["output"] == "b_-2.5.off");
  std::int64_t triangles = 0;
  for (const auto& surface : report["surfaces"])
    triangles += surface["triangles"].get<std::int64_t>();
  CHECK(report["triangles"] == triangles);
  CHECK(report["components"] == 3);
  const double radius = std::cbrt(report["surfaces"][1]["volume"].get<double>() * 3 / (4 * kPi));
  CHECK(radius == Approx(12.5).epsilon(0.01));

  CHECK(run_in(folder, {"extract", "ball.mhd", "--iso", "0", "--iso", "-2.5", "--iso", "4", "-o",
                        "all.vtp"})
            .status == 0);
  const Mesh all = mesh_in(folder, "all.vtp");
  CHECK(all.F.rows() == triangles);
  CHECK(check_mesh(view_of(all)).components == 3);
  REQUIRE(all.triangle_arrays.size() == 2);
  CHECK(all.triangle_arrays[0].name == "isovalue");
  const auto& values = std::get<std::vector<double>>(all.triangle_arrays[0].values);
  CHECK(std::count(values.begin(), values.end(), -2.5) == report["surfaces"][1]["triangles"]);
  CHECK(all.vertex_arrays.size() == 1);
}

TEST_CASE("an isovalue outside the range gives a valid empty file and a warning",
          "[program][extract]") {
  const TemporaryFolder folder;
  make_volume(folder / "ball.mhd", {12, 12, 12}, ball(12, 4));
  for (const char* name : {"e.ply", "e.obj", "e.off", "e.vtp", "e.stl"}) {
    INFO(name);
    const Run run =
        run_in(folder, {"extract", "ball.mhd", "--iso", "1000", "-o", name, "--json", "r.json"});
    CHECK(run.status == 0);
    CHECK_THAT(run.err, Contains("warning: ball.mhd: the isovalue 1000 is outside the range") &&
                            Contains("the surface is empty"));
    CHECK(mesh_in(folder, name).F.rows() == 0);
    CHECK(read_json(folder / "r.json")["triangles"] == 0);
  }
  const Run quiet = run_in(folder, {"extract", "ball.mhd", "--iso", "1000", "-o", "e.ply",
                                    "--quiet", "--picture", "e.png"});
  CHECK(quiet.status == 0);
  CHECK(quiet.err.empty());
  CHECK_FALSE(fs::exists(folder / "e.png"));
  const Run contour =
      run_in(folder, {"contours", "ball.mhd", "--iso", "1000", "--slice", "6", "-o", "e.svg"});
  CHECK(contour.status == 0);
  CHECK_THAT(contour.err,
             Contains("outside the range") && Contains("the contour of slice 6 is empty"));
  CHECK_THAT(slurp(folder / "e.svg"), Contains("</svg>"));
}

TEST_CASE("options reach the library", "[program][extract]") {
  const TemporaryFolder folder;
  // Two cubes of 2, touching over a layer of zeros, in -1; and ±1 in no order.
  make_volume(folder / "parts.mhd", {12, 8, 8}, [](int i, int j, int k) {
    const bool inside = j > 1 && j < 6 && k > 1 && k < 6 && i > 1 && i < 10;
    return inside ? (i == 5 ? 0.0F : 1.0F) : -1.0F;
  });
  make_volume(folder / "checkers.mhd", {10, 10, 10},
              [](int i, int j, int k) { return scattered(i, j, k) > 0 ? 1.0F : -1.0F; });
  const auto report = [&folder](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--json", "r.json", "-o", "o.ply", "--iso", "0"});
    CHECK(run_in(folder, arguments).status == 0);
    return read_json(folder / "r.json");
  };
  CHECK(report({"extract", "parts.mhd"})["zero_faces"] == 0);
  CHECK(report({"extract", "parts.mhd", "--zero-faces", "mating"})["zero_faces"] == 9);
  const nlohmann::json compact = report({"extract", "checkers.mhd"}),
                       centroid =
                           report({"extract", "checkers.mhd", "--triangulation", "centroid"});
  CHECK(centroid["centroids"] > compact["centroids"]);
  CHECK(centroid["triangles"] > compact["triangles"]);
  // The neutral rule: negation only turns the triangles over; the positive one: it changes them,
  // with such ties.
  const auto turned = [&](const std::string& ties) {
    report({"extract", "checkers.mhd", "--ties", ties});
    const Mesh above = mesh_in(folder, "o.ply");
    report({"extract", "checkers.mhd", "--ties", ties, "--inside", "below"});
    const Mesh below = mesh_in(folder, "o.ply");
    return above.V.rows() == below.V.rows() && above.V == below.V &&
           unordered_triangles(above) == unordered_triangles(below);
  };
  CHECK(turned("neutral"));
  CHECK_FALSE(turned("positive"));
  CHECK(report({"extract", "checkers.mhd", "--id-bits", "64"})["options"]["id_bits"] == 64);
  CHECK(report({"extract", "checkers.mhd", "--id-bits", "64"})["odd_interior_edges"] == 0);
}

TEST_CASE("the number of threads does not change a byte", "[program][extract]") {
  const TemporaryFolder folder;
  make_volume(folder / "f.mhd", {33, 29, 31}, [](int i, int j, int k) {
    return static_cast<float>((i * 31 + j * 17 + k * 13 + i * j * k) % 7 - 3);
  });
  run_in(folder, {"extract", "f.mhd", "--iso", "0", "-o", "1.ply", "--threads", "1"});
  run_in(folder, {"extract", "f.mhd", "--iso", "0", "-o", "2.ply", "--threads", "2"});
  run_in(folder, {"extract", "f.mhd", "--iso", "0", "-o", "b64.ply", "--id-bits", "64"});
  CHECK(slurp(folder / "1.ply") == slurp(folder / "2.ply"));
  CHECK(slurp(folder / "1.ply") == slurp(folder / "b64.ply"));
}

TEST_CASE("non-finite samples: an error, or masked", "[program][extract]") {
  const TemporaryFolder folder;
  make_volume(folder / "nan.mhd", {16, 16, 16}, [](int i, int j, int k) {
    return i == 8 && j == 8 && k == 3 ? std::nanf("") : ball(16, 5)(i, j, k);
  });
  const Run run = run_in(folder, {"extract", "nan.mhd", "--iso", "0", "-o", "n.ply"});
  CHECK(run.status == 1);
  CHECK_THAT(run.err, Contains("nan.mhd: ") && Contains("--non-finite mask"));
  CHECK_FALSE(fs::exists(folder / "n.ply"));
  const Run masked = run_in(folder, {"extract", "nan.mhd", "--iso", "0", "-o", "n.ply",
                                     "--non-finite", "mask", "--json", "r.json"});
  CHECK(masked.status == 0);
  CHECK(read_json(folder / "r.json")["masked_cells"] == 8);
}

TEST_CASE("info of a volume and of a mesh", "[program][info]") {
  const TemporaryFolder folder;
  make_volume(
      folder / "v.mhd", {5, 4, 3},
      [](int i, int j, int k) { return static_cast<float>(i + 10 * j + 100 * k); },
      "ElementSpacing = 0.5 1 2\nOffset = 1 2 3\n");
  const Run run = run_in(folder, {"info", "v.mhd", "--json", "v.json"});
  CHECK(run.status == 0);
  CHECK_THAT(run.out, Contains("MetaImage") && Contains("5 x 4 x 3 float32") &&
                          Contains("0.5 1 2 mm") && Contains("histogram") && Contains("0 … 234"));
  const nlohmann::json json = read_json(folder / "v.json");
  CHECK(json["dims"] == nlohmann::json({5, 4, 3}));
  CHECK(json["maximum"] == 234.0);
  CHECK(json["origin"] == nlohmann::json({1.0, 2.0, 3.0}));
  run_in(folder, {"extract", "v.mhd", "--iso", "50", "-o", "v.ply", "--quiet"});
  const Run mesh = run_in(folder, {"info", "v.ply"});
  CHECK(mesh.status == 0);
  CHECK_THAT(mesh.out, Contains("PLY, binary little endian") &&
                           Contains("space                   LPS") && Contains("boundary edges"));
}

TEST_CASE("check agrees with the report of extract", "[program][check]") {
  const TemporaryFolder folder;
  make_volume(folder / "f.mhd", {17, 16, 15}, [](int i, int j, int k) {
    return static_cast<float>((i * 5 + j * 11 + k * 3) % 5 - 2);
  });
  run_in(folder, {"extract", "f.mhd", "--iso", "0", "-o", "f.obj", "--json", "a.json"});
  CHECK(run_in(folder, {"check", "f.obj", "--json", "b.json"}).status == 0);
  const nlohmann::json a = read_json(folder / "a.json"), b = read_json(folder / "b.json");
  int compared = 0;
  for (const auto& [key, value] : b.items()) {
    if (!a.contains(key) || key == "seconds" || key == "command") continue;
    INFO(key);
    CHECK(a[key] == value);
    ++compared;
  }
  CHECK(compared >= 20);
}

TEST_CASE("contours: a circle as SVG and VTP", "[program][contours]") {
  const TemporaryFolder folder;
  make_volume(folder / "ball.mhd", {31, 31, 31}, ball(31, 10), "Offset = 5 6 7\n");
  for (const char* axis : {"x", "y", "z"}) {
    INFO(axis);
    const Run run = run_in(folder, {"contours", "ball.mhd", "--iso", "0", "--axis", axis, "--slice",
                                    "15", "-o", "c.vtp", "--json", "c.json"});
    CHECK(run.status == 0);
    const nlohmann::json report = read_json(folder / "c.json");
    CHECK(report["closed_lines"] == 1);
    CHECK(report["open_lines"] == 0);
    CHECK(report["length"].get<double>() == Approx(2 * kPi * 10).epsilon(0.01));
  }
  CHECK(run_in(folder, {"contours", "ball.mhd", "--iso", "0", "--slice", "15", "-o", "c.svg"})
            .status == 0);
  const std::string svg = slurp(folder / "c.svg");
  CHECK_THAT(svg, Contains("<svg") && Contains("viewBox=\"0 0 30.000 30.000\"") &&
                      Contains("Z\n") && Contains("</svg>"));
  CHECK(std::count(svg.begin(), svg.end(), 'M') == 1);
  // A slice through the border of the ball has a smaller circle: r² = 10² − 6².
  run_in(folder, {"contours", "ball.mhd", "--iso", "0", "--slice", "21", "-o", "c.vtp", "--json",
                  "c.json"});
  CHECK(read_json(folder / "c.json")["length"].get<double>() == Approx(2 * kPi * 8).epsilon(0.01));
}

TEST_CASE("compare: neutral and without faults where the others are not", "[program][compare]") {
  const TemporaryFolder folder;
  make_volume(folder / "f.mhd", {16, 16, 16}, scattered);
  const Run run = run_in(folder, {"compare", "f.mhd", "--iso", "0", "--json", "c.json"});
  CHECK(run.status == 0);
  CHECK_THAT(run.out, Contains("Shape3D::zmc") && Contains("vtkFlyingEdges3D") &&
                          Contains("vtkMarchingCubes"));
  const nlohmann::json rows = read_json(folder / "c.json")["extractors"];
  REQUIRE(rows.size() == 3);
  CHECK(rows[0]["neutral"] == true);
  CHECK(rows[0]["degenerate_triangles"] == 0);
  CHECK(rows[0]["duplicate_triangles"] == 0);
  CHECK(rows[0]["odd_interior_edges"] == 0);
  CHECK(rows[0]["coincident_vertices"] == 0);
  CHECK(rows[1]["neutral"] == false);
  CHECK(rows[1]["degenerate_triangles"] > 0);
  CHECK(rows[2]["neutral"] == false);
}

bool is_png(const std::string& bytes) { return bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n"; }

TEST_CASE("pictures without a display", "[program][render]") {
  const TemporaryFolder folder;
  make_volume(folder / "ball.mhd", {20, 20, 20}, ball(20, 7));
  RunOptions options;
  options.folder = folder.path();
  options.unset = {"DISPLAY"};
  const Run run = run_shape3d(
      {"extract", "ball.mhd", "--iso", "0", "-o", "b.ply", "--picture", "b.png"}, options);
  INFO(run.err);
  REQUIRE(run.status == 0);
  const std::string png = slurp(folder / "b.png");
  CHECK(is_png(png));
  // A display that is not there is not taken for one.
  options.unset.clear();
  options.set = {"DISPLAY=:4711"};
  CHECK(run_shape3d({"render", "b.ply", "-o", "c.png", "--size", "200x100", "--view", "left",
                     "--color", "#ff8000"},
                    options)
            .status == 0);
  CHECK(is_png(slurp(folder / "c.png")));
  CHECK(run_shape3d({"render", "b.ply", "b.ply", "-o", "d.png", "--opacity", "1", "--opacity",
                     "0.4", "--size", "64x64", "--offscreen", "--largest"},
                    options)
            .status == 0);
  // Without Xvfb: a sentence, and nothing written.
  options.set = {"PATH=" + folder.path().string()};
  options.unset = {"DISPLAY"};
  const Run without = run_shape3d({"render", "b.ply", "-o", "e.png"}, options);
  CHECK(without.status == 1);
  CHECK_THAT(without.err, Contains("Xvfb, which is not installed (Debian package xvfb)"));
  const Run extract = run_shape3d(
      {"extract", "ball.mhd", "--iso", "0", "-o", "x.ply", "--picture", "x.png"}, options);
  CHECK(extract.status == 1);
  CHECK(listing(folder.path()) ==
        std::vector<std::string>{"b.ply", "b.png", "ball.mhd", "ball.raw", "c.png", "d.png"});
}

TEST_CASE("a contact sheet shows each mesh of a folder with its name", "[program][render]") {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path();
  const auto spill = [](const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path) << text;
  };
  const std::string tetrahedron =
      "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  fs::create_directories(folder / "shapes/solids");
  for (const char* name : {"a.off", "b.off", "solids/c.off", "solids/d.off", "solids/e.off"})
    spill(folder / "shapes" / name, tetrahedron);
  spill(folder / "shapes/broken.off", "OFF\n3 1 0\n0 0 0\n");
  spill(folder / "shapes/notes.txt", "no mesh");
  const Run run = run_shape3d({"render", "--sheet", "shapes", "-o", "sheet.png", "--color",
                               "#ff0000", "--json", "sheet.json"},
                              options);
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.err, Contains("warning: shapes/broken.off: "));
  const auto report = read_json(folder / "sheet.json");
  CHECK(report["meshes"] == 5);
  CHECK(report["left_out"].size() == 1);
  CHECK(report["columns"] == 3);
  const PngImage image = decode_png(slurp(folder / "sheet.png"));
  CHECK(image.width == report["width"]);
  CHECK(image.height == report["height"]);
  // Five of the six places of two rows are taken, each by something red with black letters above.
  const auto red_in = [&image](int column, int row) {
    int red = 0;
    for (int y = row * image.height / 2; y < (row + 1) * image.height / 2; ++y) {
      for (int x = column * image.width / 3; x < (column + 1) * image.width / 3; ++x) {
        const auto& pixel = image.at(x, y);
        red += pixel[0] > 60 && pixel[1] < 40 && pixel[2] < 40 ? 1 : 0;
      }
    }
    return red;
  };
  for (int place = 0; place < 5; ++place) {
    INFO(place);
    CHECK(red_in(place % 3, place / 3) > 2000);
  }
  CHECK(red_in(2, 1) == 0);
  CHECK(image.count({0.0, 0.0, 0.0}, 0.3) > 50);

  // The size that is asked for, or a sentence when it is too small.
  REQUIRE(run_shape3d({"render", "--sheet", "shapes", "-o", "small.png", "--size", "300x240", "-q"},
                      options)
              .status == 0);
  CHECK(decode_png(slurp(folder / "small.png")).width == 300);
  const Run tiny =
      run_shape3d({"render", "--sheet", "shapes", "-o", "tiny.png", "--size", "40x40"}, options);
  CHECK(tiny.status == 1);
  CHECK_THAT(tiny.err, Contains("is too small for 5 panels"));
  fs::create_directories(folder / "empty");
  const Run none = run_shape3d({"render", "--sheet", "empty", "-o", "none.png"}, options);
  CHECK(none.status == 1);
  CHECK_THAT(none.err, Contains("empty: holds no mesh, expected files .ply"));
  spill(folder / "empty/broken.off", "OFF\n3 1 0\n0 0 0\n");
  const Run broken = run_shape3d({"render", "--sheet", "empty", "-o", "none.png"}, options);
  CHECK(broken.status == 1);
  CHECK_THAT(broken.err, Contains("none of which can be drawn; the first: empty/broken.off: "));
  CHECK_FALSE(fs::exists(folder / "tiny.png"));
  CHECK_FALSE(fs::exists(folder / "none.png"));
}

TEST_CASE("an interrupt leaves nothing half-written", "[program][interrupt]") {
  const TemporaryFolder folder;
  // Large enough to take a while in a text format.
  make_volume(folder / "f.mhd", {120, 120, 120}, scattered);
  int interrupted = 0;
  for (const int milliseconds : {60, 150, 300, 500, 800, 1200}) {
    RunOptions options;
    options.folder = folder.path();
    options.while_running = [milliseconds](int process) {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      kill(process, SIGINT);
    };
    const Run run = run_shape3d({"extract", "f.mhd", "--iso", "0", "-o", "f.obj"}, options);
    INFO("after " << milliseconds << " ms: " << run.err);
    if (run.status == 0) {  // it was faster
      fs::remove(folder / "f.obj");
      continue;
    }
    CHECK(run.status == 130);  // also when the signal came before main()
    interrupted += run.err.find("interrupted; nothing unfinished was left") != std::string::npos;
    CHECK(listing(folder.path()) == std::vector<std::string>{"f.mhd", "f.raw"});
  }
  CHECK(interrupted >= 1);
}

}  // namespace
