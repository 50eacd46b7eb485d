#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>

#include <catch2/catch.hpp>

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

constexpr int kMembers = 8;

// A small collection in the layout of the Princeton Shape Benchmark: boxes, rods and rings, each
// stretched a little; models 100 … 123 are the train part and 200 … 223 the test part.
class Collection {
 public:
  Collection() {
    options_.folder = folder_.path();
    for (const int first : {100, 200}) {
      std::string text = "PSB 1\n4 " + std::to_string(3 * kMembers) + "\n\nthing 0 0\n\n";
      int id = first;
      for (const std::string name : {"box", "rod", "ring"}) {
        text += name + " thing " + std::to_string(kMembers) + "\n";
        for (int i = 0; i < kMembers; ++i, ++id) {
          text += std::to_string(id) + "\n";
          write_model(id, name);
        }
        text += "\n";
      }
      spill(first == 100 ? "base/train.cla" : "base/test.cla", text);
    }
  }

  void write_model(int id, const std::string& kind) {
    apps::Mesh mesh = kind == "ring" ? torus(16, 8, 3.0, 0.6) : cube();
    const Eigen::RowVector3d size =
        kind == "rod" ? Eigen::RowVector3d(6, 1, 1) : Eigen::RowVector3d(1.5, 1.2, 1);
    for (int axis = 0; axis < 3; ++axis) {
      mesh.V.col(axis) *= size[axis] * std::uniform_real_distribution<>(0.9, 1.1)(random_);
    }
    const std::string name = "m" + std::to_string(id);
    write(fs::path("db") / std::to_string(id / 100) / name / (name + ".off"), mesh);
  }
  void write(const fs::path& name, const apps::Mesh& mesh) const {
    fs::create_directories((folder_ / "x").parent_path() / name.parent_path());
    apps::write_mesh((folder_.path() / name).string(), apps::view_of(mesh));
  }
  void spill(const fs::path& name, const std::string& bytes) const {
    fs::create_directories(folder_.path() / name.parent_path());
    std::ofstream(folder_.path() / name, std::ios::binary) << bytes;
  }
  Run run(std::vector<std::string> arguments, bool is_short = true) {
    arguments.insert(arguments.begin(), "evaluate");
    if (is_short) {
      for (const char* word : {"--descriptor", "d2:pairs=4000,bins=16"}) arguments.push_back(word);
    }
    return run_shape3d(arguments, options_);
  }
  void refused(int status, const std::vector<std::string>& arguments, const std::string& sentence) {
    const Run bad = run(arguments);
    INFO(bad.out << bad.err);
    CHECK(bad.status == status);
    CHECK_THAT(bad.err, Contains(sentence));
    CHECK(bad.out.empty());
    CHECK_FALSE(fs::exists(path("out/report.json")));
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] nlohmann::json report(const std::string& name = "out") const {
    return read_json(folder_ / (name + "/report.json"));
  }

 private:
  TemporaryFolder folder_;
  RunOptions options_;
  std::mt19937 random_{1};
};

const std::vector<std::string> kTest{"--db-dir", "db", "--test-cla", "base/test.cla", "-o", "out"};

