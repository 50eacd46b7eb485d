// map, align, repair, simplify and wrap as a user runs them.
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <thread>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <shape3d/mapping/certificate.hpp>
#include <shape3d/mapping/inspect.hpp>

#include "common/mesh_io.hpp"
#include "program_run.hpp"
#include "support/test_data.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::test;
namespace fs = std::filesystem;
using Catch::Matchers::Contains;

Run run_in(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
  RunOptions options;
  options.folder = folder.path();
  const Run run = run_shape3d(arguments, options);
  CHECK(run.err.find("ERR|") == std::string::npos);  // VTK's log
  return run;
}

Mesh mesh_in(const TemporaryFolder& folder, const std::string& name) {
  return read_mesh((folder / name).string()).mesh;
}

bool is_png(const std::string& bytes) { return bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n"; }

// A lopsided ball of 2 n (n − 1) triangles: n meridians, and as many circles of latitude.
Mesh pear(int n) {
  Mesh mesh;
  constexpr double kPi = 3.141592653589793;
  mesh.V.resize(n * (n - 1) + 2, 3);
  const auto place = [](const Eigen::RowVector3d& u) -> Eigen::RowVector3d {
    return (1 + 0.3 * u[2] + 0.15 * u[0] * u[0] * u[1] + 0.1 * std::sin(3 * u[0] + 1)) *
           u.cwiseProduct(Eigen::RowVector3d(1.0, 1.4, 2.1));
  };
  for (int j = 1; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double theta = kPi * j / n, phi = 2 * kPi * (i + 0.5 * (j % 2)) / n;
      mesh.V.row(i + n * (j - 1)) = place(Eigen::RowVector3d(
          std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
    }
  }
  const int north = n * (n - 1), south = north + 1;
  mesh.V.row(north) = place({0, 0, 1});
  mesh.V.row(south) = place({0, 0, -1});
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n, last = n * (n - 2);
    triangles.push_back({north, i, next});
    triangles.push_back({south, last + next, last + i});
    for (int j = 1; j + 1 < n; ++j) {
      const int a = i + n * (j - 1), b = next + n * (j - 1), c = i + n * j, d = next + n * j;
      if (j % 2 == 1) {
        triangles.push_back({a, c, d});
        triangles.push_back({a, d, b});
      } else {
        triangles.push_back({a, c, b});
        triangles.push_back({b, c, d});
      }
    }
  }
  mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    mesh.F.row(static_cast<Eigen::Index>(t)) << triangles[t][0], triangles[t][1], triangles[t][2];
  return mesh;
}

void save(const TemporaryFolder& folder, const std::string& name, const Mesh& mesh) {
  write_mesh((folder / name).string(), view_of(mesh));
}

// The same without some triangles.
Mesh without(const Mesh& mesh, Eigen::Index first, Eigen::Index count) {
  Mesh rest = mesh;
  rest.F.resize(mesh.F.rows() - count, 3);
  rest.F << mesh.F.topRows(first), mesh.F.bottomRows(mesh.F.rows() - first - count);
  return rest;
}

TEST_CASE("map: a certified sphere with its report and picture", "[program][map]") {
  const TemporaryFolder folder;
  const Mesh body = pear(24);
  save(folder, "pear.off", body);
  const Run run = run_in(folder, {"map", "pear.off", "-o", "sphere.ply", "--json", "r.json",
                                  "--picture", "pear.png", "--mesh", "mapped.off"});
  INFO(run.out << run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, Contains("status") && Contains("certified") && Contains("angle change") &&
                          Contains("Ceres"));
  const Mesh sphere = mesh_in(folder, "sphere.ply");
  CHECK(sphere.F == body.F);
  REQUIRE(sphere.V.rows() == body.V.rows());
  CHECK((sphere.V.rowwise().norm().array() - 1).abs().maxCoeff() < 1e-12);
  CHECK(mapping::certify(sphere.V, sphere.F).bijective());
  CHECK(is_png(slurp(folder / "pear.png")));
  CHECK(mesh_in(folder, "mapped.off").V == body.V);
  const nlohmann::json report = read_json(folder / "r.json");
  CHECK(report["map"]["certified"] == true);
  CHECK(report["map"]["certificate"]["flipped"] == 0);
  CHECK(report["map"]["certificate"]["degree"] == 1);
  CHECK(report["map"]["ceres"]["used"] == true);
  CHECK(report["map"]["ceres"]["final_cost"] <= report["map"]["ceres"]["initial_cost"]);
  CHECK(report["map"]["distortion"]["angle_change_degrees"]["mean"] <=
        report["map"]["linear_distortion"]["angle_change_degrees"]["mean"]);
  CHECK(report["map"]["distortion"]["energy_over_area"] >= 1.0);
  CHECK(report["inspection"]["genus"] == 0);
  CHECK(report["map"]["seconds"]["total"] >= 0.0);
}

TEST_CASE("map: linear, harmonic, fewer triangles, aligned", "[program][map]") {
  const TemporaryFolder folder;
  Mesh body = pear(24);
  save(folder, "pear.off", body);
  const auto report_of = [&](std::vector<std::string> options) {
    std::vector<std::string> arguments{"map", "pear.off", "-o", "s.off", "--json", "r.json", "-q"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Run run = run_in(folder, arguments);
    INFO(run.err);
    CHECK(run.status == 0);
    CHECK(run.out.empty());
    return read_json(folder / "r.json");
  };
  CHECK(report_of({"--linear"})["map"]["ceres"]["used"] == false);
  CHECK(report_of({"--energy", "harmonic"})["options"]["energy"] == "harmonic");
  const nlohmann::json coarse = report_of({"--max-triangles", "300", "--mesh", "coarse.ply"});
  CHECK(coarse["simplify"]["triangles"] == 300);
  CHECK(mesh_in(folder, "s.off").V.rows() == 152);
  CHECK(mesh_in(folder, "coarse.ply").F == mesh_in(folder, "s.off").F);
  // Equal shapes have equal maps.
  (void)report_of({"--align", "--linear"});
  const Mesh first = mesh_in(folder, "s.off");
  Eigen::Matrix3d turn;
  turn = Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, -2, 0.5).normalized());
  body.V = (37.0 * body.V * turn.transpose()).rowwise() + Eigen::RowVector3d(5, 6, 7);
  save(folder, "pear.off", body);
  const nlohmann::json aligned = report_of({"--align", "--linear"});
  CHECK(aligned["pose"]["ambiguous"] == false);
  CHECK((mesh_in(folder, "s.off").V - first.V).rowwise().norm().maxCoeff() < 1e-6);
}

