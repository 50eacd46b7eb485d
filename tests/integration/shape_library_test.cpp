#include "common/shape_library.hpp"

#include <filesystem>
#include <fstream>
#include <thread>

#include <sqlite3.h>

#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "common/shape_search.hpp"
#include "program_run.hpp"
#include "support/test_data.hpp"

namespace {
using namespace shape3d::apps;
using namespace shape3d::test;
namespace fs = std::filesystem;
using Access = ShapeLibrary::Access;
using Catch::Matchers::Contains;

const std::string kSpec = "random:length=3,seed=1,align=none";
const std::string kOther = "egi:K=4,align=none";

LibraryModel model_named(const std::string& path, std::optional<std::string> class_name = {}) {
  LibraryModel model;
  model.file = {path, 10, 20};
  model.digest = digest_of(path);
  model.vertices = 4;
  model.triangles = 5;
  model.class_name = std::move(class_name);
  return model;
}

void run_sql(const fs::path& path, const std::string& sql) {
  sqlite3* handle = nullptr;
  REQUIRE(sqlite3_open(path.c_str(), &handle) == SQLITE_OK);
  char* error = nullptr;
  const int code = sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, &error);
  INFO((error == nullptr ? "" : error));
  CHECK(code == SQLITE_OK);
  sqlite3_free(error);
  sqlite3_close(handle);
}

TEST_CASE("digests are MD5", "[shape_library]") {
  // RFC 1321, appendix A.5.
  CHECK(digest_of("") == "d41d8cd98f00b204e9800998ecf8427e");
  CHECK(digest_of("abc") == "900150983cd24fb0d6963f7d28e17f72");
  CHECK(digest_of(
            "12345678901234567890123456789012345678901234567890123456789012345678901234567890") ==
        "57edf4a22be3c955ac49da2e2107b67a");
}

TEST_CASE("a library gives back what was put into it", "[shape_library]") {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.db").string();
  const Eigen::Vector3d a(1, 2, 3), b(-4, 5e-300, 6);
  {
    ShapeLibrary library(path, Access::create);
    CHECK(library.version() == 1);
    CHECK(library.size() == 0);
    CHECK(library.put(model_named("/a.off", "cat"), {{kSpec, a}}) == 1);
    CHECK(library.put(model_named("/b.off"), {{kSpec, b}, {kOther, Eigen::VectorXd::Ones(5)}}) ==
          2);
    CHECK(library.put(model_named("/c.off", "bird"), {}) == 3);
    library.put_thumbnails({{2, "png"}, {99, "of no model"}});
    library.put_item("svm of cats", "svm", std::string(9'000'000, 'x'));
  }
  CHECK(listing(folder.path()) == std::vector<std::string>{"a.db"});
  const ShapeLibrary library(path, Access::read);
  REQUIRE(library.size() == 3);
  const std::vector<LibraryModel> models = library.models();
  CHECK(models[0].file == FeatureFile{"/a.off", 10, 20});
  CHECK(models[0].digest == digest_of("/a.off"));
  CHECK(models[0].class_name == "cat");
  CHECK(models[0].vertices == 4);
  CHECK(models[0].triangles == 5);
  CHECK_FALSE(models[1].class_name);
  CHECK(library.model(2)->file.path == "/b.off");
  CHECK_FALSE(library.model(7));
  CHECK(library.model_of_path("/c.off")->id == 3);
  CHECK_FALSE(library.model_of_path("c.off"));
  CHECK(library.model_of_digest(digest_of("/c.off"))->id == 3);
  CHECK_FALSE(library.model_of_digest("0"));
  CHECK(library.classes() ==
        std::vector<std::pair<std::string, std::int64_t>>{{"bird", 1}, {"cat", 1}});
  const std::vector<LibraryDescriptor> descriptors = library.descriptors();
  REQUIRE(descriptors.size() == 2);
  CHECK(descriptors[0].spec == kSpec);
  CHECK(descriptors[0].length == 3);
  CHECK(descriptors[0].models == 2);
  CHECK(descriptors[1].models == 1);
  const LibraryVectors vectors = library.vectors(kSpec);
  CHECK(vectors.ids == std::vector<std::int64_t>{1, 2});
  CHECK(vectors.vectors.row(0) == a.transpose());
  CHECK(vectors.vectors.row(1) == b.transpose());
  CHECK(vectors.classes == std::vector<std::string>{"bird", "cat"});
  CHECK(vectors.labels == std::vector<std::int32_t>{1, -1});
  CHECK(*library.vector(2, kSpec) == b);
  CHECK_FALSE(library.vector(3, kSpec));
  CHECK(library.described_models(kOther) == std::vector<std::int64_t>{2});
  CHECK(library.thumbnail(2) == "png");
  CHECK(library.thumbnail(1).empty());
  CHECK(library.models_without_thumbnail() == std::vector<std::int64_t>{1, 3});
  CHECK(library.item("svm of cats") == std::string(9'000'000, 'x'));
  REQUIRE(library.items().size() == 1);
  CHECK(library.items()[0].kind == "svm");
  CHECK(library.check(false).empty());
}

