#include <cmath>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "princeton.hpp"
#include "retrieval_measures.hpp"

namespace {
using namespace shape3d::bench;

TEST_CASE("retrieval measures are those of a ranking worked out by hand", "[retrieval]") {
  // On a line: A at 0, 1, 5; B at 2, 3; C at 10, alone and so no query.
  Eigen::MatrixXd X(6, 1);
  X << 0, 1, 5, 2, 3, 10;
  const std::vector<std::size_t> of_class{0, 0, 0, 1, 1, 2};
  const RetrievalMeasures found = retrieval_measures(distances(X, Distance::L1), of_class);
  CHECK(found.queries == 5);
  // Rankings: 0: A B B A C; 1: A B B A C (0 before 2 by order); 5: B B A A C; 2: A B A A C (1
  // before 3); 3: B A A A C (2, then 1 before 5, then 0).
  CHECK(found.nearest_neighbour == Approx((1 + 1 + 0 + 0 + 1) / 5.0));
  CHECK(found.first_tier == Approx((0.5 + 0.5 + 0 + 0 + 1) / 5));
  CHECK(found.second_tier == Approx((1 + 1 + 1 + 1 + 1) / 5.0));
  const double perfect = 1 + 1, low = (1 + 0.5) / perfect;
  const double last = (1 / std::log2(3.0) + 0.5) / perfect;
  CHECK(found.dcg == Approx((low + low + last + 1 + 1) / 5));
  const double e_two = 2 / (32 / 2.0 + 2 / 2.0), e_one = 2 / (32.0 + 1.0);
  CHECK(found.e_measure == Approx((3 * e_two + 2 * e_one) / 5));
  CHECK((distances(X, Distance::L1) - distances(X, Distance::L2)).norm() < 1e-12);
}

class File {
 public:
  explicit File(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / "shape3d_retrieval_test.cla") {
    std::ofstream(path_) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

TEST_CASE("classifications are read with their hierarchy", "[retrieval]") {
  const File file("PSB 1\n3 3\n\nvehicle 0 0\n\ncar vehicle 2\n7\n1300\n\nrest 0 1 # one\n12\n");
  const Classification read = read_classification(file.path());
  CHECK(read.classes == std::vector<std::string>{"vehicle/car", "rest"});
  REQUIRE(read.models.size() == 3);
  CHECK(read.models[1].id == 1300);
  CHECK(read.models[1].of_class == 0);
  CHECK(read.models[2].of_class == 1);
  CHECK(model_path("db", 1300) == "db/13/m1300/m1300.off");
}

TEST_CASE("broken classifications are refused with the line", "[retrieval]") {
  const auto refused = [](const char* text, const char* sentence) {
    const File file(text);
    CHECK_THROWS_WITH(read_classification(file.path()), Catch::EndsWith(sentence));
  };
  refused("", "line 0 is missing, expected 'PSB 1'");
  refused("PSB 2\n", "line 1 is 'PSB 2', expected 'PSB 1'");
  refused("PSB 1\nx 3\n", "line 2 has 'x', expected a number of classes");
  refused("PSB 1\n1 1\ncar 0 1\nm7\n", "line 4 has 'm7', expected the number of a model");
  refused("PSB 1\n1 2\ncar 0 1\n7\n", "has 1 models, expected 2");
  CHECK_THROWS_WITH(read_classification("/nowhere.cla"),
                    "/nowhere.cla: cannot be opened for reading");
}

}  // namespace
