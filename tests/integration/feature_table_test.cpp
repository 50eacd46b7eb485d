#include "common/feature_table.hpp"

#include <fstream>
#include <limits>

#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "program_run.hpp"
#include "support/test_data.hpp"

namespace {
using namespace shape3d::apps;
using namespace shape3d::test;

using Catch::Matchers::Contains;

FeatureTable some_table() {
  FeatureTable table;
  table.files = {{"plain.off", 12, 1700000000123456789},
                 {"a, \"b\".off", 0, -1},
                 {"Gr\xC3\xB6\xC3\x9F"
                  "e/\xF0\x9F\x90\xB0.ply",
                  1ull << 40, 5},
                 {"#hash.off", 1, 2}};
  FeatureSet first{"hsh:K=8,map=equal_volume", {}}, second{"d2:bins=2", {}}, third{"hsh:K=9", {}};
  first.vectors = FeatureSet::Vectors::Random(4, 45);
  first.vectors(1, 3) = 1.0 / 3.0;
  first.vectors(2, 4) = std::numeric_limits<double>::denorm_min();
  first.vectors(3, 44) = -1e308;
  second.vectors = FeatureSet::Vectors::Random(4, 2);
  third.vectors = FeatureSet::Vectors::Random(4, 1);
  table.sets = {first, second, third};
  table.failed = {{"bad.off", "ends early"}};
  return table;
}

void write(const std::string& path, const FeatureTable& table) {
  OutputFile file(path);
  write_features(file, *feature_format(path), table);
  file.commit();
}

TEST_CASE("tables of feature vectors are read back exactly", "[features]") {
  const TemporaryFolder folder;
  const FeatureTable table = some_table();
  for (const char* name : {"t.csv", "t.npy", "t.h5", "t.HDF5"}) {
    const std::string path = (folder / name).string();
    write(path, table);
    const FeatureTable read = read_features(path);
    INFO(name);
    CHECK(read.files == table.files);
    REQUIRE(read.sets.size() == 3);
    for (std::size_t s = 0; s < 3; ++s) {
      CHECK(read.sets[s].spec == table.sets[s].spec);
      CHECK(read.sets[s].vectors == table.sets[s].vectors);
    }
    if (std::string(name) != "t.npy") CHECK(read.failed == table.failed);
  }
  CHECK(feature_names(table) == std::vector<std::string>{"hsh", "d2", "hsh_2"});
}

TEST_CASE("tables without rows", "[features]") {
  const TemporaryFolder folder;
  FeatureTable table = some_table();
  table.files.clear();
  for (FeatureSet& set : table.sets) set.vectors.resize(0, set.vectors.cols());
  for (const char* name : {"t.csv", "t.npy", "t.h5"}) {
    const std::string path = (folder / name).string();
    write(path, table);
    const FeatureTable read = read_features(path);
    INFO(name);
    CHECK(read.files.empty());
    REQUIRE(read.sets.size() == 3);
    CHECK(read.sets[0].vectors.cols() == 45);
  }
}

TEST_CASE("what is no table is refused", "[features][error]") {
  const TemporaryFolder folder;
  const auto refuses = [&](const std::string& name, const std::string& bytes,
                           const std::string& sentence) {
    const std::string path = (folder / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    INFO(name);
    CHECK_THROWS_WITH(read_features(path), Contains(path) && Contains(sentence));
  };
  const std::string head = "# shape3d describe, version 1\n";
  const std::string columns = head + "# descriptor d2, 2 numbers: d2:bins=2\n";
  refuses("a.txt", "", "unknown extension, expected .csv, .npy or .h5");
  refuses("a.csv", "file,x\n", "line 1: is not a table of 'shape3d describe': expected '# shape3d");
  refuses("b.csv", head + "file,size,mtime\n", "no line says which descriptor");
  refuses("c.csv", head + "# descriptor d2\n", "expected 'NAME, N numbers: SPEC'");
  refuses("d.csv", columns + "file,size\n", "expected 5 columns");
  refuses("e.csv", columns + "file,size,mtime,d2_0,d2_1\na,1,2,3\n", "fewer numbers than columns");
  refuses("f.csv", columns + "file,size,mtime,d2_0,d2_1\na,1,2,x,4\n", "expected a number");
  refuses("g.csv", columns + "file,size,mtime,d2_0,d2_1\na,1,2,3,4,5\n",
          "more fields than columns");
  refuses("h.csv", columns + "file,size,mtime,d2_0,d2_1\n\"a,1,2,3,4\n",
          "a quotation mark is not closed");
  refuses("a.npy", "not numpy at all", "expected a structured NumPy array");
  refuses("a.h5", "not HDF5", "is not an HDF5 file, or is damaged");
  CHECK_THROWS_AS(read_features((folder / "none.h5").string()), FileError);
  CHECK_THROWS_AS(read_features((folder / "none.csv").string()), FileError);

  // Every prefix of a table is refused or, for text, ends at a line.
  write((folder / "t.npy").string(), some_table());
  const std::string npy = slurp(folder / "t.npy");
  for (std::size_t size = 0; size < npy.size(); size += 97) {
    std::ofstream(folder / "u.npy", std::ios::binary) << npy.substr(0, size);
    CHECK_THROWS_AS(read_features((folder / "u.npy").string()), FileError);
  }
  write((folder / "t.h5").string(), some_table());
  const std::string h5 = slurp(folder / "t.h5");
  for (std::size_t size = 0; size + 1 < h5.size(); size += 1001) {
    std::ofstream(folder / "u.h5", std::ios::binary) << h5.substr(0, size);
    CHECK_THROWS_AS(read_features((folder / "u.h5").string()), FileError);
  }
  refuses("b.npy", npy.substr(0, npy.size() - 1), "bytes of rows, expected 4 rows of ");
}

}  // namespace
