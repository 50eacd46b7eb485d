#include "shape3d/learning/approximate_neighbours.hpp"

#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::learning;
using Catch::Matchers::Contains;

// Clusters, as descriptors of classes of shapes are.
Features clusters(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  Features centres(20, columns);
  std::mt19937 centre_engine(1);
  for (Eigen::Index i = 0; i < centres.size(); ++i) centres.data()[i] = normal(centre_engine);
  Features X(rows, columns);
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index i = 0; i < columns; ++i) {
      X(row, i) = centres(row % 20, i) + 0.4 * normal(engine);
    }
  }
  return X;
}

std::uint64_t fnv(std::string_view bytes) {
  std::uint64_t sum = 14695981039346656037U;
  for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return sum;
}

void sign(std::string& bytes) {
  const std::uint64_t sum = fnv(std::string_view(bytes).substr(0, bytes.size() - 8));
  std::memcpy(bytes.data() + bytes.size() - 8, &sum, 8);
}

TEST_CASE("the graph finds nearly all exact neighbours, more with more effort",
          "[approximate_neighbours]") {
  const Features X = clusters(6000, 45, 2), Q = clusters(200, 45, 3);
  const Neighbours exact = ExactNeighbours(X).query(Q, 10);
  const ApproximateNeighbours graph(X);
  CHECK(graph.size() == 6000);
  CHECK(graph.dimension() == 45);
  const double low = recall(exact, graph.query(Q, 10, 10)),
               high = recall(exact, graph.query(Q, 10, 400));
  CHECK(high >= 0.99);
  CHECK(low < high);
  const Neighbours found = graph.query(Q, 10, 400);
  for (Eigen::Index q = 0; q < Q.rows(); ++q) {
    for (Eigen::Index i = 0; i < 10; ++i) {
      // Distances are right, whether or not the item is one of the nearest.
      const double distance = (X.row(found.rows(q, i)) - Q.row(q)).norm();
      CHECK(found.distances(q, i) == Approx(distance).epsilon(1e-5));
      if (i > 0) CHECK(found.distances(q, i) >= found.distances(q, i - 1));
    }
  }
}

TEST_CASE("all of a small library is found", "[approximate_neighbours]") {
  const Features X = clusters(60, 7, 4);
  const Neighbours exact = ExactNeighbours(X).query(X, 100);
  const Neighbours found = ApproximateNeighbours(X).query(X, 100);
  REQUIRE(found.rows.cols() == 60);
  CHECK(recall(exact, found) == 1.0);
  const ApproximateNeighbours none(Features(0, 7));
  CHECK(none.query(X, 3).rows.cols() == 0);
}

TEST_CASE("the graph and what it finds are the same each time, for any number of threads",
          "[approximate_neighbours]") {
  const Features X = clusters(2000, 20, 5), Q = clusters(100, 20, 6);
  const ApproximateNeighbours a(X), b(X);
  CHECK(a.serialize() == b.serialize());
  const Neighbours one = a.query(Q, 5, 0, 1), two = b.query(Q, 5, 0, 2);
  CHECK((one.rows.array() == two.rows.array()).all());
  CHECK((one.distances.array() == two.distances.array()).all());
  ApproximateNeighboursOptions other;
  other.seed = 2;
  CHECK(ApproximateNeighbours(X, other).serialize() != a.serialize());
}

TEST_CASE("a graph comes back from its bytes", "[approximate_neighbours]") {
  const Features X = clusters(1500, 33, 7), Q = clusters(50, 33, 8);
  ApproximateNeighboursOptions options;
  options.links = 8;
  options.search_effort = 70;
  const ApproximateNeighbours graph(X, options);
  const std::string bytes = graph.serialize();
  const ApproximateNeighbours read = ApproximateNeighbours::deserialize(bytes);
  CHECK(read.options().links == 8);
  CHECK(read.options().search_effort == 70);
  CHECK(read.serialize() == bytes);
  const Neighbours a = graph.query(Q, 6), b = read.query(Q, 6);
  CHECK((a.rows.array() == b.rows.array()).all());
  CHECK((a.distances.array() == b.distances.array()).all());
  const std::string empty = ApproximateNeighbours(Features(0, 3)).serialize();
  CHECK(ApproximateNeighbours::deserialize(empty).size() == 0);
}

