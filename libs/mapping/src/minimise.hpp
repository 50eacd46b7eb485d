#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "shape3d/mapping/mesh.hpp"
#include "shape3d/mapping/spherical_map.hpp"
#include "surface.hpp"

namespace shape3d::mapping {

struct MinimiseSettings {
  Energy energy = Energy::conformal;
  double area_weight = 0;  ///< Of the squared logarithm of the area scale; ≥ 0.
  int max_iterations = 100;
  double function_tolerance = 1e-4;
  double largest_radius = 1e16;      ///< Of the trust region.
  std::vector<std::int32_t> order;   ///< Of elimination: elimination_order().
  std::function<bool(int)> iterate;  ///< Told the iteration; false cancels.
};

/// Minimises the energy over positions on the sphere by Ceres, from a map without flipped triangles
/// to another.
///
/// Three vertices stay pinned, which fixes the Möbius group.
///
/// First with det J smoothed by a twentieth of its first value, so that a needle that is about to
/// flip cannot hold up all the others; if it does all the same, by half of it, and by a twentieth
/// again. Flipped triangles that remain are untangled and a strict
/// minimisation follows, whose steps never flip one; if they cannot be, it starts from S.
/// @return false when cancelled.
bool minimise(const ConstPoints& V, const ConstTriangles& F, const Twins& twins,
              const MinimiseSettings& settings, Points& S, MinimisationSummary& summary);

/// Minimises the mean over the triangles of 2 δ (√(|Δ|² + δ²) − δ) + λ (σ1/σ2 + σ2/σ1 − 2), Δ the
/// changes of a triangle's three angles, δ and λ 0.03: nearly the mean change of an angle, which
/// measure_distortion() reports, with a barrier against flips and needles.
/// Smoothed, untangled and strict as above.
///
/// One vertex is held. The energy is not invariant under Möbius maps, so that they are no gauge: a
/// mesh on the sphere comes back as it is, but for a rotation.
/// @param settings  energy and area_weight do not matter.
/// @return false when cancelled.
bool refine_angles(const ConstPoints& V, const ConstTriangles& F, const Twins& twins,
                   const MinimiseSettings& settings, Points& S, MinimisationSummary& summary);

}  // namespace shape3d::mapping
