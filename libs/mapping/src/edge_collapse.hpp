#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "shape3d/mapping/mesh.hpp"
#include "shape3d/mapping/progressive.hpp"

namespace shape3d::mapping::detail {

/// An edge collapse: vertex `removed` is joined to `kept`, which moves to `position`.
struct Collapse {
  std::int32_t removed = 0, kept = 0;
  Eigen::RowVector3d position;
};

/// What edge collapses are made of.
struct CollapseTask {
  const ConstPoints& V;
  const ConstTriangles& F;
  double unit = 1.0;  ///< A power of two; coordinates divided by it are at most 2.
  double lattice =
      0.0;  ///< A power of two, in the unit of V / unit, that new positions are multiples of.
  std::int64_t coarsest = 4;
  std::function<bool(double)> progress;  ///< Never empty.
};

/// The collapses in the order they were made; `cancelled` is set when progress returned false.
/// Each is in a source of its own: CGAL's edge_collapse takes long to compile.
std::vector<Collapse> collapse_by_quadrics(const CollapseTask& task, bool& cancelled);
std::vector<Collapse> collapse_by_lindstrom_turk(const CollapseTask& task, bool& cancelled);
std::vector<Collapse> collapse_by_hoppe(const CollapseTask& task, const HoppeOptions& options,
                                        bool& cancelled);

}  // namespace shape3d::mapping::detail
