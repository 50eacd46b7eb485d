// Every cell with samples in {0, ±D1, ±D2, ±D3}: section 2.5.1.

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "cell_comparison.hpp"
#include "support/zmc_reference_cell.hpp"

namespace {
using namespace shape3d::zmc;
using namespace shape3d::zmc::test;

constexpr int kAssignments = 5764801;  // 7^8

Samples assignment(int n) {
  constexpr std::array<double, 7> kValues{0, 1, 2, 3, -1, -2, -3};
  Samples samples{};
  for (double& s : samples) {
    s = kValues[n % 7];
    n /= 7;
  }
  return samples;
}

/// Directed edges as text, for sets.
template <class Edges>
std::string key(const Edges& edges) {
  std::vector<std::pair<int, int>> pairs;
  for (const auto& e : edges) pairs.emplace_back(e.from, e.to);
  std::sort(pairs.begin(), pairs.end());
  std::string result;
  for (const auto& [from, to] : pairs) {
    result.push_back(static_cast<char>(from));
    result.push_back(static_cast<char>(to));
  }
  return result;
}

TEST_CASE("resolved configurations of the rules under each tie rule", "[zmc][reference]") {
  using reference::Ties;
  const auto [ties, configurations] =
      GENERATE(table<Ties, std::size_t>({{Ties::neutral, 8441},
                                         {Ties::positive, 8441},
                                         {Ties::signless_13, 8447},  // The dissertation's count.
                                         {Ties::separated_13, 8453}}));
  std::map<int, std::set<std::string>> found;
  std::int64_t failures = 0;
  for (int n = 0; n < kAssignments; ++n) {
    Samples samples = assignment(n);
    try {
      const auto solution = reference::solve_cell(samples, ties);
      (void)reference::cycles(solution.edges);  // Throws unless every degree is 0 or 2.
      found[reference::case_index(samples)].insert(key(solution.edges));
    } catch (const std::logic_error&) {
      ++failures;
    }
  }
  CHECK(failures == 0);
  CHECK(found.size() == 6561);
  std::size_t total = 0;
  for (const auto& [p, edges] : found) total += edges.size();
  CHECK(total == configurations);
  CHECK(found[2422].size() == 2);
}

TEST_CASE("cell_patches equals the rules for all 7^8 assignments", "[zmc][reference]") {
  const TieRule ties = GENERATE(TieRule::neutral, TieRule::positive);
  // (P, R) names a configuration: the edges determine it and are determined by it.
  std::map<std::pair<int, int>, std::string> edges_of;
  std::map<std::pair<int, std::string>, std::set<int>> resolutions_of;
  std::int64_t failures = 0;
  for (int n = 0; n < kAssignments && failures < 10; ++n) {
    const Samples samples = assignment(n);
    const CellPatches cell = cell_patches(samples, ties);
    std::array<int, 20> in{}, out{};
    for (const PatchEdge& e : cell.patch_edges) {
      ++out[e.from];
      ++in[e.to];
    }
    const bool degrees = in == out && *std::max_element(in.begin(), in.end()) <= 1;
    const std::string found = difference(cell, samples, ties);
    const std::string fault = triangulation_fault(cell, Triangulation::compact);
    const std::string edges = key(cell.patch_edges);
    const auto [known, is_new] =
        edges_of.emplace(std::pair{cell.case_index, cell.resolution}, edges);
    if (!degrees || !found.empty() || !fault.empty() || known->second != edges) {
      ++failures;
      FAIL_CHECK(to_string(samples) << "R = " << cell.resolution << ": " << found << fault);
    }
    if (is_new) resolutions_of[{cell.case_index, edges}].insert(cell.resolution);
  }
  CHECK(failures == 0);
  CHECK(resolutions_of.size() == 8441);
  CHECK(edges_of.size() == 8441);  // Each configuration has one R.
}
}  // namespace
