// map as a user runs it.
#include <fstream>
#include <iterator>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <shape3d/mapping/certificate.hpp>

#include "mesh_runs.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

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
      CHECK_THAT(run.err, StartsWith("shape3d: " + file + ": ") && Contains(sentence));
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
  Mesh broken = without(without(body, 100, 2), 5, 1);
  broken.F.row(7).reverseInPlace();
  broken.V.conservativeResize(body.V.rows() + 2, 3);
  broken.V.bottomRows(2).setRandom();
  save(folder, "broken.off", broken);
  Run run = run_in(folder, {"map", "broken.off", "-o", "s.off", "--repair", "--json", "r.json"});
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, Contains("filled 2 holes with 3 triangles"));
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

TEST_CASE("map: wrong command lines", "[program][map][error]") {
  const TemporaryFolder folder;
  save(folder, "pear.off", pear(6));
  const auto refused = [&](const std::vector<std::string>& options, const std::string& sentence) {
    std::vector<std::string> arguments{"map", "pear.off"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Run run = run_in(folder, arguments);
    INFO(run.out << run.err);
    CHECK(run.status == 2);
    CHECK_THAT(run.err, StartsWith("shape3d: ") && Contains(sentence));
    CHECK(listing(folder.path()) == std::vector<std::string>{"pear.off"});
  };
  refused({}, "--output is required");
  refused({"-o", "s.xyz"}, "-o s.xyz: unknown extension '.xyz', expected .ply");
  refused({"-o", "s.off", "--energy", "elastic"},
          "--energy elastic: expected conformal or harmonic");
  refused({"-o", "s.off", "--max-triangles", "3"}, "--max-triangles");
  refused({"-o", "s.off", "--mesh", "m.xyz"}, "--mesh m.xyz: unknown");
  refused({"-o", "s.off", "--picture", "p.jpg"}, "--picture p.jpg: expected a name that ends in");
  refused({"-o", "s.off", "--view", "inside"}, "--view inside: expected one of front");
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