TEST_CASE("descriptors are found by what they mean", "[shape_library]") {
  const TemporaryFolder folder;
  ShapeLibrary library((folder / "a.db").string(), Access::create);
  CHECK_THROWS_WITH(library.descriptor(""), Contains("a.db: holds no feature vectors"));
  library.put(model_named("/a.off"),
              {{kSpec, Eigen::Vector3d::Ones()}, {kOther, Eigen::VectorXd::Ones(5)}});
  CHECK(library.descriptor("").spec == kSpec);
  CHECK(library.descriptor("egi:K=4").spec == kOther);
  CHECK_THROWS_WITH(library.descriptor("egi:K=5"),
                    Contains("has no vectors by 'egi:K=5,align=none', expected one of '" + kSpec +
                             "', '" + kOther + "': K is 5 in one and 4 in the other"));
  CHECK_THROWS_AS(library.descriptor("zernike"), std::invalid_argument);
  CHECK_THROWS_WITH(library.vectors("egi:K=5,align=none"), Contains("has no vectors by"));
}

TEST_CASE("models are replaced, changed and removed", "[shape_library]") {
  const TemporaryFolder folder;
  ShapeLibrary library((folder / "a.db").string(), Access::create);
  const Eigen::Vector3d a(1, 2, 3);
  library.put(model_named("/a.off", "cat"), {{kSpec, a}});
  library.put_thumbnails({{1, "png"}});
  std::int64_t generation = library.generation();
  // The same content: what is not given stays.
  CHECK(library.put(model_named("/a.off", "dog"), {{kOther, Eigen::VectorXd::Ones(5)}}) == 1);
  CHECK(library.generation() > generation);
  CHECK(*library.vector(1, kSpec) == a);
  CHECK(library.thumbnail(1) == "png");
  CHECK(library.model(1)->class_name == "dog");
  // Another content.
  LibraryModel changed = model_named("/a.off");
  changed.digest = digest_of("other");
  CHECK(library.put(changed, {{kOther, Eigen::VectorXd::Zero(5)}}) == 1);
  CHECK_FALSE(library.vector(1, kSpec));
  CHECK(*library.vector(1, kOther) == Eigen::VectorXd::Zero(5));
  CHECK(library.thumbnail(1).empty());
  library.set_class(1, "cow");
  CHECK(library.model(1)->class_name == "cow");
  library.set_class(1, std::nullopt);
  CHECK_FALSE(library.model(1)->class_name);
  // Ids are not used again.
  library.put(model_named("/b.off", "cat"), {});
  generation = library.generation();
  CHECK(library.remove(2));
  CHECK(library.generation() > generation);
  CHECK_FALSE(library.remove(2));
  CHECK(library.classes().empty());
  CHECK(library.put(model_named("/b.off"), {}) == 3);
  library.put_item("x", "som", "old");
  library.put_item("x", "som", "new");
  CHECK(library.item("x") == "new");
  CHECK(library.remove_item("x"));
  CHECK_FALSE(library.remove_item("x"));
  CHECK_THROWS_WITH(library.item("x"), Contains("holds nothing of the name 'x'"));
  CHECK(library.check(false).empty());
}

TEST_CASE("what cannot be stored changes nothing", "[shape_library][error]") {
  const TemporaryFolder folder;
  ShapeLibrary library((folder / "a.db").string(), Access::create);
  library.put(model_named("/a.off"), {{kSpec, Eigen::Vector3d::Ones()}});
  CHECK_THROWS_WITH(library.put(model_named("/b.off", "cat"), {{kSpec, Eigen::VectorXd::Ones(4)}}),
                    "a vector by " + kSpec + " has 4 numbers, expected 3");
  CHECK_THROWS_WITH(
      library.put(model_named("/b.off"), {{kSpec, Eigen::Vector3d(1, std::nan(""), 2)}}),
      Contains("has numbers that are not finite"));
  CHECK(library.size() == 1);
  CHECK(library.classes().empty());
}

