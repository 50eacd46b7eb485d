#include "viewer/model/collection_map.hpp"

#include <fstream>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "small_map.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::apps::viewer;
using namespace shape3d::test;
using Catch::Matchers::Contains;

TEST_CASE("each shape of the library is at the unit of the nearest prototype", "[viewer][map]") {
  const SmallLibrary small;
  const CollectionMap map = read_collection_map(write_map(small));
  CHECK(map.units() == 12);
  CHECK(map.shapes() == 8);
  CHECK(map.descriptor == SmallLibrary::spec());
  CHECK(map.row(7) == 2);
  CHECK(map.column(7) == 1);
  CHECK(map.u_matrix.values.rows() == 7);
  const ShapeLibrary library(small.path, ShapeLibrary::Access::read);
  const auto shapes = shapes_of_units(map, library);
  REQUIRE(shapes.size() == 12);
  const learning::Features prototypes = map.model.som.unscaled_prototypes();
  std::set<std::int64_t> seen;
  for (std::size_t unit = 0; unit < 12; ++unit) {
    CHECK(shapes[unit].size() == static_cast<std::size_t>(map.model.hits[unit]));
    double before = 0.0;
    std::map<std::string, int> votes;
    for (const UnitShape& shape : shapes[unit]) {
      CHECK(shape.distance >= before);
      before = shape.distance;
      CHECK(seen.insert(shape.id).second);
      ++votes[*shape.class_name];
      // By comparing with each prototype.
      const Eigen::VectorXd vector = *library.vector(shape.id, SmallLibrary::spec());
      const Eigen::VectorXd distances =
          (prototypes.rowwise() - vector.transpose()).rowwise().norm();
      Eigen::Index nearest = 0;
      distances.minCoeff(&nearest);
      CHECK(nearest == static_cast<Eigen::Index>(unit));
      CHECK(shape.distance == Approx(distances(nearest)).margin(1e-9));
      CHECK(shape.path == library.model(shape.id)->file.path);
    }
    for (const auto& [name, count] : votes)
      CHECK(count <= votes[map.class_of(static_cast<int>(unit))]);
    CHECK(map.class_of(static_cast<int>(unit)).empty() == shapes[unit].empty());
  }
  CHECK(seen.size() == 8);
}

TEST_CASE("what is no map, and a library without its vectors, are said", "[viewer][map]") {
  const SmallLibrary small;
  const std::string path = (small.folder / "svm.model").string();
  const auto write = [&path](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  };
  write("no model");
  CHECK_THROWS_WITH(read_collection_map(path), Contains("svm.model: "));
  write(learning::write_model_file({learning::ModelKind::svm, "d2", {}, "x"}));
  CHECK_THROWS_WITH(read_collection_map(path),
                    Contains("is of kind svm, expected a map by 'shape3d train som'"));
  write(learning::write_model_file({learning::ModelKind::som, "d2", {}, "x"}));
  CHECK_THROWS_AS(read_collection_map(path), FileError);
  CHECK_THROWS_AS(read_collection_map((small.folder / "none.model").string()), FileError);

  const CollectionMap map = read_collection_map(write_map(small, "egi:K=4,align=none"));
  const ShapeLibrary library(small.path, ShapeLibrary::Access::read);
  CHECK_THROWS_WITH(shapes_of_units(map, library), Contains("boxes.db: "));
}

}  // namespace
