// `train`, `classify` and `map-collection` as a user runs them.
#include <cmath>
#include <fstream>
#include <random>

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

const std::string kSpec = shape3d::descriptors::Descriptor::parse("random:length=6").to_string();

// A folder with tables of generated vectors, in which the program runs.
class Tables {
 public:
  Tables() { options_.folder = folder_.path(); }

  // `count` vectors of each class round a place of its own; files are CLASS/train/NUMBER.off.
  void write(const std::string& name, const std::vector<std::pair<std::string, int>>& classes,
             double spread = 0.3, unsigned seed = 1, const std::string& spec = kSpec) {
    std::mt19937 engine(seed);
    const auto uniform = [&] { return static_cast<double>(engine()) / 4294967296.0 - 0.5; };
    apps::FeatureTable table;
    std::vector<Eigen::RowVectorXd> rows;
    int number = 0;
    for (std::size_t c = 0; c < classes.size(); ++c) {
      for (int i = 0; i < classes[c].second; ++i) {
        const std::string folder = classes[c].first.empty() ? "" : classes[c].first + "/train/";
        table.files.push_back({folder + std::to_string(number++) + ".off", 1, 1});
        Eigen::RowVectorXd row(6);
        for (Eigen::Index j = 0; j < 6; ++j) {
          row(j) = std::sin(2.0 * static_cast<double>(c) + static_cast<double>(j)) +
                   2.0 * spread * uniform();
        }
        rows.push_back(row);
      }
    }
    apps::FeatureSet set{spec, {}};
    set.vectors.resize(static_cast<Eigen::Index>(rows.size()), 6);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      set.vectors.row(static_cast<Eigen::Index>(i)) = rows[i];
    }
    table.sets.push_back(set);
    apps::OutputFile file(path(name));
    apps::write_features(file, *apps::feature_format(name), table);
    file.commit();
  }
  Run run(const std::vector<std::string>& arguments) { return run_shape3d(arguments, options_); }
  // A run that must fail with this status and sentence, and leave nothing behind.
  void refuse(const std::vector<std::string>& arguments, int status, const std::string& sentence) {
    const auto before = listing(folder_.path());
    const Run failed = run(arguments);
    INFO(failed.out);
    CHECK(failed.status == status);
    CHECK_THAT(failed.err, Contains(sentence));
    CHECK(listing(folder_.path()) == before);
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }
  [[nodiscard]] std::string bytes(const std::string& name) const { return slurp(folder_ / name); }
  void spill(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] nlohmann::json json(const std::string& name) const {
    return read_json(folder_ / name);
  }

 private:
  TemporaryFolder folder_;
  RunOptions options_;
};

const std::vector<std::pair<std::string, int>> kThree{{"chair", 20}, {"lamp", 12}, {"table", 30}};

TEST_CASE("train svm makes a model that classify uses", "[train]") {
  Tables tables;
  tables.write("known.h5", kThree);
  tables.write("new.csv", kThree, 0.3, 2);
  const Run trained = tables.run({"train", "svm", "known.h5", "--class-from-folder",
                                  "--probabilities", "-o", "svm.model", "--json", "train.json"});
  INFO(trained.err);
  REQUIRE(trained.status == 0);
  CHECK(trained.err.empty());
  const auto report = tables.json("train.json");
  CHECK(report["command"] == "train svm");
  CHECK(report["descriptor"] == kSpec);
  CHECK(report["classes"] == nlohmann::json::parse(R"([{"name":"chair","models":20},
      {"name":"lamp","models":12},{"name":"table","models":30}])"));
  CHECK(report["search"].size() == 110);
  CHECK(report["cross_validation"]["models"] == 62);
  const double rate = report["cross_validation"]["correct_rate"];
  CHECK(rate > 0.95);
  int diagonal = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    diagonal += report["cross_validation"]["confusion"][c][c].get<int>();
  }
  CHECK(diagonal == report["cross_validation"]["correct"]);
  // What is reported is the best of what was tried.
  double best = 0.0;
  for (const auto& tried : report["search"])
    best = std::max(best, tried["correct_rate"].get<double>());
  CHECK(rate == best);

  const Run classified = tables.run({"classify", "svm.model", "new.csv", "--json", "found.json"});
  INFO(classified.err);
  REQUIRE(classified.status == 0);
  const auto found = tables.json("found.json");
  REQUIRE(found["results"].size() == 62);
  int right = 0;
  for (const auto& result : found["results"]) {
    const std::string file = result["file"];
    right += file.rfind(result["class"].get<std::string>() + "/", 0) == 0 ? 1 : 0;
    double sum = 0.0;
    for (const auto& [name, p] : result["probabilities"].items()) sum += p.get<double>();
    CHECK(sum == Approx(1.0));
  }
  CHECK(right >= 60);
  CHECK_THAT(classified.out, Contains("chair/train/0.off: chair ("));

  // Nothing depends on threads or on the run.
  REQUIRE(tables
              .run({"train", "svm", "known.h5", "--class-from-folder", "--probabilities", "-o",
                    "again.model", "--threads", "1", "--quiet"})
              .out.empty());
  CHECK(tables.bytes("again.model") == tables.bytes("svm.model"));
}