TEST_CASE("a library in which nothing was put is not left behind", "[shape_library]") {
  const TemporaryFolder folder;
  { const ShapeLibrary library((folder / "a.db").string(), Access::create); }
  CHECK(listing(folder.path()).empty());
}

TEST_CASE("one process writes, others read", "[shape_library]") {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.db").string();
  ShapeLibrary writer(path, Access::create);
  writer.put(model_named("/a.off"), {{kSpec, Eigen::Vector3d::Ones()}});
  CHECK_THROWS_WITH(ShapeLibrary(path, Access::write),
                    Contains("a.db: is being written by another process"));
  const ShapeLibrary first(path, Access::read), second(path, Access::read);
  CHECK(first.size() == 1);
  writer.put(model_named("/b.off"), {{kSpec, Eigen::Vector3d::Zero()}});
  CHECK(first.size() == 2);
  CHECK(second.vectors(kSpec).ids.size() == 2);
  // Reading while it is written: each answer is of one state.
  std::thread thread([&path] {
    const ShapeLibrary reader(path, Access::read);
    for (int i = 0; i < 200; ++i) {
      const LibraryVectors vectors = reader.vectors(kSpec);
      if (vectors.vectors.rows() != static_cast<Eigen::Index>(vectors.ids.size())) std::abort();
    }
  });
  for (int i = 0; i < 200; ++i) {
    writer.put(model_named("/" + std::to_string(i)), {{kSpec, Eigen::Vector3d::Constant(i)}});
  }
  thread.join();
  CHECK(second.size() == 202);
}

TEST_CASE("files that are no library are refused", "[shape_library][error]") {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.db").string();
  const auto refuses = [&path](Access access, const std::string& sentence) {
    CHECK_THROWS_AS(ShapeLibrary(path, access), FileError);
    CHECK_THROWS_WITH(ShapeLibrary(path, access), Contains(path + ": ") && Contains(sentence));
  };
  refuses(Access::read, "no such file");
  refuses(Access::write, "no such file");
  CHECK(listing(folder.path()).empty());
  CHECK_THROWS_WITH(ShapeLibrary((folder / "none" / "a.db").string(), Access::create),
                    Contains("cannot be written: No such file or directory"));
  CHECK_THROWS_WITH(ShapeLibrary(folder.path().string(), Access::create),
                    Contains("is a directory"));
  CHECK_THROWS_WITH(ShapeLibrary("", Access::read), Contains("the name is empty"));
  std::ofstream(path) << "This is a letter, and a long one: " << std::string(5000, '.');
  const std::string letter = slurp(path);
  for (const Access access : {Access::read, Access::write, Access::create}) {
    refuses(access, "is not a shape library, or damaged");
  }
  CHECK(slurp(path) == letter);
  fs::remove(path);
  run_sql(path, "CREATE TABLE t (x)");
  refuses(Access::create, "is an SQLite database, but not a shape library");
  fs::remove(path);
  std::ofstream(path).flush();
  refuses(Access::read, "is an SQLite database, but not a shape library");
  // An empty file is as none.
  {
    ShapeLibrary library(path, Access::create);
    library.put(model_named("/a.off"), {});
  }
  run_sql(path, "PRAGMA user_version = 2");
  refuses(Access::read, "is a shape library of version 2, expected 1");
}

