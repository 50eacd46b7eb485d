#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>

#include "cgal_edge_collapse.hpp"

namespace shape3d::mapping::detail {

std::vector<Collapse> collapse_by_lindstrom_turk(const CollapseTask& task, bool& cancelled) {
  namespace SMS = CGAL::Surface_mesh_simplification;
  std::vector<Collapse> collapses;
  CollapseMesh mesh = to_collapse_mesh(task);
  StopAt stop(task, cancelled);
  run_edge_collapse(mesh, stop, Recorder(task, mesh, stop, collapses),
                    SMS::LindstromTurk_cost<CollapseMesh>(),
                    OnLattice<SMS::LindstromTurk_placement<CollapseMesh>>(
                        SMS::LindstromTurk_placement<CollapseMesh>(), task.lattice));
  return collapses;
}

}  // namespace shape3d::mapping::detail
