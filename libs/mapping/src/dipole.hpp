#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "intrinsic.hpp"
#include "mobius.hpp"

namespace shape3d::mapping {

/// Triangles of a triangulation in the order in which to try them as poles: well-shaped ones in the
/// middle of the surface first, each far from those before it.
/// @param extremity  A vertex at an end of the surface, from which other ends are looked for.
[[nodiscard]] std::vector<std::int32_t> pole_candidates(const IntrinsicTriangulation& mesh,
                                                        std::int32_t extremity, std::size_t count);

/// Discrete harmonic maps to the plane with a dipole at a triangle (Angenent, Haker, Tannenbaum,
/// Kikinis 1999): L z = b, with one factorisation of the cotangent Laplacian for all poles.
///
/// With weights ≥ 0 every vertex off the pole lies in the hull of its neighbours: the map is
/// Tutte's embedding in the triangle that the pole's vertices form, whose outside is the pole.
class DipoleSolver {
 public:
  /// @param order  In which the vertices are eliminated: see elimination_order().
  DipoleSolver(const IntrinsicTriangulation& mesh, const std::vector<std::int32_t>& order);
  ~DipoleSolver();
  DipoleSolver(const DipoleSolver&) = delete;
  DipoleSolver& operator=(const DipoleSolver&) = delete;

  [[nodiscard]] bool factorised() const;
  /// Triangles other than the pole come out counter-clockwise.
  [[nodiscard]] PlanePoints solve(std::int32_t pole) const;

 private:
  struct State;
  const IntrinsicTriangulation& mesh_;
  std::unique_ptr<State> state_;
};

/// Removes the constant part c of the second dilatation, f_z̄ = c conj(f_z), of the map z of the
/// triangulation: w = (z − c z̄) / (1 − |c|²), with c the median over the area, apart for the real
/// and the imaginary part. An affine map: what is embedded stays so.
/// @return c
Complex remove_dilatation(const IntrinsicTriangulation& mesh, std::int32_t pole, PlanePoints& z);

}  // namespace shape3d::mapping