TEST_CASE("map: what is wrong, how often, and what to do", "[program][map][error]") {
  const TemporaryFolder folder;
  const Mesh body = pear(8);
  const auto refused = [&folder](const std::string& file, const std::string& sentence) {
    const std::vector<std::string> before = listing(folder.path());
    for (const char* command : {"map"}) {
      const Run run = run_in(folder, {command, file, "-o", "s.off", "--picture", "p.png"});
      INFO(file << ": " << run.out << run.err);
      CHECK(run.status == 1);
      CHECK(run.out.empty());
      CHECK_THAT(run.err,
                 Catch::Matchers::StartsWith("shape3d: " + file + ": ") && Contains(sentence));
      CHECK(listing(folder.path()) == before);
    }
  };
  const auto spill = [&folder](const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
  };
  save(folder, "open.off", without(without(body, 60, 1), 5, 1));
  refused("open.off", "the surface is open: 2 boundary loops of 6 edges in all");
  refused("open.off", "; --repair fills the holes");

  Mesh changed = body;
  changed.F.row(7).reverseInPlace();
  save(folder, "misoriented.off", changed);
  refused("misoriented.off", "3 edges have two triangles that are oriented against each other");
  refused("misoriented.off", "; --repair turns the triangles");

  Mesh two = body;
  two.V.resize(2 * body.V.rows(), 3);
  two.V << body.V, body.V.array() + 5;
  two.F.resize(2 * body.F.rows(), 3);
  two.F << body.F, body.F.array() + static_cast<int>(body.V.rows());
  save(folder, "two.off", two);
  refused("two.off", "2 separate components, the largest of 112 triangles; --repair keeps");
  for (Eigen::Index t = body.F.rows(); t < two.F.rows(); ++t)
    for (Eigen::Index i = 0; i < 3; ++i)
      if (two.F(t, i) == body.V.rows()) two.F(t, i) = 0;
  save(folder, "touching.off", two);
  refused("touching.off", "1 vertex joins more than one sheet of triangles");
  refused("touching.off", "; --repair gives each sheet a vertex of its own");

  changed = body;
  changed.F.conservativeResize(body.F.rows() + 1, 3);
  changed.F.bottomRows(1) << body.F(0, 0), body.F(0, 1), 40;
  save(folder, "fin.off", changed);
  refused("fin.off", "1 edge has more than two triangles, the first between vertices");

  spill("torus.off", [] {
    std::string text = "OFF\n9 18 0\n";
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double a = 2.0943951 * i, b = 2.0943951 * j, r = 3 + std::cos(b);
        text += std::to_string(r * std::cos(a)) + " " + std::to_string(r * std::sin(a)) + " " +
                std::to_string(std::sin(b)) + "\n";
      }
    }
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const int k = (i + 1) % 3, l = (j + 1) % 3;
        const auto id = [](int u, int v) { return std::to_string(3 * u + v) + " "; };
        text +=
            "3 " + id(i, j) + id(k, j) + id(k, l) + "\n3 " + id(i, j) + id(k, l) + id(i, l) + "\n";
      }
    }
    return text;
  }());
  refused("torus.off", "genus 1: the body has 1 handle, and only genus 0 can be mapped");
  refused("torus.off", "; --wrap makes a surface of genus 0 round it");

  changed = body;
  changed.V.conservativeResize(body.V.rows() + 3, 3);
  changed.V.bottomRows(3).setRandom();
  save(folder, "isolated.off", changed);
  refused("isolated.off", "3 vertices are in no triangle, the first is row 58; --repair removes");

  changed = body;
  changed.F.conservativeResize(body.F.rows() + 2, 3);
  changed.F.bottomRows(2) << 4, 4, 9, body.F(3, 1), body.F(3, 0), body.F(3, 2);
  save(folder, "degenerate.off", changed);
  refused("degenerate.off", "1 degenerate triangle names a vertex twice");
  refused("degenerate.off", "1 triangle has the same three vertices as an earlier one");

  changed = body;
  changed.V.setConstant(3.0);
  save(folder, "point.off", changed);
  refused("point.off", "the area of all triangles together is zero");

  spill("nan.off",
        "OFF\n4 4 0\n0 0 0\n1 0 nan\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
  refused("nan.off", "line 4");
  spill("empty.off", "");
  refused("empty.off", "empty");
  spill("none.off", "OFF\n0 0 0\n");
  refused("none.off", "0 triangles: a closed surface has 4 at least");
  spill("three.off", "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n");
  refused("three.off", "3 triangles: a closed surface has 4 at least, as the tetrahedron");
  refused("three.off", "1 boundary loop of 3 edges");
}

