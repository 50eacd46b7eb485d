// The face configurations that the dissertation counts (sections 2.3.2 to 2.4): what the drawing of
// them enumerates.

#include <map>
#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "figures/face_configurations.hpp"

namespace {
using namespace shape3d::apps;
using shape3d::zmc::cell_patches;

TEST_CASE("ten faces without a zero edge", "[figures]") {
  std::map<int, int> by_case;
  for (const FaceConfiguration& c : single_faces()) ++by_case[cell_patches(c.samples).face_case[4]];
  // Each case once, and the case of the asymptotic decider twice (Fig. 2.7).
  CHECK(by_case == std::map<int, int>{
                       {1, 1}, {2, 1}, {3, 1}, {5, 1}, {6, 1}, {7, 1}, {9, 1}, {10, 1}, {13, 2}});
}

TEST_CASE("fifteen pairs of faces at a zero edge", "[figures]") {
  std::map<std::pair<int, int>, int> by_cases;
  int zero_edges = 0;
  for (const FaceConfiguration& c : faces_at_zero_edge()) {
    const auto cell = cell_patches(c.samples);
    ++by_cases[std::minmax({cell.face_case[4], cell.face_case[2]})];
    const bool definite = cell.face_case[4] != 11 && cell.face_case[2] != 11;
    const bool opposite =
        definite && (c.samples[2] + c.samples[3] > 0) != (c.samples[4] + c.samples[5] > 0);
    // Equation A.5: the zero edge from vertex 0 (id 12) to vertex 1 (id 13).
    CHECK((c.decided.count({12, 13}) == 1) == opposite);
    CHECK(c.undecided.count({12, 13}) == 0);
    zero_edges += opposite ? 1 : 0;
  }
  // Fig. 2.10: 4.a to 4.e, 8.a to 8.h and 11.a to 11.e, of which 11.c and 11.e are solved in two
  // ways and five are pairs of different cases, named twice.
  CHECK(by_cases ==
        std::map<std::pair<int, int>, int>{
            {{4, 4}, 2}, {{4, 8}, 2}, {{4, 11}, 1}, {{8, 8}, 4}, {{8, 11}, 2}, {{11, 11}, 4}});
  CHECK(zero_edges == 4);
}

TEST_CASE("twelve cells at a zero face", "[figures]") {
  std::map<int, int> by_opposite;
  std::string without;
  for (const FaceConfiguration& c : cells_at_zero_face()) {
    const auto cell = cell_patches(c.samples);
    CHECK(cell.face_case[4] == 12);
    if (c.decided.empty()) {
      without += c.name;
    } else {
      ++by_opposite[cell.face_case[5]];
    }
  }
  CHECK(without == "12 below 1 2 4 7 8 12");  // 12.a as section 2.3.2.2 lists it
  // 12.b to 12.h; 12.d, 12.e, 12.g and 12.h are solved in two ways (Fig. 2.11).
  CHECK(by_opposite ==
        std::map<int, int>{{3, 1}, {5, 1}, {6, 2}, {9, 2}, {10, 1}, {11, 2}, {13, 2}});
}
}  // namespace
