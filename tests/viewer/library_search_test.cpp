#include "viewer/model/library_search.hpp"

#include <algorithm>
#include <fstream>

#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "small_library.hpp"

namespace {
using namespace shape3d::apps;
using namespace shape3d::apps::viewer;
using namespace shape3d::test;
using Catch::Matchers::Contains;

// By comparing with every model, in doubles.
std::vector<Match> by_hand(const std::string& path, const Eigen::VectorXd& vector,
                           std::int64_t without, bool city_block) {
  const ShapeLibrary library(path, ShapeLibrary::Access::read);
  std::vector<Match> matches;
  for (const LibraryModel& model : library.models()) {
    if (model.id == without) continue;
    const Eigen::VectorXd difference = *library.vector(model.id, SmallLibrary::spec()) - vector;
    matches.push_back({model.id, city_block ? difference.lpNorm<1>() : difference.norm()});
  }
  std::sort(matches.begin(), matches.end(),
            [](const Match& a, const Match& b) { return a.distance < b.distance; });
  return matches;
}

TEST_CASE("matches are all others by distance, the nearest first", "[viewer][search]") {
  const SmallLibrary small;
  LibrarySearch search(small.path);
  const ShapeLibrary library(small.path, ShapeLibrary::Access::read);
  for (const Ranking ranking : {Ranking::l2, Ranking::l1}) {
    for (std::int64_t id = 1; id <= 8; ++id) {
      const SearchResult result = search.search({id, "", "d2", ranking, 30});
      INFO(result.error);
      const auto expected = by_hand(small.path, *library.vector(id, SmallLibrary::spec()), id,
                                    ranking == Ranking::l1);
      REQUIRE(result.found.size() == 7);
      CHECK(result.models == 8);
      CHECK(result.spec == SmallLibrary::spec());
      for (std::size_t n = 0; n < 7; ++n) {
        CHECK(result.found[n].match.id == expected[n].id);
        CHECK(result.found[n].match.distance == Approx(expected[n].distance).margin(1e-12));
        CHECK(result.found[n].model.id == expected[n].id);
      }
    }
  }
}

TEST_CASE("the class-weighted distance puts the classes of the neighbours first",
          "[viewer][search]") {
  const SmallLibrary small;
  LibrarySearch search(small.path);
  const SearchResult plain = search.search({1, "", "", Ranking::l2, 30});
  const SearchResult weighted = search.search({1, "", "", Ranking::weighted, 30});
  REQUIRE(weighted.classes.size() == 2);
  // Of the seven others three are plates.
  const double plate = 3.0 / 7.0, rod = 4.0 / 7.0;
  CHECK(weighted.classes[0].first == "rod");
  CHECK(weighted.classes[0].second == Approx(rod));
  CHECK(weighted.classes[1].second == Approx(plate));
  for (const Found& found : weighted.found) {
    const auto same = std::find_if(plain.found.begin(), plain.found.end(), [&](const Found& other) {
      return other.match.id == found.match.id;
    });
    REQUIRE(same != plain.found.end());
    const double p = found.model.class_name == "rod" ? rod : plate;
    CHECK(found.match.distance ==
          Approx((1.0 - 0.75 * p) * same->match.distance * same->match.distance));
  }
}

TEST_CASE("a mesh file is described, and found by its content", "[viewer][search]") {
  const SmallLibrary small;
  LibrarySearch search(small.path);
  const std::string plate = small.write("new", brick(10.0, 9.3, 1.0));
  SearchResult result = search.search({0, plate, "", Ranking::l2, 3});
  INFO(result.error);
  REQUIRE(result.found.size() == 3);
  CHECK_FALSE(result.query.model);
  CHECK_FALSE(result.query.class_name);
  for (const Found& found : result.found) CHECK(found.model.class_name == "plate");
  CHECK(match_kind(result.query, result.found[0].model) == MatchKind::unknown);

  // The same bytes under another name: the query's class is known, and it is not found itself.
  const std::string copy = small.write("copy", brick(10.0, 9.0, 1.0));
  result = search.search({0, copy, "", Ranking::l2, 30});
  REQUIRE(result.query.model);
  CHECK(result.query.model->id == 1);
  CHECK(result.query.class_name == "plate");
  CHECK(result.found.size() == 7);
  for (const Found& found : result.found) {
    CHECK(found.match.id != 1);
    CHECK(match_kind(result.query, found.model) ==
          (found.model.class_name == "plate" ? MatchKind::same_class : MatchKind::other_class));
  }
}

TEST_CASE("a library that has grown is searched as it is now", "[viewer][search]") {
  const SmallLibrary small;
  LibrarySearch search(small.path);
  CHECK(search.search({1, "", "", Ranking::l2, 30}).found.size() == 7);
  {
    ShapeLibrary library(small.path, ShapeLibrary::Access::write);
    const auto vector = *library.vector(1, SmallLibrary::spec());
    LibraryModel twin = *library.model(1);
    twin.file.path += ".twin";
    library.put(twin, {{SmallLibrary::spec(), vector}});
  }
  const SearchResult result = search.search({1, "", "", Ranking::l2, 30});
  REQUIRE(result.found.size() == 8);
  CHECK(result.found[0].match.distance == 0.0);
}

TEST_CASE("what cannot be searched is said", "[viewer][search]") {
  const SmallLibrary small;
  CHECK_THROWS_AS(LibrarySearch((small.folder / "none.db").string()), FileError);
  LibrarySearch search(small.path);
  CHECK_THAT(search.search({99, "", "", Ranking::l2, 3}).error, Contains("has no model 99"));
  CHECK_THAT(search.search({0, "none.off", "", Ranking::l2, 3}).error, Contains("none.off: "));
  CHECK_THAT(search.search({0, "x.txt", "", Ranking::l2, 3}).error,
             Contains("unknown extension '.txt'"));
  CHECK_THAT(search.search({1, "", "egi", Ranking::l2, 3}).error, Contains("boxes.db: "));
  const std::string broken = (small.folder / "broken.off").string();
  std::ofstream(broken) << "OFF\n3 1 0\n0 0 0\n1 0 0\n";
  CHECK_THAT(search.search({0, broken, "", Ranking::l2, 3}).error, Contains("broken.off: "));
}

TEST_CASE("rankings have names", "[viewer][search]") {
  for (const Ranking ranking : {Ranking::l2, Ranking::l1, Ranking::weighted})
    CHECK(ranking_named(to_string(ranking)) == ranking);
  CHECK_FALSE(ranking_named("cosine"));
}

}  // namespace