TEST_CASE("map: the smallest and the largest", "[program][map]") {
  const TemporaryFolder folder;
  std::ofstream(folder / "four.off")
      << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  Run run = run_in(folder, {"map", "four.off", "-o", "s.off"});
  INFO(run.err);
  CHECK(run.status == 0);
  CHECK(mapping::certify(mesh_in(folder, "s.off").V, mesh_in(folder, "s.off").F).bijective());
  for (const double scale : {1e-30, 1e30}) {
    Mesh body = pear(12);
    body.V *= scale;
    save(folder, "scaled.off", body);
    run = run_in(folder, {"map", "scaled.off", "-o", "s.off", "--align"});
    INFO(scale << ": " << run.err);
    CHECK(run.status == 0);
    CHECK(mapping::certify(mesh_in(folder, "s.off").V, body.F).bijective());
  }
  // Inside out: mapped, with a warning.
  Mesh body = pear(12);
  body.F.rowwise().reverseInPlace();
  save(folder, "inside.off", body);
  run = run_in(folder, {"map", "inside.off", "-o", "s.off"});
  CHECK(run.status == 0);
  CHECK_THAT(run.err,
             Contains("warning: inside.off: the triangles run clockwise seen from outside") &&
                 Contains("--repair turns them"));
}

TEST_CASE("map: --repair and --wrap do what the sentences promise", "[program][map]") {
  const TemporaryFolder folder;
  const Mesh body = pear(12);
  Mesh broken = without(without(body, 100, 3), 5, 1);
  broken.F.row(7).reverseInPlace();
  broken.V.conservativeResize(body.V.rows() + 2, 3);
  broken.V.bottomRows(2).setRandom();
  save(folder, "broken.off", broken);
  Run run = run_in(folder, {"map", "broken.off", "-o", "s.off", "--repair", "--json", "r.json"});
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, Contains("filled 2 holes with 4 triangles"));
  CHECK(read_json(folder / "r.json")["repair"]["filled_holes"] == 2);
  CHECK(mesh_in(folder, "s.off").F.rows() == body.F.rows());
  run = run_in(folder, {"map", "broken.off", "-o", "s.off", "--wrap", "--linear", "--json",
                        "r.json", "--mesh", "wrap.off"});
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, Contains("wrap                    alpha"));
  const nlohmann::json report = read_json(folder / "r.json");
  CHECK(report["wrap"]["triangles"] == mesh_in(folder, "wrap.off").F.rows());
}

