// Times of nearest neighbours among many vectors, as JSON on standard output.
//
//   shape3d_search_bench TABLE.npy N [--graph]
//
// TABLE.npy holds vectors of shapes ('shape3d library export --npy'). There are rarely 10^5 real
// ones: the N vectors are v_i + (v_j - v_k) / 4 with random i, j, k, which have the covariance of
// the real ones, 1 + 1/8 times. Queries are made in the same way.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <shape3d/learning/approximate_neighbours.hpp>
#include <shape3d/learning/nearest_neighbours.hpp>

#include "common/feature_table.hpp"

namespace {
using namespace shape3d::learning;
using Json = nlohmann::ordered_json;

constexpr Eigen::Index kQueries = 200, kNeighbours = 10;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Features drawn(const Features& base, Eigen::Index count, unsigned seed) {
  std::mt19937_64 engine(seed);
  const auto any = [&] {
    return static_cast<Eigen::Index>(engine() % static_cast<std::uint64_t>(base.rows()));
  };
  Features X(count, base.cols());
  for (Eigen::Index row = 0; row < count; ++row) {
    const Eigen::Index i = any(), j = any(), k = any();
    X.row(row) = base.row(i) + 0.25 * (base.row(j) - base.row(k));
  }
  return X;
}

// Milliseconds of single queries: median and the 95th of 100.
template <class Query>
Json times_of(const Features& queries, const Query& query) {
  std::vector<double> times;
  static_cast<void>(query(queries.row(0)));
  for (Eigen::Index q = 0; q < queries.rows(); ++q) {
    const auto start = std::chrono::steady_clock::now();
    static_cast<void>(query(queries.row(q)));
    times.push_back(1e3 * seconds_since(start));
  }
  std::sort(times.begin(), times.end());
  return {{"median_ms", times[times.size() / 2]}, {"p95_ms", times[times.size() * 95 / 100]}};
}

// As one would write it down: all distances in double precision, then a partial sort.
std::vector<std::pair<double, Eigen::Index>> plain(const Features& X, const Eigen::RowVectorXd& q) {
  std::vector<std::pair<double, Eigen::Index>> all(static_cast<std::size_t>(X.rows()));
  for (Eigen::Index row = 0; row < X.rows(); ++row) {
    all[static_cast<std::size_t>(row)] = {(X.row(row) - q).squaredNorm(), row};
  }
  std::partial_sort(all.begin(), all.begin() + kNeighbours, all.end());
  return all;
}

Json exact_times(const ExactNeighbours& index, const Features& queries) {
  Json json;
  for (const int threads : {1, 2}) {
    Json entry = times_of(queries, [&](const Features& q) {
      return index.query(q, kNeighbours, threads).rows(0, 0);
    });
    const auto start = std::chrono::steady_clock::now();
    static_cast<void>(index.query(queries, kNeighbours, threads));
    entry["together_ms"] = 1e3 * seconds_since(start) / static_cast<double>(queries.rows());
    json[std::to_string(threads)] = entry;
  }
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: shape3d_search_bench TABLE.npy N [--graph]\n";
    return 2;
  }
  const Features base = shape3d::apps::read_features(argv[1]).sets.at(0).vectors;
  const Eigen::Index n = std::atoll(argv[2]);
  const bool graph = argc > 3 && std::string(argv[3]) == "--graph";
  const Features X = drawn(base, n, 1), queries = drawn(base, kQueries, 2);
  Json json{{"vectors", n}, {"numbers", base.cols()}, {"real", base.rows()}};
  const ExactNeighbours exact(X);
  json["plain"] = times_of(queries.topRows(20),
                           [&](const Features& q) { return plain(X, q.row(0)).front().second; });
  json["exact"] = exact_times(exact, queries);
  json["exact_L1"] = exact_times(ExactNeighbours(X, Norm::L1), queries.topRows(40));
  if (graph) {
    const Neighbours truth = exact.query(queries, kNeighbours);
    auto start = std::chrono::steady_clock::now();
    const ApproximateNeighbours made(X);
    json["graph"]["build_s"] = seconds_since(start);
    start = std::chrono::steady_clock::now();
    const std::string bytes = made.serialize();
    json["graph"]["bytes"] = bytes.size();
    json["graph"]["serialize_s"] = seconds_since(start);
    start = std::chrono::steady_clock::now();
    const ApproximateNeighbours read = ApproximateNeighbours::deserialize(bytes);
    json["graph"]["deserialize_s"] = seconds_since(start);
    json["graph"]["queries"] = Json::array();
    for (const int effort : {10, 20, 50, 100, 200, 400, 800}) {
      Json entry = times_of(queries, [&](const Features& q) {
        return read.query(q, kNeighbours, effort, 1).rows(0, 0);
      });
      entry["effort"] = effort;
      entry["recall"] = recall(truth, read.query(queries, kNeighbours, effort));
      json["graph"]["queries"].push_back(entry);
    }
  }
  std::cout << json.dump(2) << '\n';
  return 0;
}
