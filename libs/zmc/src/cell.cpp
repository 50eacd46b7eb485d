#include "shape3d/zmc/cell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "cell_rules.hpp"
#include "cell_table.hpp"
#include "magnitude.hpp"

namespace shape3d::zmc {

CellPatches cell_patches(const std::array<double, 8>& samples, TieRule ties,
                         Triangulation triangulation) {
  detail::CellSigns signs{};
  std::array<double, 8> magnitude{};
  for (int v = 0; v < 8; ++v) {
    if (!std::isfinite(samples[v])) {
      throw std::invalid_argument("samples[" + std::to_string(v) +
                                  "]: expected a finite value, got " + std::to_string(samples[v]));
    }
    signs[v] = samples[v] < 0.0 ? -1 : samples[v] > 0.0 ? 1 : 0;
    magnitude[v] = detail::magnitude_between(samples[v], 0.0);
  }
  std::vector<detail::Comparison> comparisons = detail::required_comparisons(signs);
  std::vector<bool> answers;
  for (const auto& c : comparisons)
    answers.push_back(detail::positive_prevails(c, magnitude, ties));
  detail::CellGraph graph = detail::apply_rules(signs, comparisons, answers);

  CellPatches result;
  result.case_index = detail::case_index(signs);
  result.face_case = graph.face_case;
  result.zero_face_sign = graph.zero_face_sign;
  result.resolution = static_cast<int>(graph.resolution);
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::uint32_t> centroids;
  for (const auto& cycle : detail::cycles_in_slots(graph)) {
    detail::triangulate(cycle, triangulation, detail::kSlots, triangles, centroids);
    auto& patch = result.patches.emplace_back();
    for (const int slot : cycle) patch.push_back(detail::kSlotVertex[slot]);
  }
  for (const auto& t : triangles) {
    auto& triangle = result.triangles.emplace_back();
    for (int c = 0; c < 3; ++c)
      triangle[c] = t[c] < detail::kSlots ? detail::kSlotVertex[t[c]] : t[c];
  }
  for (const std::uint32_t members : centroids) {
    auto& list = result.centroids.emplace_back();
    for (int s = 0; s < detail::kSlots; ++s) {
      if ((members >> s) & 1u) list.push_back(detail::kSlotVertex[s]);
    }
  }
  result.patch_edges = std::move(graph.edges);
  return result;
}

}  // namespace shape3d::zmc