TEST_CASE("align: the pose and the posed mesh", "[program][align]") {
  const TemporaryFolder folder;
  Mesh body = pear(16);
  body.space = "LPS";
  save(folder, "pear.ply", body);
  Run run = run_in(folder, {"align", "pear.ply", "-o", "posed.ply", "--json", "r.json", "--picture",
                            "p.png", "--view", "left"});
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, Contains("eigenvalues") && Contains("ambiguous               no"));
  CHECK(is_png(slurp(folder / "p.png")));
  CHECK(mesh_in(folder, "posed.ply").space.empty());
  run = run_in(folder, {"align", "posed.ply", "--json", "again.json"});
  REQUIRE(run.status == 0);
  const nlohmann::json pose = read_json(folder / "r.json")["pose"],
                       again = read_json(folder / "again.json")["pose"];
  CHECK(again["scale"].get<double>() == Approx(1.0));
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(again["rotation_rows"][axis][axis].get<double>() == Approx(1.0));
    CHECK(again["centroid"][axis].get<double>() == Approx(0.0).margin(1e-12));
    CHECK(again["skew"][axis].get<double>() ==
          Approx(pose["skew"][axis].get<double>()).margin(1e-9));
  }
  // A mirror image, on request in the same pose.
  Mesh mirrored = body;
  mirrored.V.col(0) *= -1;
  mirrored.F.rowwise().reverseInPlace();
  save(folder, "mirrored.ply", mirrored);
  CHECK(run_in(folder, {"align", "pear.ply", "-o", "a.ply", "--reflect", "-q"}).status == 0);
  CHECK(run_in(folder, {"align", "mirrored.ply", "-o", "b.ply", "--reflect", "-q"}).status == 0);
  CHECK((mesh_in(folder, "a.ply").V - mesh_in(folder, "b.ply").V).cwiseAbs().maxCoeff() < 1e-10);
  for (const char* name : {"a.ply", "b.ply"}) {
    const Mesh mesh = mesh_in(folder, name);
    CHECK(*mapping::inspect(mesh.V, mesh.F).volume > 0);  // not inside out
  }
  CHECK_THAT(run_in(folder, {"align", "pear.ply", "--tolerance", "0.99"}).out,
             Contains("ambiguous               yes"));
}

