#pragma once

#include "shape3d/learning/som.hpp"

namespace shape3d::learning::detail {

/// Best units of scaled items.
/// @param both  Whether `second` is looked for; else it is empty.
BestUnits search_units(const Features& prototypes, const Features& scaled, bool both, int threads);

}  // namespace shape3d::learning::detail
