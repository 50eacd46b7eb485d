#pragma once

#include "shape3d/descriptors/hsh.hpp"

namespace shape3d::descriptors::detail {

/// ρ of an angle θ0, the inverse of hsh_angle(); of two_sided for both halves. More than 1 where
/// nothing of the ball arrives.
double ball_radius(SphereMap map, double stretch, double theta0);

/// The measure of S³ per volume of the ball (in units of ρ), averaged over the radii from `low` to
/// `high` within [0, 1]: ∫ sin² θ0 dθ0 / ∫ ρ² dρ. Of one half for two_sided, whose density
/// 1/√(1−ρ²) has no value at the end; 3π/2 everywhere for equal_volume.
double mean_density(SphereMap map, double stretch, double low, double high);

/// Refuses options that are out of range; K also against `largest`, K's limit, unless negative.
void check_options(const HshOptions& options);

}  // namespace shape3d::descriptors::detail
