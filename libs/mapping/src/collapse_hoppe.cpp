#include "cgal_edge_collapse.hpp"
#include "hoppe_energy.hpp"

namespace shape3d::mapping::detail {
namespace {

using Point = CollapseKernel::Point_3;
using VertexIndex = CollapseMesh::Vertex_index;
using HalfedgeIndex = CollapseMesh::Halfedge_index;

std::int32_t id(VertexIndex v) { return static_cast<std::int32_t>(v.idx()); }

/// The triangles round the edge of a profile, before its collapse.
template <class Profile>
EdgeStar star_of(const Profile& profile) {
  const CollapseMesh& mesh = profile.surface_mesh();
  EdgeStar star;
  star.v0 = id(profile.v0());
  star.v1 = id(profile.v1());
  if (profile.left_face_exists()) star.left = id(profile.vL());
  if (profile.right_face_exists()) star.right = id(profile.vR());
  for (const VertexIndex v : {profile.v0(), profile.v1()}) {
    const VertexIndex other = v == profile.v0() ? profile.v1() : profile.v0();
    for (const HalfedgeIndex h : CGAL::halfedges_around_target(v, mesh)) {
      const auto face = mesh.face(h);
      if (mesh.is_border(h)) continue;
      const VertexIndex a = mesh.target(mesh.next(h)), b = mesh.source(h);
      const auto number = static_cast<std::int32_t>(face.idx());
      if (a == other || b == other) {
        if (v == profile.v0()) star.removed.push_back(number);
        continue;
      }
      star.faces.push_back(number);
      star.corners.push_back({id(v), id(a), id(b)});
    }
  }
  return star;
}

/// The same after the collapse of an edge of length 0, which CGAL does not announce.
EdgeStar star_at(const CollapseMesh& mesh, VertexIndex removed, VertexIndex kept) {
  EdgeStar star;
  star.v0 = id(removed);
  star.v1 = id(kept);
  for (const HalfedgeIndex h : CGAL::halfedges_around_target(kept, mesh)) {
    if (mesh.is_border(h)) continue;
    star.faces.push_back(static_cast<std::int32_t>(mesh.face(h).idx()));
    star.corners.push_back({id(kept), id(mesh.target(mesh.next(h))), id(mesh.source(h))});
  }
  return star;
}

/// The energy, the choice made for the edge that was asked for last, and the star of the edge that
/// is being collapsed.
struct State {
  HoppeEnergy energy;
  VertexIndex v0, v1;
  std::optional<HoppeEnergy::Choice> choice;
  std::optional<EdgeStar> collapsing;

  template <class Profile>
  void evaluate(const Profile& profile) {
    v0 = profile.v0();
    v1 = profile.v1();
    choice = energy.evaluate(star_of(profile));
  }
};

struct Placement {
  State* state;
  template <class Profile>
  boost::optional<Point> operator()(const Profile& profile) const {
    state->evaluate(profile);
    if (!state->choice) return boost::none;
    const Eigen::Vector3d& p = state->choice->position;
    return Point(p[0], p[1], p[2]);
  }
};

struct Cost {
  using Update_tag = CGAL::Tag_true;
  State* state;
  template <class Profile>
  boost::optional<double> operator()(const Profile& profile,
                                     const boost::optional<Point>& placement) const {
    if (!placement) return boost::none;
    if (state->v0 != profile.v0() || state->v1 != profile.v1()) state->evaluate(profile);
    return state->choice->cost;
  }
  template <class... Arguments>
  void initialize(const Arguments&...) const {}
  template <class Profile>
  void update_after_collapse(const Profile& profile, VertexIndex kept) const {
    const CollapseMesh& mesh = profile.surface_mesh();
    const VertexIndex removed = profile.v0() == kept ? profile.v1() : profile.v0();
    const EdgeStar star = state->collapsing ? *state->collapsing : star_at(mesh, removed, kept);
    state->collapsing.reset();
    const Point& p = mesh.point(kept);
    state->energy.collapse(star, id(removed), id(kept), {p.x(), p.y(), p.z()});
  }
};

class HoppeRecorder : public Recorder {
 public:
  HoppeRecorder(const Recorder& recorder, State& state) : Recorder(recorder), state_(&state) {}
  void OnCollapsing(const Profile& profile, const boost::optional<Point>&) {
    state_->collapsing = star_of(profile);
  }

 private:
  State* state_;
};

}  // namespace

std::vector<Collapse> collapse_by_hoppe(const CollapseTask& task, const HoppeOptions& options,
                                        bool& cancelled) {
  std::vector<Collapse> collapses;
  CollapseMesh mesh = to_collapse_mesh(task);
  StopAt stop(task, cancelled);
  std::vector<Eigen::Vector3d> P;
  for (Eigen::Index v = 0; v < task.V.rows(); ++v)
    P.push_back(task.V.row(v).transpose() / task.unit);
  State state{HoppeEnergy(std::move(P), task.F, options), {}, {}, {}, {}};
  run_edge_collapse(mesh, stop, HoppeRecorder(Recorder(task, mesh, stop, collapses), state),
                    Cost{&state}, OnLattice<Placement>(Placement{&state}, task.lattice));
  return collapses;
}

}  // namespace shape3d::mapping::detail
