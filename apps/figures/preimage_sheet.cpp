#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "cell_drawing.hpp"
#include "sheets.hpp"

namespace shape3d::apps {
namespace {

/// Samples −1, 0, 1 of case P.
Samples unit_samples(int P) {
  constexpr std::array<double, 3> kValues{0, 1, -1};
  Samples samples{};
  for (double& s : samples) {
    s = kValues[static_cast<std::size_t>(P % 3)];
    P /= 3;
  }
  return samples;
}

/// Q = Σ 2^v q_v when zeros are taken as positive.
int case_without_zeros(const Samples& samples) {
  int Q = 0;
  for (std::size_t v = 0; v < 8; ++v) Q |= samples[v] >= 0.0 ? 1 << v : 0;
  return Q;
}

/// The different sets of patch edges that magnitudes 1, 2, 3 of the samples bring about.
std::size_t resolutions_of(const Samples& unit) {
  std::set<std::set<Edge>> found;
  for (int n = 0; n < 6561; ++n) {
    Samples samples = unit;
    bool again = false;
    int rest = n;
    for (double& s : samples) {
      again = again || (s == 0.0 && rest % 3 != 0);
      s *= 1 + rest % 3;
      rest /= 3;
    }
    if (!again) found.insert(patch_edges_of(zmc::cell_patches(samples)));
  }
  return found.size();
}

}  // namespace

std::string draw_preimage_sheet(int Q) {
  std::vector<Samples> cells;
  for (int P = 0; P < 6561; ++P) {
    const Samples samples = unit_samples(P);
    if (case_without_zeros(samples) == Q) cells.push_back(samples);
  }
  const auto zeros = [](const Samples& s) { return std::count(s.begin(), s.end(), 0.0); };
  std::stable_sort(cells.begin(), cells.end(),
                   [&](const Samples& a, const Samples& b) { return zeros(a) < zeros(b); });
  constexpr int kColumns = 8, kWidth = 200, kHeight = 232, kHead = 96;
  const int rows = (static_cast<int>(cells.size()) + kColumns - 1) / kColumns;
  Page page(kColumns * kWidth, kHead + rows * kHeight);
  page.text(24, page.height() - 42, 24,
            "Case Q = " + std::to_string(Q) + " of Marching Cubes and the " +
                std::to_string(cells.size() - 1) +
                " cases with zeros that become it when zeros are taken as positive",
            Page::Align::left, true);
  draw_legend(page, 34, page.height() - 76);
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const auto column = static_cast<int>(n) % kColumns, row = static_cast<int>(n) / kColumns;
    const double x = (column + 0.5) * kWidth;
    const double top = page.height() - kHead - row * kHeight;
    draw_cell(page, ObliqueView({0.5, 0.5, 0.5}, x, top - 100, 108), cells[n]);
    const zmc::CellPatches cell = zmc::cell_patches(cells[n]);
    page.text(x, top - 204, 16, name_of(cell), Page::Align::centre, zeros(cells[n]) == 0);
    const std::size_t count = resolutions_of(cells[n]);
    std::string below = zeros(cells[n]) == 0 ? "no zeros" : "";
    if (count > 1) {
      below += (below.empty() ? "one of " : "; one of ") + std::to_string(count) + " resolutions";
    }
    if (!below.empty()) page.text(x, top - 222, 13, below);
  }
  return page.png();
}

}  // namespace shape3d::apps