TEST_CASE("train som makes a map that is drawn and used", "[train]") {
  Tables tables;
  tables.write("known.npy", kThree);
  const Run trained =
      tables.run({"train", "som", "known.npy", "--class-from-folder", "--grid", "6x4", "-o",
                  "map.model", "--json", "train.json", "--clusters", "3"});
  INFO(trained.err);
  REQUIRE(trained.status == 0);
  const auto report = tables.json("train.json");
  CHECK(report["purity"] == 1.0);
  CHECK(report["clusters"] == 3);
  CHECK(report["units"].size() == 24);
  CHECK(report["models"].size() == 62);
  int models = 0;
  for (const auto& unit : report["units"]) models += unit["models"].get<int>();
  CHECK(models == 62);

  REQUIRE(tables.run({"classify", "map.model", "known.npy", "--json", "found.json"}).status == 0);
  const auto found = tables.json("found.json");
  for (std::size_t i = 0; i < 62; ++i) {
    CHECK(found["results"][i]["class"] == report["models"][i]["class"]);
    CHECK(found["results"][i]["row"] == report["models"][i]["row"]);
    CHECK(found["results"][i]["column"] == report["models"][i]["column"]);
  }

  const Run drawn =
      tables.run({"map-collection", "map.model", "--picture", "map.png", "--json", "map.json"});
  INFO(drawn.err);
  REQUIRE(drawn.status == 0);
  const auto map = tables.json("map.json");
  CHECK(map["u_matrix"].size() == 11);
  CHECK(map["u_matrix"][0].size() == 7);
  const PngImage image = decode_png(tables.bytes("map.png"));
  CHECK(image.width > 600);
  CHECK(image.height > 600);
  CHECK(image.is(2, 2, {1.0, 1.0, 1.0}));
  // Both ends of the color map are in the U-matrix.
  CHECK(image.count({0.267, 0.005, 0.329}) > 50);
  CHECK(image.count({0.993, 0.906, 0.144}) > 50);

  REQUIRE(tables.run({"map-collection", "map.model", "--picture", "names.png", "--labels", "model"})
              .status == 0);
  CHECK(tables.bytes("names.png") != tables.bytes("map.png"));
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--toroid", "--lattice", "rectangular"},
        {"--sequential", "--random-start", "--scaling", "range"},
        {"--second-level", "ward"}}) {
    std::vector<std::string> arguments{"train", "som", "known.npy", "--grid",
                                       "6x4",   "-o",  "o.model"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Run other = tables.run(arguments);
    INFO(other.err);
    CHECK(other.status == 0);
    CHECK(tables.bytes("o.model") != tables.bytes("map.model"));
    CHECK(tables.run({"map-collection", "o.model", "--picture", "o.png", "-q"}).status == 0);
  }
}

TEST_CASE("train metric keeps what tells classes apart", "[train]") {
  Tables tables;
  tables.write("known.h5", kThree);
  const Run trained = tables.run({"train", "metric", "known.h5", "--class-from-folder", "-o",
                                  "metric.model", "--json", "train.json"});
  INFO(trained.err);
  REQUIRE(trained.status == 0);
  CHECK(tables.json("train.json")["components"] == 6);
  tables.refuse({"classify", "metric.model", "known.h5"}, 1,
                "metric.model: is a metric, expected a model by 'shape3d train svm'");
  tables.refuse({"map-collection", "metric.model", "--picture", "a.png"}, 1,
                "metric.model: is of kind metric, expected a map by 'shape3d train som'");
}

