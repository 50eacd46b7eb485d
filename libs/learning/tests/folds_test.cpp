#include "shape3d/learning/folds.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <catch2/catch.hpp>

#include "random_numbers.hpp"

using namespace shape3d::learning;
using Catch::Matchers::Contains;

namespace {

Labels skewed_labels(int items) {
  detail::RandomNumbers random(7);
  Labels labels;
  for (int i = 0; i < items; ++i) {
    const double u = random.uniform();
    labels.push_back(static_cast<int>(u * u * 9.0));
  }
  return labels;
}

}  // namespace

TEST_CASE("stratified folds spread every class and are of equal size") {
  const int k = GENERATE(2, 3, 5, 10);
  const Labels labels = skewed_labels(407);
  const std::vector<int> folds = stratified_folds(labels, k, 1);
  REQUIRE(folds.size() == labels.size());

  std::map<std::pair<int, int>, int> count;
  std::vector<int> sizes(static_cast<std::size_t>(k), 0);
  std::map<int, int> classes;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    ++count[{labels[i], folds[i]}];
    ++sizes.at(static_cast<std::size_t>(folds[i]));
    ++classes[labels[i]];
  }
  for (const auto& [label, members] : classes) {
    for (int fold = 0; fold < k; ++fold) {
      const int here = count[{label, fold}];
      CHECK(here >= members / k);
      CHECK(here <= (members + k - 1) / k);
    }
  }
  const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
  CHECK(*most - *least <= 1);
}

TEST_CASE("folds follow their seed alone") {
  const Labels labels = skewed_labels(100);
  CHECK(stratified_folds(labels, 5, 3) == stratified_folds(labels, 5, 3));
  CHECK(stratified_folds(labels, 5, 3) != stratified_folds(labels, 5, 4));
}

TEST_CASE("grouped folds never divide a group and are balanced") {
  const std::vector<int> groups = skewed_labels(300);
  const std::vector<int> folds = grouped_folds(groups, 3, 5);
  std::map<int, std::set<int>> folds_of;
  std::vector<int> sizes(3, 0);
  std::map<int, int> members;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    folds_of[groups[i]].insert(folds[i]);
    ++sizes.at(static_cast<std::size_t>(folds[i]));
    ++members[groups[i]];
  }
  for (const auto& [group, where] : folds_of) CHECK(where.size() == 1);
  int largest = 0;
  for (const auto& [group, size] : members) largest = std::max(largest, size);
  const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
  CHECK(*most - *least <= largest);  // Graham's bound of the greedy order
  CHECK(grouped_folds(groups, 3, 5) == folds);
}

TEST_CASE("folds refuse what cannot be divided") {
  CHECK_THROWS_WITH(stratified_folds({0, 1, 0}, 4, 0), Contains("k is 4, expected 2 … 3"));
  CHECK_THROWS_WITH(stratified_folds({0, 1, 0}, 1, 0), Contains("k is 1, expected 2 … 3"));
  CHECK_THROWS_WITH(stratified_folds({0, -2, 0}, 2, 0), Contains("a label is -2"));
  CHECK_THROWS_WITH(grouped_folds({4, 4, 9}, 3, 0), Contains("k is 3, expected 2 … 2"));
}

TEST_CASE("random numbers are those of every platform") {
  // The ten thousandth number of std::mt19937_64 is fixed by the standard, [rand.predef].
  detail::RandomNumbers numbers(5489);
  for (int i = 1; i < 10000; ++i) numbers.uniform();
  CHECK(numbers.uniform() == static_cast<double>(9981545732273789042ULL >> 11) * 0x1.0p-53);

  detail::RandomNumbers random(1);
  std::vector<int> seen(6, 0);
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < 60000; ++i) {
    ++seen.at(random.below(6));
    const double x = random.normal();
    sum += x;
    squares += x * x;
  }
  for (const int count : seen) CHECK(std::abs(count - 10000) < 5 * 92);  // 5 σ of a binomial
  CHECK(std::abs(sum / 60000) < 5 / std::sqrt(60000.0));
  CHECK(std::abs(squares / 60000 - 1.0) < 5 * std::sqrt(2.0 / 60000));
}
