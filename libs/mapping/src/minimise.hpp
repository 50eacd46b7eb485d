#pragma once

#include <functional>

#include "shape3d/mapping/mesh.hpp"
#include "shape3d/mapping/spherical_map.hpp"
#include "surface.hpp"

namespace shape3d::mapping {

struct MinimiseSettings {
  Energy energy = Energy::conformal;
  double area_weight = 0;  ///< Of the squared logarithm of the area scale; ≥ 0.
  int max_iterations = 100;
  double function_tolerance = 1e-4;
  std::function<bool(int)> iterate;  ///< Told the iteration; false cancels.
};

/// Minimises the energy over positions on the sphere by Ceres, from a map without flipped triangles
/// to another. Three vertices stay pinned, which fixes the Möbius group.
///
/// First with det J smoothed by a twentieth of its first value, so that a needle that is about to
/// flip cannot hold up all the others; if it does all the same, by half of it, and by a twentieth
/// again. Flipped triangles that remain are untangled and a strict
/// minimisation follows, whose steps never flip one; if they cannot be, it starts from S.
/// @return false when cancelled.
bool minimise(const ConstPoints& V, const ConstTriangles& F, const Twins& twins,
              const MinimiseSettings& settings, Points& S, MinimisationSummary& summary);

}  // namespace shape3d::mapping