TEST_CASE("classify describes meshes as the model was trained", "[train]") {
  Tables tables;
  std::vector<std::string> describe{"describe", "--descriptor", "d2:pairs=20000,bins=16",
                                    "-o",       "known.h5",     "-q"};
  for (int i = 0; i < 8; ++i) {
    for (const std::string name : {"ring", "box"}) {
      apps::Mesh mesh = name == "ring" ? torus(24 + i, 12, 3.0, 0.6 + 0.05 * i) : cube();
      if (name == "box") mesh.V.col(i % 3) *= 1.0 + 0.1 * i;
      fs::create_directories(tables.path(name));
      const std::string file = name + "/" + std::to_string(i) + ".off";
      apps::write_mesh(tables.path(file), apps::view_of(mesh));
      if (i < 7) describe.push_back(file);
    }
  }
  REQUIRE(tables.run(describe).status == 0);
  REQUIRE(tables
              .run({"train", "svm", "known.h5", "--class-from-folder", "-o", "svm.model", "--C",
                    "8", "--gamma", "0.1"})
              .status == 0);
  // A library of the same meshes makes the same model, byte for byte.
  std::vector<std::string> add{"library",         "add",
                               "known.db",        "--class-from-folder",
                               "--descriptor",    "d2:pairs=20000,bins=16",
                               "--no-thumbnails", "-q"};
  add.insert(add.end(), describe.begin() + 6, describe.end());
  const Run added = tables.run(add);
  INFO(added.err);
  REQUIRE(added.status == 0);
  REQUIRE(tables
              .run({"train", "svm", "known.db", "-o", "library.model", "--C", "8", "--gamma", "0.1",
                    "-q"})
              .status == 0);
  CHECK(tables.bytes("library.model") == tables.bytes("svm.model"));
  const Run refused =
      tables.run({"train", "svm", "known.db", "--class-from-folder", "-o", "x.model"});
  CHECK(refused.status == 2);
  CHECK_THAT(refused.err, Contains("--class-from-folder: not used with a library"));
  const Run other =
      tables.run({"train", "som", "known.db", "--descriptor", "hsh", "-o", "x.model"});
  CHECK(other.status == 1);
  CHECK_THAT(other.err, Contains("known.db: "));
  const Run found = tables.run({"classify", "svm.model", "box/7.off", "ring/7.off"});
  CHECK(found.status == 0);
  CHECK(found.out == "box/7.off: box\nring/7.off: ring\n");

  tables.spill("bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n");
  const Run partly = tables.run({"classify", "svm.model", "bad.off", "ring/7.off"});
  CHECK(partly.status == 1);
  CHECK(partly.out == "ring/7.off: ring\n");
  CHECK_THAT(partly.err, Contains("bad.off: "));
  CHECK_THAT(partly.err, Contains("1 of 2 meshes could not be classified"));
}

TEST_CASE("train refuses sets without classes", "[train]") {
  Tables tables;
  tables.write("none.h5", {{"", 5}});
  tables.write("one.h5", {{"chair", 5}});
  tables.write("singles.h5", {{"a", 1}, {"b", 1}, {"c", 1}});
  for (const std::string kind : {"svm", "metric"}) {
    tables.refuse({"train", kind, "one.h5", "-o", "x.model"}, 1,
                  "one.h5: no model has a class, expected two classes or more; "
                  "--class-from-folder takes them from names");
    tables.refuse({"train", kind, "none.h5", "--class-from-folder", "-o", "x.model"}, 1,
                  "none.h5: no model has a class");
    tables.refuse({"train", kind, "one.h5", "--class-from-folder", "-o", "x.model"}, 1,
                  "one.h5: the only class is \"chair\", expected two classes or more");
  }
  tables.refuse({"train", "svm", "singles.h5", "--class-from-folder", "-o", "x.model"}, 1,
                "singles.h5: every class has a single model, expected classes of two or more");
  tables.write("some.h5", {{"a", 6}, {"b", 6}, {"rare", 1}});
  const Run warned = tables.run({"train", "svm", "some.h5", "--class-from-folder", "--folds", "3",
                                 "--C", "1", "--gamma", "1", "-o", "some.model"});
  CHECK(warned.status == 0);
  CHECK_THAT(warned.err, Contains("1 class has a single model, which cross-validation cannot "
                                  "predict: rare"));
  CHECK_THAT(warned.out, Contains("of 12 in 3-fold"));
  // A map needs no classes.
  const Run map = tables.run({"train", "som", "none.h5", "--grid", "2x2", "-o", "map.model"});
  CHECK(map.status == 0);
  CHECK(tables.run({"map-collection", "map.model", "--picture", "map.png"}).status == 0);
  const Run where = tables.run({"classify", "map.model", "none.h5"});
  CHECK(where.status == 0);
  CHECK_THAT(where.out, Contains("0.off: -, unit "));
}