TEST_CASE("repair and wrap write closed surfaces", "[program][repair][wrap]") {
  const TemporaryFolder folder;
  const Mesh body = pear(16);
  save(folder, "open.off", without(body, 100, 5));
  Run run = run_in(folder, {"repair", "open.off", "-o", "closed.ply", "--json", "r.json",
                            "--picture", "p.png", "--self-intersections"});
  INFO(run.out << run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, Contains("filled 1 hole with 5 triangles") &&
                          Contains("after                   a closed surface of genus 0"));
  CHECK(is_png(slurp(folder / "p.png")));
  nlohmann::json report = read_json(folder / "r.json");
  CHECK(report["before"]["boundary_loops"] == 1);
  CHECK(report["before"]["self_intersections"] == 0);
  CHECK(report["after"]["spherical"] == true);
  const Mesh closed = mesh_in(folder, "closed.ply");
  CHECK(mapping::inspect(closed.V, closed.F).spherical());
  run = run_in(folder, {"repair", "open.off", "-o", "open.ply", "--keep-holes", "--keep-all"});
  CHECK(run.status == 0);
  CHECK_THAT(run.out, Contains("after                   the surface is open"));

  run = run_in(folder, {"wrap", "open.off", "-o", "wrap.stl", "--json", "r.json", "--picture",
                        "p.png", "--finest", "20"});
  INFO(run.out << run.err);
  REQUIRE(run.status == 0);
  report = read_json(folder / "r.json");
  CHECK(report["wrap"]["attempts"].size() >= 4);
  const Mesh wrapped = mesh_in(folder, "wrap.stl");
  CHECK(mapping::inspect(wrapped.V, wrapped.F).genus == 0);
  // Two bodies far apart cannot be wrapped in one piece.
  Mesh two = body;
  two.V.resize(2 * body.V.rows(), 3);
  two.V << 0.01 * body.V, (0.01 * body.V.array() + 1);
  two.F.resize(2 * body.F.rows(), 3);
  two.F << body.F, body.F.array() + static_cast<int>(body.V.rows());
  save(folder, "two.off", two);
  run = run_in(folder, {"wrap", "two.off", "-o", "none.off", "--coarsest", "8", "--finest", "9"});
  CHECK(run.status == 1);
  CHECK_THAT(run.err, Contains("two.off: every wrap that was tried has handles or several pieces"));
  CHECK_FALSE(fs::exists(folder / "none.off"));
}

TEST_CASE("simplify: levels of detail, exactly", "[program][simplify]") {
  const TemporaryFolder folder;
  const Mesh body = pear(32);
  save(folder, "pear.ply", body);
  for (const char* cost : {"quadrics", "lindstrom_turk", "hoppe"}) {
    const Run run = run_in(folder, {"simplify", "pear.ply", "--triangles", "500", "-o", "c.off",
                                    "--cost", cost, "--json", "r.json"});
    INFO(cost << ": " << run.err);
    REQUIRE(run.status == 0);
    const Mesh coarse = mesh_in(folder, "c.off");
    CHECK(coarse.F.rows() == 500);
    CHECK(mapping::inspect(coarse.V, coarse.F).spherical());
    CHECK(read_json(folder / "r.json")["cost"] == cost);
  }
  Run run = run_in(folder, {"simplify", "pear.ply", "--levels", "pear.s3dp", "--triangles", "100",
                            "-o", "a.ply", "--picture", "p.png", "--json", "r.json"});
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK(is_png(slurp(folder / "p.png")));
  const nlohmann::json report = read_json(folder / "r.json");
  CHECK(report["levels"]["bytes"] == fs::file_size(folder / "pear.s3dp"));
  CHECK(run_in(folder, {"simplify", "pear.s3dp", "--triangles", "100", "-o", "b.ply"}).status == 0);
  CHECK(mesh_in(folder, "a.ply").V == mesh_in(folder, "b.ply").V);
  CHECK(mesh_in(folder, "a.ply").F == mesh_in(folder, "b.ply").F);
  CHECK(run_in(folder, {"simplify", "pear.s3dp", "--triangles", "99999", "-o", "f.ply"}).status ==
        0);
  CHECK(slurp(folder / "f.ply").size() == slurp(folder / "pear.ply").size());
  CHECK(mesh_in(folder, "f.ply").V == body.V);
  CHECK(mesh_in(folder, "f.ply").F == body.F);
  // Fewer than there can be.
  run = run_in(folder, {"simplify", "pear.ply", "--triangles", "1", "-o", "few.ply"});
  CHECK(run.status == 0);
  CHECK_THAT(run.err, Contains("warning: pear.ply: ") && Contains("are the fewest that keep"));
}

