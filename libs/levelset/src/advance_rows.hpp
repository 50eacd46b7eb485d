#pragma once

#include "distance_rows.hpp"

namespace shape3d::levelset::detail {

/// Which curvature a step has.
enum class CurvatureTerm { none, mean, minimal };

/// What a step of the evolution is made with.
struct Step {
  float dt = 0.0F;
  float curvature = 0.0F;      ///< ε, mm.
  float max_curvature = 0.0F;  ///< |κ| is cut at this, 1/mm: at extrema of ψ it has no bound.
  float limit = 0.0F;          ///< |ψ| is cut at this, mm.
  CurvatureTerm term = CurvatureTerm::none;
};

/// out = ψ − Δt·(advance·|∇ψ|_upwind − factor·ε·κ·|∇ψ|_central) for a row of nodes.
///
/// |∇ψ|_upwind by Godunov: of the one-sided differences along an axis, that which looks against the
/// motion of the front. `row` and `slice` are the strides of the padded field of ψ.
void advance_row(const float* psi, std::int64_t row, std::int64_t slice, const float* advance,
                 const float* factor, int count, const Spacings& spacings, const Step& step,
                 float* out);

/// The number of nodes of a row with |ψ| < limit.
int count_near(const float* psi, int count, float limit);

/// What changed in the nodes of a row, summed in an order that no instruction set changes.
struct Change {
  int crossed = 0;       ///< Nodes that changed sides; zero belongs to the inside.
  int inside = 0;        ///< Nodes with ψ ≤ 0.
  float lanes[16] = {};  ///< Σ clamp(½ − ψ·slope, 0, 1), the volume inside in nodes, in 16 parts.
};
void add_change(const float* before, const float* after, int count, float slope, Change& change);

}  // namespace shape3d::levelset::detail