TEST_CASE("models that cannot be used are refused with a sentence", "[train]") {
  Tables tables;
  tables.write("known.h5", kThree);
  REQUIRE(tables
              .run({"train", "svm", "known.h5", "--class-from-folder", "--C", "1", "--gamma", "1",
                    "-o", "svm.model"})
              .status == 0);
  const std::string bytes = tables.bytes("svm.model");
  std::string changed = bytes;
  changed[bytes.size() / 2] = static_cast<char>(changed[bytes.size() / 2] ^ 1);
  tables.spill("changed.model", changed);
  tables.refuse({"classify", "changed.model", "known.h5"}, 1,
                "changed.model: the model is damaged: its check sum is not that of its bytes");
  tables.spill("cut.model", bytes.substr(0, bytes.size() / 2));
  tables.refuse({"classify", "cut.model", "known.h5"}, 1, "cut.model: the model is damaged");
  changed = bytes;
  changed[16] = 9;
  tables.spill("later.model", changed);
  tables.refuse({"map-collection", "later.model", "--picture", "x.png"}, 1,
                "later.model: the model is of version 9 of the format, expected 1");
  tables.refuse({"classify", "known.h5", "known.h5"}, 1,
                "known.h5: it does not begin as a model does");
  tables.refuse({"classify", "absent.model", "known.h5"}, 1, "absent.model: ");
  tables.spill("empty.model", "");
  tables.refuse({"classify", "empty.model", "known.h5"}, 1, "empty.model: ");
  tables.refuse({"map-collection", "svm.model", "--picture", "x.png"}, 1,
                "svm.model: is of kind svm, expected a map by 'shape3d train som'");

  tables.write("other.h5", kThree, 0.3, 1,
               shape3d::descriptors::Descriptor::parse("random:length=6,seed=2").to_string());
  tables.refuse({"classify", "svm.model", "other.h5"}, 1,
                "expected " + kSpec + ", which the model was trained on");
  tables.refuse({"classify", "svm.model", "known.h5", "a.off"}, 2,
                "expected meshes, or one table of vectors and nothing else");
}

TEST_CASE("train refuses command lines that make no sense", "[train]") {
  Tables tables;
  tables.write("known.h5", kThree);
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"train", "svm", "known.h5"}, "--output is required"},
      {{"train", "svm", "known.txt", "-o", "x"}, "known.txt: expected a library (.db) or a table"},
      {{"train", "svm", "known.h5", "--class-from-folder", "--folds", "63", "-o", "x"},
       "--folds 63: expected at most 62"},
      {{"train", "svm", "known.h5", "--C", "0", "-o", "x"}, "--C"},
      {{"train", "svm", "known.h5", "--kernel", "cubic", "-o", "x"}, "--kernel"},
      {{"train", "som", "known.h5", "--grid", "12", "-o", "x"}, "expected ROWSxCOLUMNS"},
      {{"train", "som", "known.h5", "--grid", "0x6", "-o", "x"}, "--grid: rows is 0"},
      {{"train", "som", "known.h5", "--grid", "5x6", "--toroid", "-o", "x"},
       "--grid: rows is 5, expected an even number"},
      {{"train", "som", "known.h5", "--grid", "2x2", "--clusters", "5", "-o", "x"},
       "--clusters 5: expected at most"},
      {{"train", "som", "known.h5", "--descriptor", "phrenology", "-o", "x"},
       "--descriptor phrenology: "},
      {{"train", "tree", "known.h5", "-o", "x"},
       "unknown command 'tree', expected svm, som or metric"},
  };
  for (const auto& [arguments, sentence] : wrong) {
    INFO(sentence);
    tables.refuse(arguments, 2, sentence);
  }
  tables.refuse({"train", "som", "known.h5", "--descriptor", "d2", "-o", "x"}, 1,
                "known.h5: has no vectors of d2");
  tables.refuse({"train", "som", "known.h5", "-o", "absent/x.model"}, 1, "absent/x.model: ");
  tables.refuse({"train", "som", "absent.h5", "-o", "x.model"}, 1, "absent.h5: ");
  // An existing model stays when training fails.
  tables.spill("x.model", "as it was");
  CHECK(tables.run({"train", "svm", "known.h5", "-o", "x.model"}).status == 1);
  CHECK(tables.bytes("x.model") == "as it was");
}

}  // namespace
