#pragma once

#include "classify.hpp"
#include "geometry.hpp"
#include "plan.hpp"
#include "shape3d/zmc/surface.hpp"

namespace shape3d::zmc::detail {

/// Writes the planned surface. `surface` is sized already.
/// @return false when the loop was cancelled.
template <class Real, class Index>
bool generate(const VolumeView& view, double isovalue, const Options& options,
              const Geometry& geometry, const LatticeCells& cells, const Plan& plan,
              const LayerLoop& for_layers, Surface<Real, Index>& surface);

}  // namespace shape3d::zmc::detail