TEST_CASE("wrong command lines and files of the mesh commands", "[program][map][error]") {
  const TemporaryFolder folder;
  save(folder, "pear.off", pear(6));
  save(folder, "open.off", without(pear(6), 4, 1));
  Mesh isolated = pear(6);
  isolated.V.conservativeResize(isolated.V.rows() + 1, 3);
  isolated.V.bottomRows(1).setZero();
  save(folder, "isolated.off", isolated);
  std::ofstream(folder / "bad.s3dp") << "S3DPROG1 and then nothing of the kind";
  const auto refused = [&](int status, const std::vector<std::string>& arguments,
                           const std::string& sentence) {
    const std::vector<std::string> before = listing(folder.path());
    const Run run = run_in(folder, arguments);
    INFO(arguments[0] << " " << arguments[1] << ": " << run.out << run.err);
    CHECK(run.status == status);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Catch::Matchers::StartsWith("shape3d: ") && Contains(sentence));
    CHECK(listing(folder.path()) == before);
  };
  for (const char* command : {"map", "align", "repair", "simplify", "wrap"}) {
    std::vector<std::string> arguments{command, "pear.off", "-o", "x.xyz"};
    if (std::string(command) == "simplify") arguments.insert(arguments.end(), {"--triangles", "9"});
    refused(2, arguments, "-o x.xyz: unknown extension '.xyz', expected .ply");
    arguments[3] = "x.ply";
    arguments.insert(arguments.end(), {"--picture", "p.jpg"});
    refused(2, arguments, "--picture p.jpg: expected a name that ends in .png");
    arguments.back() = "p.png";
    arguments.insert(arguments.end(), {"--view", "inside"});
    refused(2, arguments, "--view inside: expected one of front");
    arguments.resize(arguments.size() - 4);
    arguments[1] = "missing.off";
    refused(1, arguments, "missing.off: ");
    arguments[1] = "pear.off";
    arguments[3] = "nowhere/x.ply";
    refused(1, arguments, "nowhere");
  }
  refused(2, {"map", "pear.off", "-o", "s.off", "--energy", "elastic"},
          "--energy elastic: expected conformal or harmonic");
  refused(2, {"map", "pear.off", "-o", "s.off", "--max-triangles", "3"}, "--max-triangles");
  refused(2, {"map", "pear.off", "-o", "s.off", "--mesh", "m.xyz"}, "--mesh m.xyz: unknown");
  refused(2, {"align", "pear.off", "--tolerance", "2"}, "--tolerance");
  refused(2, {"wrap", "pear.off", "-o", "w.off", "--finest", "5000"}, "--finest");
  refused(2, {"wrap", "pear.off", "-o", "w.off", "--coarsest", "50", "--finest", "40"},
          "--coarsest 50: expected a number up to --finest, which is 40");
  refused(2, {"wrap", "pear.off", "-o", "w.off", "--offset", "1"}, "--offset");
  refused(2, {"simplify", "pear.off", "-o", "c.off", "--triangles", "9", "--cost", "price"},
          "--cost price: expected quadrics, lindstrom_turk or hoppe");
  refused(2, {"simplify", "pear.off", "-o", "c.off"}, "-o c.off needs --triangles N");
  refused(2, {"simplify", "pear.off"}, "nothing is to be written: give -o FILE, --levels FILE");
  refused(2, {"simplify", "pear.off", "--levels", "l.bin"}, "expected a name that ends in .s3dp");
  refused(1, {"simplify", "bad.s3dp", "--triangles", "9", "-o", "c.off"},
          "bad.s3dp: bytes: not a progressive mesh: ");
  refused(1, {"simplify", "isolated.off", "--triangles", "9", "-o", "c.off"},
          "isolated.off: 1 vertex is in no triangle, the first is row 32; shape3d repair removes");
  Mesh flat = pear(6);
  flat.V.setZero();
  save(folder, "flat.off", flat);
  refused(1, {"align", "flat.off"}, "flat.off: F: the total area");
  refused(1, {"wrap", "flat.off", "-o", "w.off"}, "flat.off: F: the vertices of the");
  std::ofstream(folder / "line.off") << "OFF\n2 1 0\n0 0 0\n1 0 0\n3 0 1 1\n";
  refused(1, {"repair", "line.off", "-o", "r.off"},
          "line.off: F: none of the 1 triangles has three different vertices");
}

