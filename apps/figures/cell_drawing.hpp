#pragma once

#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <shape3d/zmc/cell.hpp>

#include "page.hpp"

namespace shape3d::apps {

using Samples = std::array<double, 8>;  ///< Of a cell, in Lorensen's order.
using Edge = std::pair<int, int>;       ///< Two surface vertices of a cell, the lower one first.

inline constexpr Color kPositive{0.83, 0.24, 0.20}, kNegative{0.20, 0.42, 0.78},
    kZero{1.0, 1.0, 1.0};
inline constexpr Color kPositiveSide{0.97, 0.78, 0.55}, kNegativeSide{0.62, 0.80, 0.97},
    kInserted{0.55, 0.80, 0.45};
inline constexpr Color kFrame{0.62, 0.62, 0.62}, kPatchEdge{0.10, 0.10, 0.10},
    kUndecided{0.45, 0.45, 0.45};

/// Red, blue or white by the sign.
[[nodiscard]] Color color_of(double sample);

/// In the cell, 0 … 1: a zero cell vertex, or the crossing by linear interpolation.
[[nodiscard]] Eigen::Vector3d position_of(zmc::CellSurfaceVertex vertex, const Samples& samples);

[[nodiscard]] std::set<Edge> patch_edges_of(const zmc::CellPatches& cell);

/// "P = 2422, R = 16".
[[nodiscard]] std::string name_of(const zmc::CellPatches& cell);

/// The lattice seen obliquely from above: from lattice coordinates to the page.
class ObliqueView {
 public:
  /// `middle` (lattice coordinates) comes to (x, y) on the page; `scale` pixels for a lattice edge.
  ObliqueView(const Eigen::Vector3d& middle, double x, double y, double scale);
  [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& p) const;
  [[nodiscard]] double scale() const { return scale_; }

 private:
  Eigen::Vector3d middle_, place_;
  double scale_;
};

/// Frame, samples, patches and patch edges of a cell whose vertex 0 is at `corner`.
void draw_cell(Page& page, const ObliqueView& view, const Samples& samples,
               const Eigen::Vector3d& corner = Eigen::Vector3d::Zero());

/// What the colors mean, in one line.
void draw_legend(Page& page, double x, double y);

}  // namespace shape3d::apps
