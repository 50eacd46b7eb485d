#pragma once

#include "distance_rows.hpp"

namespace shape3d::levelset::detail {

/// Which curvature a step has.
enum class CurvatureTerm { none, mean, minimal };

/// What a step of the evolution is made with.
struct Step {
  float dt = 0.0F;
  /// Local time steps: where |F_A| is small the step is longer, up to this many times, and such
  /// that |F_A|·Δt is at most `most`·dt.
  float gain = 1.0F;
  float most = 1.0F;           ///< Largest |F_A|.
  float curvature = 0.0F;      ///< ε, mm.
  float max_curvature = 0.0F;  ///< |κ| is cut at this, 1/mm: at extrema of ψ it has no bound.
  float limit = 0.0F;          ///< |ψ| is cut at this, mm.
  CurvatureTerm term = CurvatureTerm::none;
};

/// Nodes of a tile that changed sides in a step.
struct Change {
  int crossed = 0;  ///< All of them.
  int inside = 0;   ///< Those that came inside, less those that left; zero belongs to the inside.
};

/// out = ψ − Δt·(advance·|∇ψ|_upwind − factor·ε·κ·|∇ψ|_central) in the rows of a mask.
///
/// |∇ψ|_upwind by Godunov: of the one-sided differences along an axis, that which looks against the
/// motion of the front.
/// @param psi  Padded, as `out`; `advance` and `factor` are dense.
Change advance_rows(const TileRows& rows, RowMask mask, const float* psi, const float* advance,
                    const float* factor, const Spacings& spacings, const Step& step, float* out);

/// Sums over the nodes of some rows, in an order that no instruction set changes.
struct Measures {
  int inside = 0;       ///< Nodes with ψ ≤ 0.
  int near = 0;         ///< Nodes with |ψ| < w.
  double volume = 0.0;  ///< Σ clamp(½ − ψ/2w, 0, 1), in nodes.
};
/// The same of each row of a tile.
struct RowMeasures {
  float volume[64] = {};
  std::uint8_t near[64] = {};
};
/// @param by_row  Only the rows of the mask are set.
Measures measure_rows(const TileRows& rows, RowMask mask, const float* psi, float w,
                      RowMeasures& by_row);

}  // namespace shape3d::levelset::detail
