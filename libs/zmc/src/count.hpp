#pragma once

#include "classify.hpp"
#include "plan.hpp"
#include "zero_regions.hpp"

namespace shape3d::zmc::detail {

/// Counts what extraction of a part of the lattice will produce, finds the zero faces and marks the
/// used zero samples in the lattice.
/// @return false when the loop was cancelled.
bool make_plan(SignLattice& lattice, const LatticeCells& cells, const ZeroRegions& regions,
               const Options& options, const Plan::Part& part, const LayerLoop& for_layers,
               Plan& plan);

}  // namespace shape3d::zmc::detail
