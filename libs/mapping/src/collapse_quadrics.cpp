#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "cgal_edge_collapse.hpp"

namespace shape3d::mapping::detail {
namespace {

using Point = CollapseKernel::Point_3;
using VertexIndex = CollapseMesh::Vertex_index;

/// f(x) = Σ weight · (distance of x to a plane)² = xᵀ A x + 2 bᵀ x + c.
struct Quadric {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double c = 0.0, area = 0.0;

  void add_plane(const Eigen::Vector3d& unit_normal, const Eigen::Vector3d& point, double weight) {
    const double offset = -unit_normal.dot(point);
    A += weight * unit_normal * unit_normal.transpose();
    b += weight * offset * unit_normal;
    c += weight * offset * offset;
  }
  Quadric& operator+=(const Quadric& other) {
    A += other.A;
    b += other.b;
    c += other.c;
    area += other.area;
    return *this;
  }
  [[nodiscard]] double at(const Eigen::Vector3d& x) const {
    return std::max(0.0, x.dot(A * x + 2.0 * b) + c);
  }
};

Eigen::Vector3d to_eigen(const Point& p) { return {p.x(), p.y(), p.z()}; }

// The point of least f; along directions in which f hardly changes, that nearest to `start`.
Eigen::Vector3d minimum(const Quadric& q, const Eigen::Vector3d& start) {
  constexpr double kFlat = 1e-3;  // eigenvalues below this part of the largest: flat
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(q.A);
  const Eigen::Vector3d slope = eigen.eigenvectors().transpose() * (q.b + q.A * start);
  Eigen::Vector3d x = start;
  for (int i = 0; i < 3; ++i) {
    const double value = eigen.eigenvalues()[i];
    if (value > kFlat * eigen.eigenvalues()[2]) x -= slope[i] / value * eigen.eigenvectors().col(i);
  }
  return x;
}

/// Quadrics of the vertices; costs and placements of the edges, kept as long as they hold. A
/// collapse changes those of the edges at its vertex alone, but CGAL asks for all edges of the
/// neighbours anew, five times as many.
class Quadrics {
 public:
  Quadrics(const CollapseTask& task, const CollapseMesh& mesh)
      : lattice_(task.lattice),
        quadrics_(mesh.number_of_vertices()),
        changes_(mesh.number_of_vertices(), 0),
        entries_(mesh.number_of_edges()) {
    for (const auto face : mesh.faces()) {
      const auto h = mesh.halfedge(face);
      const std::array<VertexIndex, 3> ids{mesh.target(h), mesh.target(mesh.next(h)),
                                           mesh.source(h)};
      const Eigen::Vector3d p = to_eigen(mesh.point(ids[0]));
      const Eigen::Vector3d normal =
          (to_eigen(mesh.point(ids[1])) - p).cross(to_eigen(mesh.point(ids[2])) - p);
      const double length = normal.norm();
      if (!(length > 0.0)) continue;
      Quadric quadric;
      quadric.add_plane(normal / length, p, 0.5 * length);
      quadric.area = 0.5 * length;
      for (const VertexIndex v : ids) quadrics_[v] += quadric;
    }
    for (const auto h : mesh.halfedges()) {
      if (mesh.is_border(h)) add_border(mesh, mesh.opposite(h));
    }
  }

  struct Entry {
    VertexIndex v0, v1;
    std::uint32_t changes0 = 0, changes1 = 0;
    Point placement;
    double cost = 0.0;
  };

  template <class Profile>
  const Entry& entry_of(const Profile& profile) {
    Entry& entry = entries_[profile.v0_v1().idx() / 2];
    const VertexIndex v0 = profile.v0(), v1 = profile.v1();
    if (entry.v0 != v0 || entry.v1 != v1 || entry.changes0 != changes_[v0] ||
        entry.changes1 != changes_[v1]) {
      entry = {v0, v1, changes_[v0], changes_[v1], {}, 0.0};
      evaluate(to_eigen(profile.p0()), to_eigen(profile.p1()), entry);
    }
    return entry;
  }

  template <class Profile>
  void collapsed(const Profile& profile, VertexIndex kept) {
    quadrics_[kept] += quadrics_[profile.v0() == kept ? profile.v1() : profile.v0()];
    ++changes_[kept];
  }

 private:
  // A plane through a boundary edge, across its triangle, keeps the boundary in its place.
  void add_border(const CollapseMesh& mesh, CollapseMesh::Halfedge_index h) {
    constexpr double kWeight = 10.0;
    const Eigen::Vector3d a = to_eigen(mesh.point(mesh.source(h))),
                          b = to_eigen(mesh.point(mesh.target(h))),
                          c = to_eigen(mesh.point(mesh.target(mesh.next(h))));
    const Eigen::Vector3d across = (b - a).cross((b - a).cross(c - a));
    if (!(across.norm() > 0.0)) return;
    Quadric quadric;
    quadric.add_plane(across.normalized(), a, kWeight * (b - a).squaredNorm());
    quadrics_[mesh.source(h)] += quadric;
    quadrics_[mesh.target(h)] += quadric;
  }

  void evaluate(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, Entry& entry) const {
    // Where f is zero all over (flat places), short edges go first.
    constexpr double kShort = 1e-9;
    Quadric sum = quadrics_[entry.v0];
    sum += quadrics_[entry.v1];
    const Eigen::Vector3d middle = 0.5 * (p0 + p1);
    Eigen::Vector3d x = minimum(sum, middle);
    const double reach = (p1 - p0).squaredNorm();
    if (!((x - middle).squaredNorm() <= 4.0 * reach)) {  // nearly flat: far off, or not a number
      x = middle;
      for (const Eigen::Vector3d& end : {p0, p1})
        if (sum.at(end) < sum.at(x)) x = end;
    }
    if (x != p0 && x != p1)
      for (int i = 0; i < 3; ++i) x[i] = on_lattice(x[i], lattice_);
    entry.placement = {x[0], x[1], x[2]};
    entry.cost = sum.at(x) + kShort * sum.area * reach;
  }

  double lattice_;
  std::vector<Quadric> quadrics_;
  std::vector<std::uint32_t> changes_;
  std::vector<Entry> entries_;
};

struct Placement {
  Quadrics* quadrics;
  template <class Profile>
  boost::optional<Point> operator()(const Profile& profile) const {
    return quadrics->entry_of(profile).placement;
  }
};

struct Cost {
  using Update_tag = CGAL::Tag_true;  // CGAL calls initialize() and update_after_collapse()
  Quadrics* quadrics;

  template <class Profile>
  boost::optional<double> operator()(const Profile& profile, const boost::optional<Point>&) const {
    return quadrics->entry_of(profile).cost;
  }
  template <class... Arguments>
  void initialize(const Arguments&...) const {}
  template <class Profile>
  void update_after_collapse(const Profile& profile, VertexIndex kept) const {
    quadrics->collapsed(profile, kept);
  }
};

}  // namespace

std::vector<Collapse> collapse_by_quadrics(const CollapseTask& task, bool& cancelled) {
  std::vector<Collapse> collapses;
  CollapseMesh mesh = to_collapse_mesh(task);
  StopAt stop(task, cancelled);
  Quadrics quadrics(task, mesh);
  run_edge_collapse(mesh, stop, Recorder(task, mesh, stop, collapses), Cost{&quadrics},
                    Placement{&quadrics});
  return collapses;
}

}  // namespace shape3d::mapping::detail
