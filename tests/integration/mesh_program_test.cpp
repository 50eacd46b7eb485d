// align, repair, simplify and wrap as a user runs them.
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <catch2/catch.hpp>
#include <shape3d/mapping/inspect.hpp>

#include "mesh_runs.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::test;
namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

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
  save(folder, "open.off", without(body, 100, 4));
  Run run = run_in(folder, {"repair", "open.off", "-o", "closed.ply", "--json", "r.json",
                            "--picture", "p.png", "--self-intersections"});
  INFO(run.out << run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, Contains("filled 1 hole with 4 triangles") &&
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
    CHECK_THAT(run.err, StartsWith("shape3d: ") && Contains(sentence));
    CHECK(listing(folder.path()) == before);
  };
  for (const char* command : {"align", "repair", "simplify", "wrap"}) {
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

}  // namespace