std::vector<std::string> with(std::vector<std::string> arguments,
                              const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

const nlohmann::json& method(const nlohmann::json& report, const std::string& name) {
  for (const nlohmann::json& one : report["groups"][0]["retrieval"]) {
    if (one["name"] == name) return one;
  }
  throw std::runtime_error("no method " + name);
}

TEST_CASE("evaluate measures a collection and draws it", "[evaluate]") {
  Collection collection;
  const Run run = collection.run(
      with(kTest, {"--train-cla", "base/train.cla", "--svm", "--weighted", "--metric", "learned",
                   "--descriptor", "egi:K=6@cosine", "--baseline"}));
  INFO(run.out << run.err);
  REQUIRE(run.status == 0);
  CHECK(run.err.empty());
  CHECK_THAT(run.out, Contains("learned metric, scaled") && Contains("CCR"));
  const nlohmann::json report = collection.report();
  CHECK(report["test"]["models"] == 24);
  CHECK(report["train"]["models"] == 24);
  CHECK(report["test"]["classes"] == 3);
  // The three kinds of bodies are far apart: what compares shapes finds them, numbers drawn at
  // random do not.
  const nlohmann::json fusion = method(report, "fusion, scaled");
  CHECK(fusion["micro"]["nearest_neighbour"].get<double>() > 0.9);
  CHECK(fusion["micro"]["precision"].size() == 20);
  CHECK(fusion["micro"]["precision"][0].is_null());  // classes of 8 have no recall of 0.05
  CHECK(fusion["classes"].size() == 3);
  CHECK(fusion["classes"][0]["name"] == "thing/box");
  const double random = method(report, "random 45")["micro"]["nearest_neighbour"];
  const double chance = report["groups"][0]["chance"]["nearest_neighbour"];
  CHECK(chance == Approx(7.0 / 23.0));
  CHECK(std::abs(random - chance) < 4 * std::sqrt(chance * (1 - chance) / 24));
  for (const nlohmann::json& one : report["groups"][0]["classification"]) {
    int sum = 0;
    for (const nlohmann::json& row : one["confusion"]) {
      for (const nlohmann::json& count : row) sum += count.get<int>();
    }
    CHECK(sum == 24);
    if (one["name"] == "all together") CHECK(one["correct_rate"].get<double>() > 0.9);
    if (one["name"] == "random 45") CHECK(one["correct_rate"].get<double>() < 0.8);
  }
  CHECK(method(report, "fusion, weighted hard")["micro"]["nearest_neighbour"].get<double>() >= 0.9);
  for (const char* name :
       {"precision-recall", "precision-recall-classes", "correct-classification", "confusion"}) {
    const PngImage image = decode_png(slurp(collection.path(std::string("out/") + name + ".png")));
    CHECK(image.width > 300);
  }
  CHECK_THAT(slurp(collection.path("out/report.md")),
             Contains("| fusion, scaled | 24 |") && Contains("| chance |") &&
                 Contains("What is fitted has seen base/train.cla alone"));
}

TEST_CASE("measures of a report are those of an independent script", "[evaluate]") {
  Collection collection;
  REQUIRE(collection.run(with(kTest, {"--quiet"})).status == 0);
  const std::string command = std::string(SHAPE3D_TEST_PYTHON) + " " + SHAPE3D_TEST_SCRIPTS +
                              "/evaluate_measures.py '" +
                              collection.path("base/test.cla").string() + "' '" +
                              collection.path("out/vectors.h5").string() + "'";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string text;
  char buffer[4096];
  for (std::size_t got; (got = fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    text.append(buffer, got);
  REQUIRE(pclose(pipe) == 0);
  const nlohmann::json expected = nlohmann::json::parse(text);
  const nlohmann::json found = collection.report()["groups"][0]["retrieval"][0]["micro"];
  CHECK(found["queries"] == expected["queries"]);
  for (const char* name : {"nearest_neighbour", "first_tier", "second_tier", "e_measure", "dcg",
                           "mean_average_precision"}) {
    INFO(name);
    CHECK(found[name].get<double>() == Approx(expected[name].get<double>()));
  }
  for (std::size_t k = 0; k < 20; ++k) {
    INFO("recall step " << k);
    REQUIRE(found["precision"][k].is_null() == expected["precision"][k].is_null());
    if (found["precision"][k].is_null()) continue;
    CHECK(found["precision"][k].get<double>() == Approx(expected["precision"][k].get<double>()));
  }
}

TEST_CASE("what is fitted sees the train part alone", "[evaluate]") {
  Collection collection;
  const std::vector<std::string> fitted =
      with(kTest, {"--train-cla", "base/train.cla", "--svm", "--metric", "learned", "--quiet"});
  REQUIRE(collection.run(fitted).status == 0);
  const nlohmann::json before = collection.report();
  // Other labels in the test part: distances and predictions stay, so that a model's confusion
  // column does; measures change.
  std::string text = slurp(collection.path("base/test.cla"));
  const auto swap = [&](const std::string& a, const std::string& b) {
    const std::size_t i = text.find("\n" + a + "\n"), j = text.find("\n" + b + "\n");
    text.replace(i + 1, 3, b);
    text.replace(j + 1, 3, a);
  };
  swap("200", "208");
  collection.spill("base/test.cla", text);
  REQUIRE(collection.run(fitted).status == 0);
  const nlohmann::json after = collection.report();
  const auto columns = [](const nlohmann::json& report) {
    std::vector<int> sums(3);
    const nlohmann::json counts = report["groups"][0]["classification"][0]["confusion"];
    for (std::size_t row = 0; row < counts.size(); ++row) {
      for (std::size_t c = 0; c < 3; ++c) sums[c] += counts[row][c + 1].get<int>();
    }
    return sums;
  };
  CHECK(columns(before) == columns(after));
  CHECK(before["groups"][0]["classification"][0]["confusion"] !=
        after["groups"][0]["classification"][0]["confusion"]);
  CHECK(after["kept"] == 48);  // and no model was described again
}

TEST_CASE("evaluate cross-validates by models, by classes and leaving one out", "[evaluate]") {
  Collection collection;
  REQUIRE(collection.run(with(kTest, {"--folds", "4", "--svm", "--weighted", "--quiet"})).status ==
          0);
  CHECK_THAT(collection.report()["protocol"].get<std::string>(),
             Contains("the other 3 of 4 folds alone, parameters included"));
  REQUIRE(collection.run(with(kTest, {"--leave-one-out", "--svm", "--quiet"})).status == 0);
  CHECK(collection.report()["groups"][0]["classification"][0]["correct_rate"].get<double>() > 0.9);
  REQUIRE(collection
              .run(with(kTest,
                        {"--folds", "3", "--fold-by", "class", "--metric", "learned", "--quiet"}))
              .status == 0);
  CHECK_THAT(collection.report()["protocol"].get<std::string>(), Contains("no model of its class"));
}

TEST_CASE("members of the class -1 are no queries in figures without it", "[evaluate]") {
  Collection collection;
  collection.spill("coarse2/coarse2Test.cla",
                   "PSB 1\n3 9\nbox 0 3\n200\n201\n202\nring 0 3\n216\n217\n218\n-1 0 3\n208\n209\n"
                   "210\n");
  collection.spill("coarse2/coarse2Train.cla",
                   "PSB 1\n3 9\nbox 0 3\n100\n101\n102\nring 0 3\n116\n117\n118\n-1 0 3\n108\n109\n"
                   "110\n");
  REQUIRE(collection
              .run(with(kTest, {"--train-cla", "base/train.cla", "--classes", "coarse2", "--svm",
                                "--quiet"}))
              .status == 0);
  const nlohmann::json report = collection.report();
  REQUIRE(report["groups"].size() == 2);
  CHECK(report["groups"][0]["retrieval"][0]["micro"]["queries"] == 9);
  CHECK(report["groups"][1]["retrieval"][0]["micro"]["queries"] == 6);
  CHECK(report["groups"][1]["classification"][0]["models"] == 6);
  CHECK_THAT(slurp(collection.path("out/report.md")),
             Contains("its members are no queries, but stay in the library"));
}

TEST_CASE("evaluate takes other layouts", "[evaluate]") {
  Collection collection;
  collection.spill("flat.cla", "PSB 1\n2 4\nbox 0 2\nA\nB\nring 0 2\nC\nD\n");
  for (const char* name : {"box/A", "box/B"}) {
    collection.write("flat/" + std::string(name) + ".obj", cube());
    collection.write("folders/" + std::string(name) + ".obj", cube());
  }
  for (const char* name : {"ring/C", "ring/D"}) {
    collection.write("flat/" + std::string(name) + ".obj", torus(12, 8));
    collection.write("folders/" + std::string(name) + ".obj", torus(12, 8));
  }
  Run run = collection.run(
      {"--db-dir", "flat", "--test-cla", "flat.cla", "--path", "{class}/{id}.obj", "-o", "out"});
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK(collection.report()["test"]["models"] == 4);
  run = collection.run({"--db-dir", "folders", "--layout", "folders", "-o", "out2"});
  REQUIRE(run.status == 0);
  CHECK(collection.report("out2")["groups"][0]["retrieval"][0]["micro"]["nearest_neighbour"] ==
        1.0);
  for (const char* name : {"box/E", "ring/F"}) {
    const bool is_box = std::string(name) == "box/E";
    const std::string below = is_box ? "box/train/E.obj" : "ring/train/F.obj";
    collection.write("folders/" + below, is_box ? cube() : torus(12, 8));
  }
  run = collection.run({"--db-dir", "folders", "--layout", "folders", "--svm", "-o", "out3"});
  REQUIRE(run.status == 0);
  CHECK(collection.report("out3")["train"]["models"] == 2);
  CHECK(collection.report("out3")["test"]["models"] == 4);
  // The folder above "db" is as good as "db".
  REQUIRE(collection.run({"--db-dir", ".", "--test-cla", "base/test.cla", "-o", "out4"}).status ==
          0);
}

TEST_CASE("models that are missing or cannot be described are named and left out", "[evaluate]") {
  Collection collection;
  fs::remove(collection.path("db/2/m203/m203.off"));
  collection.spill("db/2/m204/m204.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n");
  for (int id = 209; id < 216; ++id) {
    const std::string name = "m" + std::to_string(id);
    fs::remove(collection.path("db/2/" + name + "/" + name + ".off"));
  }
  for (int id = 216; id < 224; ++id) {
    const std::string name = "m" + std::to_string(id);
    fs::remove(collection.path("db/2/" + name + "/" + name + ".off"));
  }
  const Run run = collection.run(kTest);
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.err, Contains("left out: model 203 has no file db/2/m203/m203.off"));
  CHECK_THAT(run.err, Contains("left out: model 204: db/2/m204/m204.off: "));
  CHECK_THAT(run.err, Contains("class \"thing/rod\" has one model, which can find no other"));
  CHECK_THAT(run.err, Contains("class \"thing/ring\" has no model that is there"));
  const nlohmann::json report = collection.report();
  CHECK(report["test"]["models"] == 7);
  CHECK(report["test"]["left_out"].size() == 17);
  CHECK(report["groups"][0]["retrieval"][0]["micro"]["queries"] == 6);
}

TEST_CASE("evaluate refuses bad input with a sentence", "[evaluate][error]") {
  Collection collection;
  collection.refused(2, {"--db-dir", "db", "-o", "out"},
                     "--test-cla is required, or --layout folders");
  collection.refused(1, {"--db-dir", "nowhere", "--test-cla", "base/test.cla", "-o", "out"},
                     "nowhere: does not exist, expected a folder");
  collection.refused(1, {"--db-dir", "db", "--test-cla", "none.cla", "-o", "out"}, "none.cla: ");
  collection.spill("bad.cla", "PSB 1\n1 2\nbox 0 1\n200\n");
  collection.refused(1, {"--db-dir", "db", "--test-cla", "bad.cla", "-o", "out"},
                     "bad.cla: has 1 models, expected 2, the number in its head");
  collection.spill("empty.cla", "PSB 1\n1 0\nbox 0 0\n");
  collection.refused(1, {"--db-dir", "db", "--test-cla", "empty.cla", "-o", "out"},
                     "empty.cla: has no models, expected some");
  collection.spill("far.cla", "PSB 1\n1 1\nbox 0 1\n900\n");
  collection.refused(1, {"--db-dir", "db", "--test-cla", "far.cla", "-o", "out"},
                     "db: has none of the 1 models of far.cla, expected files such as "
                     "db/9/m900/m900.off");
  collection.spill("one.cla", "PSB 1\n1 1\nbox 0 1\n200\n");
  collection.refused(1, {"--db-dir", "db", "--test-cla", "one.cla", "-o", "out"},
                     "one.cla: has 1 models that could be described, expected 2 or more");
  collection.spill("single.cla", "PSB 1\n2 2\nbox 0 1\n200\nrod 0 1\n208\n");
  collection.refused(1, {"--db-dir", "db", "--test-cla", "single.cla", "-o", "out"},
                     "single.cla: no class has two models, expected one at least");
  collection.refused(2, with(kTest, {"--path", "{name}.off"}),
                     "--path {name}.off: has '{name', expected {id}, {id/N}, {class} or "
                     "{class_path}");
  collection.refused(2, with(kTest, {"--path", "{class}.off"}),
                     "--path {class}.off: has no {id}, expected one");
  collection.refused(2, with(kTest, {"--path", "{id/0}.off"}),
                     "--path {id/0}.off: has {id/0}, expected a number such as 100");
  collection.spill("words.cla", "PSB 1\n1 1\nbox 0 1\nA\n");
  collection.refused(2, {"--db-dir", "db", "--test-cla", "words.cla", "-o", "out"},
                     "model \"A\" is not a number, expected one for {id/100}");
  collection.refused(2, with(kTest, {"--classes", "coarse9"}),
                     "--classes coarse9: there is no such class file of base/test.cla, looked for");
  collection.refused(2, with(kTest, {"--svm"}),
                     "--svm: needs models to be fitted to, expected --train-cla, or --folds N or "
                     "--leave-one-out");
  collection.refused(2, with(kTest, {"--metric", "learned"}), "--metric learned: needs models");
  collection.refused(1, with(kTest, {"--train-cla", "base/test.cla"}),
                     "24 models, such as 200, are in base/test.cla and in base/test.cla: expected "
                     "none in both; --folds 5 cross-validates one set");
  collection.refused(2, with(kTest, {"--train-cla", "base/train.cla", "--folds", "2"}),
                     "--train-cla is not used with --folds and --leave-one-out");
  collection.refused(2, with(kTest, {"--folds", "2", "--leave-one-out"}),
                     "--folds and --leave-one-out are both given, expected one of them");
  collection.refused(2, with(kTest, {"--fold-by", "class"}),
                     "--fold-by class: expected with --folds");
  collection.refused(2, with(kTest, {"--folds", "2", "--fold-by", "class", "--svm"}),
                     "--fold-by class: not used with --svm and --weighted");
  collection.refused(2, with(kTest, {"--folds", "4", "--fold-by", "class"}),
                     "--folds 4: expected at most 3, the number of classes of base/test.cla");
  collection.refused(2, with(kTest, {"--descriptor", "zernike"}),
                     "--descriptor zernike: descriptor kind is 'zernike', expected hsh");
  collection.refused(
      2, with(kTest, {"--descriptor", "egi@L9"}),
      "--descriptor egi@L9: @L9: expected L1, L2, L2_squared, chi_squared or cosine");
  collection.refused(2, with(kTest, {"--distance", "far"}), "--distance far: expected L1, L2");
  collection.refused(2, with(kTest, {"--descriptor", "d2:pairs=4000,bins=16"}),
                     "--descriptor d2:pairs=4000,bins=16 is given twice");
  collection.refused(2, with(kTest, {"--layout", "folders"}),
                     "--test-cla: not used with --layout folders");
  collection.refused(1, {"--db-dir", "base", "--layout", "folders", "-o", "out"},
                     "base: has no mesh, expected folders of classes with meshes");
  collection.spill("other.cla", "PSB 1\n2 4\nfrog 0 2\n100\n101\ntoad 0 2\n108\n109\n");
  collection.refused(1, with(kTest, {"--train-cla", "other.cla", "--svm"}),
                     "--svm: no class of base/test.cla has the name of a class of other.cla");
  collection.spill("alone.cla", "PSB 1\n1 2\nbox 0 2\n100\n101\n");
  collection.spill("boxes.cla", "PSB 1\n1 2\nbox 0 2\n200\n201\n");
  collection.refused(
      1,
      {"--db-dir", "db", "--train-cla", "alone.cla", "--test-cla", "boxes.cla", "--svm", "-o",
       "out"},
      "alone.cla: has models of 1 classes, expected 2 or more for --svm and --weighted");
  collection.spill("file", "");
  collection.refused(1, {"--db-dir", "db", "--test-cla", "base/test.cla", "-o", "file"}, "file: ");
}

}  // namespace