TEST_CASE("bytes that are no graph are refused", "[approximate_neighbours][contract]") {
  const Features X = clusters(200, 5, 9);
  const std::string bytes = ApproximateNeighbours(X).serialize();
  const auto refused = [](const std::string& text, const std::string& sentence) {
    CHECK_THROWS_AS(ApproximateNeighbours::deserialize(text), std::invalid_argument);
    CHECK_THROWS_WITH(ApproximateNeighbours::deserialize(text), Contains(sentence));
  };
  refused("", "they begin otherwise");
  refused(std::string(100, 'x'), "they begin otherwise");
  refused(bytes.substr(0, bytes.size() / 2), "their check sum is wrong");
  std::string changed = bytes;
  changed[bytes.size() / 2] ^= 1;
  refused(changed, "their check sum is wrong");
  changed = bytes;
  changed[8] = 2;
  refused(changed, "their version is 2, expected 1");
  // Signed by one who knows how: counts and links are looked at all the same.
  const auto with = [&](std::size_t at, std::uint32_t value) {
    std::string text = bytes;
    std::memcpy(text.data() + at, &value, sizeof value);
    sign(text);
    return text;
  };
  const std::size_t head = 8 + 4 + 4 * 4;  // magic, version, options
  refused(with(12, 1000), "links is 1000, expected 2 … 128");
  refused(with(head + 4, 200), "the entry is out of range");
  refused(with(head + 16, 4000000000U), "their counts do not fit their length");
  refused(with(head + 24, 4000000000U), "a level is out of range");
  const std::size_t first_links = head + 8 + 16 + 200 * 4;
  refused(with(first_links, 1000), "a link is out of range");
  refused(with(first_links + 4, 200), "a link is out of range");
  // No change of a byte, signed, does harm.
  std::mt19937 engine(10);
  for (int i = 0; i < 2000; ++i) {
    std::string text = bytes;
    text[8 + engine() % (text.size() - 16)] = static_cast<char>(engine());
    sign(text);
    try {
      const ApproximateNeighbours graph = ApproximateNeighbours::deserialize(text);
      if (graph.dimension() == 5) static_cast<void>(graph.query(X.topRows(3), 5));
    } catch (const std::invalid_argument&) {
    }
  }
}

TEST_CASE("approximate neighbours refuse what they cannot use",
          "[approximate_neighbours][contract]") {
  const Features X = clusters(50, 4, 11);
  ApproximateNeighboursOptions options;
  options.links = 1;
  CHECK_THROWS_WITH(ApproximateNeighbours(X, options), Contains("links is 1, expected 2 … 128"));
  options.links = 16;
  options.build_effort = 8;
  CHECK_THROWS_WITH(ApproximateNeighbours(X, options), Contains("build_effort is 8"));
  options.build_effort = 100;
  options.search_effort = 0;
  CHECK_THROWS_WITH(ApproximateNeighbours(X, options), Contains("search_effort is 0"));
  const ApproximateNeighbours graph(X);
  CHECK_THROWS_WITH(graph.query(Features(1, 3), 1), "Q has 3 columns, expected 4");
  CHECK_THROWS_WITH(graph.query(X, 0), "k is 0, expected 1 or more");
  CHECK_THROWS_WITH(graph.query(X, 1, 100001), Contains("effort is 100001"));
  CHECK_THROWS_WITH(graph.query(X, 1, 0, -1), Contains("threads is -1"));
  Features bad = X;
  bad(3, 1) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(ApproximateNeighbours(bad), Contains("row 3 of X has the number inf"));
  bad(3, 1) = 1e16;
  CHECK_THROWS_WITH(graph.query(bad, 1), Contains("row 3 of Q has the number 1e+16"));
  CHECK_THROWS_WITH(recall(graph.query(X, 1), graph.query(X.topRows(2), 1)),
                    Contains("of 50 and 2 queries"));
}

}  // namespace