TEST_CASE("an interrupted simplification leaves nothing", "[program][simplify][interrupt]") {
  const TemporaryFolder folder;
  save(folder, "large.ply", pear(260));
  int interrupted = 0;
  for (const int milliseconds : {100, 300, 700}) {
    RunOptions options;
    options.folder = folder.path();
    options.while_running = [milliseconds](int process) {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      kill(process, SIGINT);
    };
    const Run run = run_shape3d({"simplify", "large.ply", "--triangles", "50", "-o", "c.ply",
                                 "--levels", "l.s3dp", "--cost", "hoppe"},
                                options);
    if (run.status == 130) ++interrupted;
    if (run.status == 130) CHECK(listing(folder.path()) == std::vector<std::string>{"large.ply"});
  }
  CHECK(interrupted >= 1);
}

// What each mesh of topology_cases is refused for, and what makes it fit to be mapped.
struct TopologyCase {
  const char* name;
  const char* sentence;
  const char* remedy;  ///< "", "--repair" or "--wrap".
};

TEST_CASE("meshes that are no spheres are refused, repaired or wrapped", "[program][map][data]") {
  const TopologyCase cases[] = {
      {"3holes", "genus 3: the body has 3 handles", "--wrap"},
      {"beetle_open", "the surface is open: ", "--wrap"},
      {"blobby_3components", "3 separate components", "--repair"},
      {"blobby_misoriented", "two triangles that are oriented against each other", "--repair"},
      {"bunny_stanford_open", "1113 vertices are in no triangle", "--repair"},
      {"camelhead_open", "the surface is open: 1 boundary loop of 56 edges", "--repair"},
      {"cow_viewpoint", "1 vertex joins more than one sheet of triangles", "--repair"},
      {"fertility_g4", "genus 4: the body has 4 handles", "--wrap"},
      {"knot1", "genus 1: the body has 1 handle", "--wrap"},
      {"plane_holes_open", "the surface is open: ", "--wrap"},
      {"rocker_arm_g1", "genus 1: the body has 1 handle", "--wrap"},
      {"spot_quads", "", ""},
      {"teapot", "separate components", "--wrap"},
      {"torus_g1", "genus 1: the body has 1 handle", "--wrap"}};
  if (!test_data("topology_cases")) {
    WARN("SHAPE3D_DATA has no topology_cases");
    return;
  }
  const TemporaryFolder folder;
  for (const TopologyCase& item : cases) {
    const std::string path =
        test_data(std::string("topology_cases/") + item.name + ".off")->string();
    INFO(item.name);
    const Run plain = run_in(folder, {"map", path, "-o", "s.off", "--linear"});
    INFO(plain.err);
    if (*item.sentence == '\0') {
      CHECK(plain.status == 0);
      CHECK_THAT(plain.err, Contains("2928"));  // quads made into triangles
      continue;
    }
    CHECK(plain.status == 1);
    CHECK_THAT(plain.err, Contains(item.sentence) && Contains("; --"));
    const Run remedied =
        run_in(folder, {"map", path, "-o", "s.off", item.remedy, "--linear", "--json", "r.json"});
    INFO(remedied.err);
    CHECK(remedied.status == 0);
    CHECK(read_json(folder / "r.json")["map"]["certified"] == true);
    const Mesh sphere = mesh_in(folder, "s.off");
    CHECK(mapping::certify(sphere.V, sphere.F).bijective());
  }
}

}  // namespace