TEST_CASE("damage is found, named and not used", "[shape_library][error]") {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.db").string();
  {
    ShapeLibrary library(path, Access::create);
    for (int i = 0; i < 300; ++i) {
      library.put(model_named("/" + std::to_string(i)), {{kSpec, Eigen::Vector3d::Constant(i)}});
    }
    library.put_thumbnails({{1, "png"}});
    library.put_item("x", "svm", "bytes");
  }
  const std::string good = slurp(path);
  const auto restore = [&] { std::ofstream(path, std::ios::binary) << good; };
  const auto faults = [&path] { return ShapeLibrary(path, Access::read).check(false); };
  SECTION("a vector") {
    run_sql(path, "UPDATE vectors SET data = zeroblob(24) WHERE model = 7");
    REQUIRE(faults().size() == 1);
    CHECK(faults()[0].id == 7);
    CHECK(faults()[0].kind == LibraryFault::Kind::damage);
    CHECK(faults()[0].sentence ==
          "the vector of model 7 by " + kSpec + " does not have its check sum");
    const ShapeLibrary library(path, Access::read);
    CHECK_THROWS_WITH(library.vectors(kSpec), Contains("is damaged: the vector of model 7"));
    CHECK_THROWS_WITH(library.vector(7, kSpec), Contains("is damaged: the vector of model 7"));
    CHECK(library.vector(8, kSpec));
  }
  SECTION("a vector of another length") {
    run_sql(path, "UPDATE vectors SET data = zeroblob(16) WHERE model = 7");
    REQUIRE(faults().size() == 1);
    CHECK_THAT(faults()[0].sentence, Contains("has 16 bytes, expected 24"));
  }
  SECTION("a thumbnail and an item") {
    run_sql(path, "UPDATE thumbnails SET png = 'x'; UPDATE item_parts SET data = 'x'");
    REQUIRE(faults().size() == 2);
    CHECK(faults()[0].sentence == "the thumbnail of model 1 does not have its check sum");
    CHECK(faults()[1].sentence == "'x' does not have its size and check sum");
    CHECK_THROWS_WITH(ShapeLibrary(path, Access::read).item("x"), Contains("is damaged: 'x'"));
  }
  SECTION("a row that is gone") {
    run_sql(path, "DELETE FROM models WHERE id = 7");
    REQUIRE(faults().size() == 1);
    CHECK_THAT(faults()[0].sentence, Contains("of vectors names a row of models"));
  }
  SECTION("pages") {
    // Zeros anywhere but in the first page, which says what the file is.
    int found = 0;
    const std::size_t pages = good.size() / 8192;
    for (std::size_t page = 1; page < pages; ++page) {
      std::string bad = good;
      std::fill_n(bad.begin() + static_cast<std::ptrdiff_t>(8192 * page), 8192, '\0');
      std::ofstream(path, std::ios::binary) << bad;
      try {
        if (!faults().empty()) ++found;
      } catch (const FileError& error) {
        CHECK_THAT(error.what(), Contains("is damaged"));
        ++found;
      }
    }
    CHECK(found == static_cast<int>(pages) - 1);
  }
  SECTION("an end that is missing") {
    std::ofstream(path, std::ios::binary) << good.substr(0, good.size() / 2);
    std::string sentence;
    try {
      for (const LibraryFault& fault : faults()) sentence = fault.sentence;
    } catch (const FileError& error) {
      sentence = error.what();
    }
    CHECK_THAT(sentence, Contains("malformed") || Contains("is damaged"));
  }
  restore();
  CHECK(faults().empty());
}

TEST_CASE("a library whose lock is held says so", "[shape_library][error]") {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.db").string();
  { ShapeLibrary(path, Access::create).put(model_named("/a.off"), {}); }
  // Another program that holds the database for itself.
  sqlite3* other = nullptr;
  REQUIRE(sqlite3_open(path.c_str(), &other) == SQLITE_OK);
  REQUIRE(sqlite3_exec(other,
                       "PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE; "
                       "UPDATE library SET generation = 9",
                       nullptr, nullptr, nullptr) == SQLITE_OK);
  CHECK_THROWS_WITH(ShapeLibrary(path, Access::read), Contains("is locked by another process"));
  sqlite3_close(other);
  CHECK(ShapeLibrary(path, Access::read).size() == 1);
}

TEST_CASE("a search set finds by distance and passes over", "[shape_library][search]") {
  LibraryVectors vectors;
  vectors.spec = kSpec;
  vectors.ids = {3, 5, 8, 9};
  vectors.labels = {0, 0, -1, 1};
  vectors.classes = {"a", "b"};
  vectors.vectors.resize(4, 3);
  vectors.vectors << 0, 0, 0, 1, 0, 0, 0, 3, 0, -1, 0, 0;
  const SearchSet set(vectors);
  CHECK(set.classes() == vectors.classes);
  const std::vector<Match> matches = set.nearest(Eigen::Vector3d::Zero(), 3);
  REQUIRE(matches.size() == 3);
  CHECK(matches[0].id == 3);
  CHECK(matches[1].id == 5);  // as far as 9
  CHECK(matches[2].id == 9);
  CHECK(matches[2].distance == 1.0);
  const std::vector<Match> others = set.nearest(Eigen::Vector3d::Zero(), 10, {3, 9});
  REQUIRE(others.size() == 2);
  CHECK(others[0].id == 5);
  CHECK(others[1].id == 8);
  CHECK(others[1].distance == 3.0);
  CHECK(SearchSet(vectors, shape3d::learning::Norm::L1)
            .nearest(Eigen::Vector3d(1, 1, 0), 1)[0]
            .distance == 1.0);
  CHECK_THROWS_AS(set.nearest(Eigen::VectorXd::Zero(4), 1), std::invalid_argument);
  CHECK_THROWS_AS(set.nearest(Eigen::Vector3d::Zero(), 0), std::invalid_argument);
}

}  // namespace
