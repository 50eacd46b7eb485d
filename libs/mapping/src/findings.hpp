#pragma once

#include <array>
#include <cstdint>

#include "shape3d/mapping/inspect.hpp"

namespace shape3d::mapping::detail {

/// The first place of each defect that was found, for its sentence.
struct Examples {
  std::int64_t not_finite_vertex = -1, isolated_vertex = -1, nonmanifold_vertex = -1;
  std::int64_t out_of_range_triangle = -1, degenerate_triangle = -1, duplicate_triangle = -1,
               zero_area_triangle = -1;
  std::array<std::int32_t, 2> boundary_edge{}, nonmanifold_edge{}, misoriented_edge{};
  bool positive_area = false, positive_volume = false;
};

/// Fills result.findings from its counts.
void add_findings(Inspection& result, const Examples& examples);

}  // namespace shape3d::mapping::detail
