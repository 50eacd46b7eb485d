#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "common/mesh_io.hpp"
#include "common/shape_library.hpp"
#include "mesh_families.hpp"
#include "png_image.hpp"
#include "program_run.hpp"
#include "support/test_data.hpp"

namespace {
using namespace shape3d::test;
namespace apps = shape3d::apps;
namespace fs = std::filesystem;
using Catch::Matchers::Contains;

// A small collection: tori of a family and boxes of another, in a folder for each class.
class Collection {
 public:
  Collection() {
    options_.folder = folder_.path();
    for (const char* name : {"meshes/ring", "meshes/box"}) fs::create_directories(folder_ / name);
    for (int i = 0; i < 5; ++i) {
      write("meshes/ring/t" + std::to_string(i + 1) + ".off", torus(20, 10, 3.0, 0.8 + 0.1 * i));
      apps::Mesh box = cube();
      box.V.col(0) *= 1.0 + 0.2 * i;
      write("meshes/box/b" + std::to_string(i + 11) + ".off", box);
    }
  }
  void write(const std::string& name, const apps::Mesh& mesh) const {
    apps::write_mesh((folder_ / name).string(), apps::view_of(mesh));
  }
  void spill(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  [[nodiscard]] Run run(const std::vector<std::string>& arguments) const {
    return run_shape3d(arguments, options_);
  }
  [[nodiscard]] Run good(const std::vector<std::string>& arguments) const {
    Run result = run(arguments);
    INFO(result.out << result.err);
    REQUIRE(result.status == 0);
    return result;
  }
  // The usual library: two classes, one short descriptor, no pictures.
  void make(const std::vector<std::string>& more = {"--no-thumbnails"}) const {
    std::vector<std::string> arguments{"library",
                                       "add",
                                       "a.db",
                                       "meshes",
                                       "--descriptor",
                                       "hsh:K=4,voxels=32",
                                       "--class-from-folder"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    static_cast<void>(good(arguments));
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] nlohmann::json json(const std::string& name) const { return read_json(path(name)); }
  [[nodiscard]] apps::ShapeLibrary library() const {
    return {path("a.db").string(), apps::ShapeLibrary::Access::read};
  }
  RunOptions& options() { return options_; }

  // Refuses, with the sentence, and leaves the folder as it was.
  void refuses(int status, const std::vector<std::string>& arguments,
               const std::string& sentence) const {
    const std::vector<std::string> before = listing(path(""));
    const Run result = run(arguments);
    std::string command;
    for (const std::string& argument : arguments) command += " " + argument;
    INFO("shape3d" << command << "\n" << result.out << result.err);
    CHECK(result.status == status);
    CHECK(result.out.empty());
    CHECK_THAT(result.err, Contains(sentence));
    CHECK(result.err.rfind("shape3d: ", 0) == 0);
    CHECK(listing(path("")) == before);
  }

 private:
  TemporaryFolder folder_;
  RunOptions options_;
};

TEST_CASE("a library is made, listed, searched and exported", "[library]") {
  const Collection collection;
  const Run add =
      collection.good({"library", "add", "a.db", "meshes", "--descriptor", "hsh:K=4,voxels=32",
                       "--descriptor", "egi:K=4", "--class-from-folder", "--json", "add.json"});
  CHECK_THAT(add.out, Contains("added") && Contains("thumbnails"));
  nlohmann::json report = collection.json("add.json");
  CHECK(report["added"] == 10);
  CHECK(report["thumbnails"] == 10);
  CHECK(report["models"] == 10);
  CHECK(report["failed"].empty());

  const Run list = collection.good({"library", "list", "a.db", "--json", "list.json"});
  CHECK_THAT(list.out, Contains("ring") && Contains("b11.off"));
  report = collection.json("list.json");
  REQUIRE(report["models"].size() == 10);
  CHECK(report["models"][0]["class"] == "box");
  CHECK(report["models"][0]["triangles"] == 12);
  CHECK(fs::path(report["models"][0]["file"].get<std::string>()).is_absolute());
  CHECK_THAT(collection.good({"library", "list", "a.db", "--class", "ring"}).out,
             Contains("t1.off") && !Contains("b11.off"));

  const Run info = collection.good({"library", "info", "a.db", "--json", "info.json"});
  CHECK_THAT(info.out, Contains("15 numbers, 10 models") && Contains("classes"));
  report = collection.json("info.json");
  CHECK(report["version"] == 1);
  CHECK(report["thumbnails"] == 10);
  CHECK(report["classes"][1] == nlohmann::json{{"name", "ring"}, {"models", 5}});
  CHECK(report["descriptors"][1]["spec"] == "egi:K=4,align=none");
  static_cast<void>(collection.good({"library", "info", "a.db", "--id", "3", "--json", "3.json"}));
  report = collection.json("3.json");
  CHECK(report["descriptors"][0]["vector"].size() == 15);
  CHECK(report["thumbnail"] == true);

  // The stored vectors are those of `describe`.
  static_cast<void>(collection.good({"library", "export", "a.db", "--npy", "a.npy", "--descriptor",
                                     "egi:K=4", "--descriptor", "hsh:K=4,voxels=32"}));
  static_cast<void>(collection.good({"library", "export", "a.db", "--csv", "a.csv"}));
  static_cast<void>(collection.good({"library", "export", "a.db", "--h5", "a.h5"}));
  static_cast<void>(
      collection.good({"describe", "meshes/ring/t2.off", "--descriptor", "hsh:K=4,voxels=32",
                       "--descriptor", "egi:K=4", "-o", "t2.npy"}));
  const apps::FeatureTable stored = apps::read_features(collection.path("a.npy").string()),
                           described = apps::read_features(collection.path("t2.npy").string());
  REQUIRE(stored.files.size() == 10);
  CHECK(stored.sets[0].spec == "egi:K=4,align=none");
  CHECK(stored.classes[6] == "ring");
  CHECK(stored.sets[1].vectors.row(6) == described.sets[0].vectors.row(0));
  CHECK(stored.sets[0].vectors.row(6) == described.sets[1].vectors.row(0));
  for (const char* name : {"a.csv", "a.h5"}) {
    const apps::FeatureTable table = apps::read_features(collection.path(name).string());
    CHECK(table.classes == stored.classes);
    CHECK(table.files == stored.files);
    CHECK(table.sets[0].vectors == stored.sets[1].vectors);
  }
  CHECK_THAT(collection.good({"library", "check", "a.db"}).out, Contains("none"));
}

TEST_CASE("search finds what is alike, and not the query itself", "[library][search]") {
  const Collection collection;
  collection.make();
  fs::create_directory(collection.path("queries"));
  fs::copy_file(collection.path("meshes/ring/t3.off"), collection.path("queries/copy.off"));
  collection.write("queries/new.off", torus(22, 11, 3.0, 1.02));
  static_cast<void>(
      collection.good({"search", "a.db", "queries/new.off", "-n", "5", "--json", "new.json"}));
  nlohmann::json report = collection.json("new.json");
  REQUIRE(report["found"].size() == 5);
  CHECK(report["id"] == nullptr);
  double before = 0.0;
  for (const auto& found : report["found"]) {
    CHECK(found["class"] == "ring");
    CHECK(found["distance"] >= before);
    before = found["distance"];
  }
  // The query is in the library: by its content, or by its number.
  const Run copy = collection.good({"search", "a.db", "queries/copy.off", "--json", "copy.json"});
  CHECK_THAT(copy.out, Contains("model 8, which is left out of what is found"));
  CHECK_THAT(copy.err, Contains("there are 9 models to find, fewer than -n 11"));
  static_cast<void>(collection.good({"search", "a.db", "--id", "8", "--json", "id.json"}));
  const nlohmann::json by_copy = collection.json("copy.json"), by_id = collection.json("id.json");
  CHECK(by_copy["id"] == 8);
  CHECK(by_copy["class"] == "ring");
  CHECK(by_copy["found"] == by_id["found"]);
  REQUIRE(by_id["found"].size() == 9);
  for (const auto& found : by_id["found"]) CHECK(found["id"] != 8);
  // Distances are those of the definition.
  const apps::LibraryVectors vectors = collection.library().vectors(by_id["descriptor"]);
  for (const auto& found : by_id["found"]) {
    const Eigen::Index row = found["id"].get<Eigen::Index>() - 1;
    CHECK(found["distance"].get<double>() ==
          Approx((vectors.vectors.row(row) - vectors.vectors.row(7)).norm()));
  }
  static_cast<void>(collection.good(
      {"search", "a.db", "--id", "8", "--distance", "L1", "-n", "1", "--json", "l1.json"}));
  const auto first = collection.json("l1.json")["found"][0];
  const Eigen::Index row = first["id"].get<Eigen::Index>() - 1;
  CHECK(first["distance"].get<double>() ==
        Approx((vectors.vectors.row(row) - vectors.vectors.row(7)).lpNorm<1>()));
}

TEST_CASE("the class-weighted search draws the probable class near", "[library][search]") {
  const Collection collection;
  collection.make();
  // Between the two families, so that both are among its neighbours.
  apps::Mesh query = torus(20, 10, 3.0, 0.8);
  query.V.col(2) *= 2.5;
  collection.write("query.off", query);
  static_cast<void>(collection.good(
      {"search", "a.db", "query.off", "-n", "10", "--weighted", "--json", "w.json"}));
  static_cast<void>(
      collection.good({"search", "a.db", "query.off", "-n", "10", "--json", "p.json"}));
  const nlohmann::json weighted = collection.json("w.json"), plain = collection.json("p.json");
  std::map<std::string, double> shares;
  for (const auto& entry : weighted["probable_classes"]) {
    shares[entry["class"]] = entry["probability"];
  }
  CHECK(shares["ring"] + shares["box"] == Approx(1.0));
  std::map<int, double> distances;
  for (const auto& found : plain["found"]) distances[found["id"]] = found["distance"];
  REQUIRE(weighted["found"].size() == 10);
  double before = 0.0;
  for (const auto& found : weighted["found"]) {
    const double d = distances.at(found["id"]),
                 w = 1.0 - 0.75 * shares.at(found["class"].get<std::string>());
    CHECK(found["distance"].get<double>() == Approx(w * d * d));
    CHECK(found["distance"].get<double>() >= before);
    before = found["distance"];
  }
  // The class of the query is not looked at: said or not, the same is found.
  static_cast<void>(collection.good({"search", "a.db", "query.off", "-n", "10", "--weighted",
                                     "--class", "ring", "--json", "c.json"}));
  CHECK(collection.json("c.json")["found"] == weighted["found"]);
  // No classes, no weights.
  static_cast<void>(collection.good(
      {"library", "add", "b.db", "meshes", "--descriptor", "egi:K=4", "--no-thumbnails"}));
  collection.refuses(1, {"search", "b.db", "--id", "3", "--weighted"},
                     "b.db: knows no class of a model, which the class-weighted distance needs");
}

TEST_CASE("from coarse to fine finds what is on the shortlist", "[library][search]") {
  const Collection collection;
  collection.make({"--no-thumbnails", "--descriptor", "egi:K=4"});
  const auto found_by = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"search", "a.db", "--id", "2", "--json", "f.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    static_cast<void>(collection.good(arguments));
    return collection.json("f.json");
  };
  const nlohmann::json fine = found_by({"-n", "4"}),
                       coarse = found_by({"-n", "9", "--descriptor", "egi:K=4"});
  // A shortlist of all: the same as without. A short one: its best.
  CHECK(found_by({"-n", "4", "--coarse", "egi:K=4"})["found"] == fine["found"]);
  const nlohmann::json five = found_by({"-n", "4", "--coarse", "egi:K=4", "--shortlist", "5"});
  CHECK(five["shortlist"] == 5);
  std::vector<std::pair<double, int>> expected;
  const nlohmann::json all = found_by({"-n", "9"});
  for (std::size_t i = 0; i < 5; ++i) {
    for (const auto& entry : all["found"]) {
      if (entry["id"] == coarse["found"][i]["id"]) {
        expected.emplace_back(entry["distance"].get<double>(), entry["id"].get<int>());
      }
    }
  }
  std::sort(expected.begin(), expected.end());
  REQUIRE(five["found"].size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(five["found"][i]["id"] == expected[i].second);
  collection.refuses(2, {"search", "a.db", "--id", "2", "--shortlist", "20"},
                     "--shortlist: expected with --coarse SPEC");
  collection.refuses(2, {"search", "a.db", "--id", "2", "--coarse", "egi:K=4", "--shortlist", "5"},
                     "--shortlist 5: expected at least -n 11");
  collection.refuses(2, {"search", "a.db", "--id", "2", "--coarse", "egi:K=4", "--weighted"},
                     "--weighted: not used with --coarse");
  collection.refuses(2, {"search", "a.db", "--id", "2", "--coarse", "x"}, "--coarse x: ");
  collection.refuses(1, {"search", "a.db", "--id", "2", "--coarse", "d2"},
                     "a.db: has no vectors by 'd2");
}

TEST_CASE("the sheet frames the query, its class and others", "[library][search][picture]") {
  const Collection collection;
  collection.make({});
  static_cast<void>(collection.good({"search", "a.db", "--id", "8", "--sheet", "a.png"}));
  const PngImage picture = decode_png(slurp(collection.path("a.png")));
  // 10 cells of 268 pixels, frames 6 wide: 4 in a row, 3 rows.
  CHECK(picture.width == 4 * (268 + 14) + 14);
  const std::int64_t frame = 268 * 268 - 256 * 256;
  CHECK(picture.count({0.10, 0.62, 0.22}) == Approx(frame).epsilon(0.02));
  CHECK(picture.count({0.13, 0.36, 0.86}) == Approx(4 * frame).epsilon(0.02));
  CHECK(picture.count({0.85, 0.16, 0.14}) == Approx(5 * frame).epsilon(0.02));
  // Without pictures in the library they are drawn now; without classes frames are grey.
  static_cast<void>(collection.good(
      {"library", "add", "b.db", "meshes/ring", "--descriptor", "egi:K=4", "--no-thumbnails"}));
  collection.write("query.off", cube());
  fs::remove(collection.path("meshes/ring/t1.off"));
  static_cast<void>(
      collection.good({"search", "b.db", "query.off", "-n", "3", "--sheet", "b.png"}));
  const PngImage plain = decode_png(slurp(collection.path("b.png")));
  CHECK(plain.count({0.10, 0.62, 0.22}) == Approx(frame).epsilon(0.02));
  CHECK(plain.count({0.62, 0.62, 0.62}) > 2.9 * static_cast<double>(frame));  // and some clay
  CHECK(plain.count({0.13, 0.36, 0.86}) + plain.count({0.85, 0.16, 0.14}) == 0);
  static_cast<void>(collection.good(
      {"search", "a.db", "query.off", "--class", "box", "-n", "3", "--sheet", "c.png"}));
  CHECK(decode_png(slurp(collection.path("c.png"))).count({0.13, 0.36, 0.86}) > frame);
}

TEST_CASE("what is there already is kept, what changed is described anew", "[library]") {
  const Collection collection;
  collection.make();
  const auto report_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"library",         "add",    "a.db",  "meshes",
                                       "--no-thumbnails", "--json", "r.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    static_cast<void>(collection.good(arguments));
    return collection.json("r.json");
  };
  nlohmann::json report = report_of({});
  CHECK(report["kept"] == 10);
  CHECK(report["added"] == 0);
  CHECK(collection.library().model(1)->class_name == "box");  // classes stay
  // Another time of the file, the same content.
  const fs::path ring = collection.path("meshes/ring/t1.off");
  fs::last_write_time(ring, fs::last_write_time(ring) + std::chrono::hours(1));
  CHECK(report_of({})["kept"] == 10);
  // Another content.
  const Eigen::VectorXd before =
      *collection.library().vector(6, collection.library().descriptor("").spec);
  collection.write("meshes/ring/t1.off", torus(20, 10, 3.0, 2.0));
  report = report_of({});
  CHECK(report["kept"] == 9);
  CHECK(report["described_anew"] == 1);
  CHECK(*collection.library().vector(6, collection.library().descriptor("").spec) != before);
  // One more descriptor, for all.
  report = report_of({"--descriptor", "egi:K=3"});
  CHECK(report["described_anew"] == 10);
  REQUIRE(collection.library().descriptors().size() == 2);
  CHECK(collection.library().descriptors()[1].models == 10);
  // Both are what is missing of a new model.
  collection.write("meshes/ring/t9.off", torus(20, 10, 3.0, 1.5));
  CHECK(report_of({})["added"] == 1);
  CHECK(collection.library().descriptors()[0].models == 11);
  CHECK(collection.library().descriptors()[1].models == 11);
  // The same content under another name is another model.
  fs::copy_file(ring, collection.path("meshes/ring/t10.off"));
  CHECK(report_of({})["same_content"] == 1);
  CHECK(collection.library().size() == 12);
}

TEST_CASE("classes are those of a class file", "[library]") {
  const Collection collection;
  const auto cla = [](const std::string& ring, const std::string& box, const std::string& rest) {
    return "PSB 1\n5 13\n\nthing 0 0\n\nring thing " + ring + "\nbox thing " + box + rest;
  };
  collection.spill("a.cla", cla("5\n1\n2\n3\n4\n5\n", "4\n11\n12\n13\n77\n",
                                "\nlonely 0 1\n14\n\ngone 0 3\n97\n98\n99\n"));
  const Run run = collection.good({"library", "add", "a.db", "meshes", "--classes", "a.cla",
                                   "--descriptor", "egi:K=4", "--no-thumbnails"});
  CHECK_THAT(run.err,
             Contains("a.cla: 4 models are not among the meshes: 77, 97, 98 and 1 more") &&
                 Contains("a.cla: 1 classes have no mesh: gone") &&
                 Contains("a.cla: 1 classes have a single mesh, which has nothing to be found: "
                          "lonely") &&
                 Contains("a.cla: 1 meshes are not in it"));
  using Counts = std::vector<std::pair<std::string, std::int64_t>>;
  CHECK(collection.library().classes() ==
        Counts{{"lonely", 1}, {"thing/box", 3}, {"thing/ring", 5}});
  CHECK_FALSE(collection.library().model(5)->class_name);  // b15
  // Another file changes the classes, and describes nothing anew.
  collection.spill("b.cla", "PSB 1\n2 2\n\nround 0 1\n1\n\n-1 0 1\n2\n");
  static_cast<void>(collection.good({"library", "add", "a.db", "meshes", "--classes", "b.cla",
                                     "--no-thumbnails", "--json", "r.json"}));
  CHECK(collection.json("r.json")["kept"] == 10);
  CHECK(collection.library().model(6)->class_name == "round");
  CHECK(collection.library().model(7)->class_name == "thing/ring");  // not of a class: as it was
  collection.spill("none.cla", "PSB 1\n1 1\n\nx 0 1\n555\n");
  collection.refuses(1, {"library", "add", "a.db", "meshes", "--classes", "none.cla"},
                     "none.cla: names none of the 10 meshes");
  collection.spill("bad.cla", "PSB 1\n1 2\n\nx 0 1\n1\n");
  collection.refuses(1, {"library", "add", "a.db", "meshes", "--classes", "bad.cla"}, "bad.cla: ");
  collection.refuses(1, {"library", "add", "a.db", "meshes", "--classes", "absent.cla"},
                     "absent.cla: no such file");
  collection.refuses(
      2, {"library", "add", "a.db", "meshes", "--classes", "a.cla", "--class-from-folder"},
      "excludes");
}

TEST_CASE("models are removed by number, by path, and when they are gone", "[library]") {
  const Collection collection;
  collection.make();
  static_cast<void>(collection.good(
      {"library", "remove", "a.db", "1", "meshes/ring/t1.off", "--json", "r.json"}));
  CHECK(collection.json("r.json")["removed"].size() == 2);
  CHECK(collection.library().size() == 8);
  collection.refuses(1, {"library", "remove", "a.db", "2", "1"}, "a.db: has no model 1");
  CHECK(collection.library().size() == 8);
  collection.refuses(2, {"library", "remove", "a.db"}, "no model is named");
  fs::remove(collection.path("meshes/ring/t2.off"));
  collection.spill("meshes/ring/t3.off", "OFF\n");
  const Run check = collection.run({"library", "check", "a.db", "--json", "c.json"});
  CHECK(check.status == 1);
  CHECK_THAT(check.err, Contains("t2.off: no such file") &&
                            Contains("t3.off: is not the file that was described") &&
                            Contains("shape3d: a.db: 1 missing files, 1 changed files"));
  CHECK(collection.json("c.json")["faults"].size() == 2);
  static_cast<void>(collection.good({"library", "check", "a.db", "--no-files"}));
  static_cast<void>(collection.good({"library", "remove", "a.db", "--missing"}));
  CHECK(collection.library().size() == 7);
}

TEST_CASE("meshes that cannot be described are left out and named", "[library][error]") {
  const Collection collection;
  collection.spill("meshes/bad.off", "OFF\n3 1 0\n0 0 0\n");
  collection.spill("meshes/flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
  const std::vector<std::string> arguments{"library",
                                           "add",
                                           "a.db",
                                           "meshes",
                                           "absent.off",
                                           "--descriptor",
                                           "egi:K=4",
                                           "--no-thumbnails",
                                           "--class-from-folder"};
  const Run run = collection.run(arguments);
  CHECK(run.status == 1);
  CHECK_THAT(run.err, Contains("meshes/bad.off: ") && Contains("meshes/flat.off: ") &&
                          Contains("absent.off: no such file") &&
                          Contains("3 of 13 meshes could not be described; --keep-going makes "
                                   "that no failure"));
  CHECK(collection.library().size() == 10);
  std::vector<std::string> again = arguments;
  again.emplace_back("--keep-going");
  CHECK(collection.run(again).status == 0);
  // None at all: no library.
  CHECK(collection.run({"library", "add", "b.db", "absent.off"}).status == 1);
  CHECK_FALSE(fs::exists(collection.path("b.db")));
}

TEST_CASE("library and search refuse contradictions and what is not there", "[library][error]") {
  const Collection collection;
  fs::create_directory(collection.path("empty"));
  const auto refuses = [&](int status, const std::vector<std::string>& arguments,
                           const std::string& sentence) {
    collection.refuses(status, arguments, sentence);
  };
  refuses(2, {"library"}, "'library' is not all of a command, expected add, list,");
  refuses(2, {"library", "add", "a.db"}, "MESH is required");
  refuses(2, {"library", "add", "a.db", "meshes", "--descriptor", "egi:Q=4"},
          "--descriptor egi:Q=4: descriptor key is 'Q'");
  refuses(2, {"library", "add", "a.db", "meshes", "--descriptor", "d2", "--descriptor", "d2"},
          "--descriptor d2 is given twice");
  refuses(1, {"library", "add", "a.db", "empty"}, "empty: holds no mesh, expected files .ply");
  refuses(1, {"library", "add", "none/a.db", "meshes"}, "none/a.db: cannot be written");
  refuses(1, {"library", "list", "a.db"}, "a.db: no such file");
  refuses(1, {"search", "a.db", "meshes/box/b11.off"}, "a.db: no such file");
  collection.spill("text.db", "no database at all, but text");
  for (const std::string command : {"list", "info", "check"}) {
    refuses(1, {"library", command, "text.db"}, "text.db: is not a shape library, or damaged");
  }
  refuses(1, {"library", "add", "text.db", "meshes"},
          "text.db: is not a shape library, or damaged");
  refuses(1, {"search", "text.db", "meshes/box/b11.off"}, "text.db: is not a shape library");

  collection.make();
  refuses(2, {"search", "a.db"}, "no query is named, expected a mesh or --id N");
  refuses(2, {"search", "a.db", "meshes/box/b11.off", "--id", "3"}, "not both");
  refuses(2, {"search", "a.db", "--id", "3", "--sheet", "a.jpg"},
          "--sheet a.jpg: expected a name that ends in .png");
  refuses(2, {"search", "a.db", "--id", "3", "--descriptor", "zernike"},
          "--descriptor zernike: descriptor kind is 'zernike'");
  refuses(2, {"search", "a.db", "--id", "3", "-n", "0"}, "0");
  refuses(2, {"search", "a.db", "--id", "3", "--distance", "L3"}, "L3");
  refuses(1, {"search", "a.db", "--id", "99"}, "a.db: has no model 99");
  refuses(1, {"search", "a.db", "--id", "3", "--descriptor", "hsh:K=5,voxels=32"},
          "a.db: has no vectors by 'hsh:map=equal_volume,K=5");
  refuses(1, {"search", "a.db", "--id", "3", "--descriptor", "hsh:K=5,voxels=32"},
          "K is 5 in one and 4 in the other");
  refuses(1, {"search", "a.db", "absent.off"}, "absent.off: no such file");
  refuses(1, {"search", "a.db", "query.stp"}, "query.stp: unknown extension '.stp'");
  collection.spill("broken.off", "OFF\n1 1 0\n0 0 0\n3 0 1 2\n");
  refuses(1, {"search", "a.db", "broken.off"}, "broken.off: ");
  collection.spill("flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
  refuses(1, {"search", "a.db", "flat.off"}, "flat.off: ");
  refuses(1, {"search", "a.db", "--id", "3", "--sheet", "none/a.png"}, "none/a.png: the directory");
  refuses(1, {"library", "info", "a.db", "--id", "99"}, "a.db: has no model 99");
  refuses(1, {"library", "list", "a.db", "--class", "cat"}, "a.db: has no model of class 'cat'");
  refuses(2, {"library", "export", "a.db"}, "no file is named, expected --npy, --csv or --h5");
  refuses(2, {"library", "export", "a.db", "--npy", "a.csv"},
          "--npy a.csv: expected a name that ends in .npy");
  refuses(2, {"library", "export", "a.db", "--npy", "a.npy", "--csv", "a.csv"},
          "expected one of --npy, --csv and --h5");
  refuses(1, {"library", "export", "a.db", "--npy", "a.npy", "--descriptor", "d2"},
          "a.db: has no vectors by 'd2");
  // Models that have not all descriptors are left out of a table, and cannot be the query.
  static_cast<void>(collection.good(
      {"library", "add", "a.db", "meshes/box", "--descriptor", "egi:K=4", "--no-thumbnails"}));
  const Run run = collection.good({"library", "export", "a.db", "--npy", "a.npy", "--descriptor",
                                   "egi:K=4", "--descriptor", "hsh:K=4,voxels=32"});
  CHECK_THAT(run.err, Contains("warning: 5 models are left out"));
  refuses(1, {"search", "a.db", "--id", "7", "--descriptor", "egi:K=4"},
          "a.db: has no vector of model 7 by 'egi:K=4,align=none'");
}

TEST_CASE("a library in a folder that cannot be written is read, and not written",
          "[library][error]") {
  Collection collection;
  collection.make();
  // No folder is read-only for root: the program then runs as another user.
  if (geteuid() == 0) collection.options().user = 65534;
  fs::permissions(collection.path(""), fs::perms::owner_read | fs::perms::owner_exec |
                                           fs::perms::others_read | fs::perms::others_exec);
  fs::permissions(collection.path("a.db"), fs::perms::others_read, fs::perm_options::add);
  if (collection.run({"--version"}).status != 0) {
    WARN("the program cannot be run by another user here");
    fs::permissions(collection.path(""), fs::perms::owner_all);
    return;
  }
  CHECK(collection.run({"search", "a.db", "--id", "3"}).status == 0);
  collection.refuses(1, {"library", "add", "a.db", "meshes"}, "a.db: cannot be written: ");
  collection.refuses(1, {"library", "add", "b.db", "meshes"}, "b.db: cannot be written: ");
  collection.refuses(1, {"library", "remove", "a.db", "3"}, "a.db: cannot be written: ");
  fs::permissions(collection.path(""), fs::perms::owner_all);
}

TEST_CASE("a run that is killed loses only what it was at", "[library]") {
  Collection collection;
  const int count = 400;
  fs::create_directory(collection.path("many"));
  for (int i = 0; i < count; ++i) {
    collection.write("many/m" + std::to_string(1000 + i) + ".off",
                     torus(24, 12, 3.0, 0.5 + 0.002 * i));
  }
  const std::vector<std::string> arguments{"library",      "add",          "a.db",
                                           "many",         "--descriptor", "hsh:K=4,voxels=32",
                                           "--descriptor", "egi:K=4",      "--no-thumbnails"};
  // Killed again and again, until a run comes to its end.
  int kills = 0;
  std::int64_t before = 0;
  for (;; ++kills) {
    REQUIRE(kills < 100);
    std::thread killer;
    collection.options().while_running = [&](int process) {
      killer = std::thread([process, kills] {
        std::this_thread::sleep_for(std::chrono::milliseconds(250 + 37 * kills));
        kill(process, SIGKILL);
      });
    };
    const Run run = collection.run(arguments);
    killer.join();
    if (run.status == 0) break;
    REQUIRE(run.status == 128 + SIGKILL);
    if (!fs::exists(collection.path("a.db"))) continue;
    collection.options().while_running = nullptr;
    const Run check = collection.run({"library", "check", "a.db", "--json", "c.json"});
    INFO(check.out << check.err);
    REQUIRE(check.status == 0);
    CHECK(collection.json("c.json")["clean"] == true);
    const apps::ShapeLibrary library = collection.library();
    CHECK(library.size() >= before);  // nothing that was stored is lost
    before = library.size();
    // Each model has both vectors, or is not there.
    for (const apps::LibraryDescriptor& descriptor : library.descriptors()) {
      CHECK(descriptor.models == before);
    }
  }
  CHECK(kills > 0);
  collection.options().while_running = nullptr;
  CHECK(collection.library().size() == count);
  static_cast<void>(collection.good({"library", "check", "a.db"}));
  // The same as in one run.
  static_cast<void>(collection.good({"library", "add", "b.db", "many", "--descriptor",
                                     "hsh:K=4,voxels=32", "--no-thumbnails", "--threads", "1"}));
  static_cast<void>(collection.good({"library", "export", "a.db", "--npy", "a.npy"}));
  static_cast<void>(collection.good({"library", "export", "b.db", "--npy", "b.npy"}));
  const apps::FeatureTable a = apps::read_features(collection.path("a.npy").string()),
                           b = apps::read_features(collection.path("b.npy").string());
  CHECK(a.files == b.files);  // in one order, too: the ids are the same
  CHECK(a.sets[0].vectors == b.sets[0].vectors);
}

TEST_CASE("a second writer is told so, readers are not in the way", "[library][error]") {
  const Collection collection;
  collection.make();
  const apps::ShapeLibrary writer(collection.path("a.db").string(),
                                  apps::ShapeLibrary::Access::write);
  const Run add = collection.run({"library", "add", "a.db", "meshes"});
  CHECK(add.status == 1);
  CHECK_THAT(add.err, Contains("a.db: is being written by another process; try again when it has "
                               "ended"));
  static_cast<void>(collection.good({"search", "a.db", "--id", "3"}));
}

TEST_CASE("a full disk leaves a library that is sound", "[library][error]") {
  Collection collection;
  collection.make();
  collection.options().file_size_limit = fs::file_size(collection.path("a.db")) + 30000;
  const Run run = collection.run({"library", "add", "a.db", "meshes", "--no-thumbnails",
                                  "--descriptor", "random:length=20000"});
  CHECK(run.status == 1);
  CHECK_THAT(run.err, Contains("a.db: "));
  collection.options().file_size_limit = 0;
  static_cast<void>(collection.good({"library", "check", "a.db"}));
  CHECK(collection.library().size() == 10);
}

}  // namespace
