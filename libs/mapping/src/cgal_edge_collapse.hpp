#pragma once

// What the sources that call CGAL's edge_collapse share; included by them alone.

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "edge_collapse.hpp"

namespace shape3d::mapping::detail {

using CollapseKernel = CGAL::Simple_cartesian<double>;
using CollapseMesh = CGAL::Surface_mesh<CollapseKernel::Point_3>;

inline CollapseMesh to_collapse_mesh(const CollapseTask& task) {
  CollapseMesh mesh;
  mesh.reserve(static_cast<CollapseMesh::size_type>(task.V.rows()),
               static_cast<CollapseMesh::size_type>(3 * task.F.rows() / 2),
               static_cast<CollapseMesh::size_type>(task.F.rows()));
  for (Eigen::Index v = 0; v < task.V.rows(); ++v) {
    mesh.add_vertex({task.V(v, 0) / task.unit, task.V(v, 1) / task.unit, task.V(v, 2) / task.unit});
  }
  const auto vertex = [](std::int32_t v) {
    return CollapseMesh::Vertex_index(static_cast<CollapseMesh::size_type>(v));
  };
  for (Eigen::Index t = 0; t < task.F.rows(); ++t)
    mesh.add_face(vertex(task.F(t, 0)), vertex(task.F(t, 1)), vertex(task.F(t, 2)));
  return mesh;
}

/// The nearest multiple of `lattice`; 0, not −0.
inline double on_lattice(double x, double lattice) {
  return lattice * std::nearbyint(x / lattice) + 0.0;
}

/// The nearest lattice point, unless the placement is an end of the edge.
template <class Placement>
class OnLattice {
 public:
  OnLattice(Placement placement, double lattice)
      : placement_(std::move(placement)), lattice_(lattice) {}

  template <class Profile>
  boost::optional<typename Profile::Point> operator()(const Profile& profile) const {
    auto point = placement_(profile);
    if (!point || *point == profile.p0() || *point == profile.p1()) return point;
    const auto round = [this](double x) { return on_lattice(x, lattice_); };
    return typename Profile::Point(round(point->x()), round(point->y()), round(point->z()));
  }

 private:
  Placement placement_;
  double lattice_;
};

/// Ends at a number of triangles, and when the caller says so.
class StopAt {
 public:
  StopAt(const CollapseTask& task, bool& cancelled)
      : task_(&task), cancelled_(&cancelled), triangles_(task.F.rows()) {}

  void removed(std::int64_t triangles) { triangles_ -= triangles; }

  bool stop() {
    if (++calls_ % 1024 == 0 && !*cancelled_) {
      const auto all = static_cast<double>(task_->F.rows() - task_->coarsest);
      *cancelled_ = !task_->progress(static_cast<double>(task_->F.rows() - triangles_) / all);
    }
    return *cancelled_ || triangles_ <= task_->coarsest;
  }

 private:
  const CollapseTask* task_;
  bool* cancelled_;
  std::int64_t triangles_;
  std::int64_t calls_ = 0;
};

struct StopPredicate {
  StopAt* state;
  template <class... Arguments>
  bool operator()(const Arguments&...) const {
    return state->stop();
  }
};

/// Records collapses.
class Recorder
    : public CGAL::Surface_mesh_simplification::Edge_collapse_visitor_base<CollapseMesh> {
 public:
  Recorder(const CollapseTask& task, CollapseMesh& mesh, StopAt& stop,
           std::vector<Collapse>& collapses)
      : unit_(task.unit), mesh_(&mesh), stop_(&stop), collapses_(&collapses) {}

  void OnCollapsed(const Profile& profile, const vertex_descriptor& kept) {
    const vertex_descriptor removed = profile.v0() == kept ? profile.v1() : profile.v0();
    const Point& p = mesh_->point(kept);
    collapses_->push_back({static_cast<std::int32_t>(removed.idx()),
                           static_cast<std::int32_t>(kept.idx()),
                           {p.x() * unit_, p.y() * unit_, p.z() * unit_}});
    stop_->removed((profile.left_face_exists() ? 1 : 0) + (profile.right_face_exists() ? 1 : 0));
  }

 private:
  double unit_;
  CollapseMesh* mesh_;
  StopAt* stop_;
  std::vector<Collapse>* collapses_;
};

template <class Visitor, class Cost, class Placement>
void run_edge_collapse(CollapseMesh& mesh, StopAt& stop, Visitor visitor, const Cost& cost,
                       const Placement& placement) {
  namespace SMS = CGAL::Surface_mesh_simplification;
  // Collapses that turn a triangle by more than a right angle are not made.
  SMS::edge_collapse(mesh, StopPredicate{&stop},
                     CGAL::parameters::get_cost(cost)
                         .get_placement(placement)
                         .filter(SMS::Bounded_normal_change_filter<>())
                         .visitor(visitor));
}

}  // namespace shape3d::mapping::detail
