// CGAL's alpha wrap is here alone.
#include "shape3d/mapping/wrap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include "mesh_arguments.hpp"
#include "scaled.hpp"
#include "shape3d/mapping/inspect.hpp"

namespace shape3d::mapping {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

void check_option(const char* name, double value, double least, double most) {
  if (value >= least && value <= most) return;
  std::ostringstream text;
  text << "options." << name << ": expected a number from " << least << " to " << most << ", got "
       << value;
  throw std::invalid_argument(text.str());
}

class Wrapper {
 public:
  Wrapper(const ConstPoints& V, const ConstTriangles& F, const WrapOptions& options)
      : options_(options), scale_(detail::scale_of(V)) {
    Eigen::RowVector3d lower = Eigen::RowVector3d::Constant(std::numeric_limits<double>::max());
    Eigen::RowVector3d upper = -lower;
    for (Eigen::Index v = 0; v < V.rows(); ++v)
      points_.emplace_back(V(v, 0) / scale_, V(v, 1) / scale_, V(v, 2) / scale_);
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
      std::array<std::size_t, 3> triangle{};
      for (Eigen::Index i = 0; i < 3; ++i) {
        triangle[static_cast<std::size_t>(i)] = static_cast<std::size_t>(F(t, i));
        lower = lower.cwiseMin(V.row(F(t, i)) / scale_);
        upper = upper.cwiseMax(V.row(F(t, i)) / scale_);
      }
      triangles_.push_back(triangle);
    }
    diagonal_ = F.rows() == 0 ? 0.0 : (upper - lower).norm();
    if (!(diagonal_ > 0.0)) {
      throw std::invalid_argument("F: the vertices of the " + std::to_string(F.rows()) +
                                  " triangles coincide, so there is nothing to wrap");
    }
  }

  Wrapped run() {
    constexpr double kStep = 1.5;
    const double steps = std::ceil(std::log(options_.finest / options_.coarsest) / std::log(kStep));
    std::optional<double> good, bad;
    for (double i = 0; i <= steps && !bad; ++i) {
      const double detail = std::min(options_.finest, options_.coarsest * std::pow(kStep, i));
      if (!report(i / (steps + 4))) return cancelled();
      if (attempt(detail)) {
        good = detail;
      } else if (good) {
        bad = detail;  // before the first good one, a finer α may still close what is apart
      }
    }
    while (good && bad && *bad / *good > options_.ratio) {
      if (!report((steps + 2) / (steps + 4))) return cancelled();
      const double middle = std::sqrt(*good * *bad);
      (attempt(middle) ? good : bad) = middle;
    }
    result_.status = good ? WrapStatus::ok : WrapStatus::no_sphere;
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool report(double share) const {
    return !options_.progress || options_.progress(share);
  }

  Wrapped cancelled() const {
    Wrapped result;
    result.status = WrapStatus::cancelled;
    result.attempts = result_.attempts;
    return result;
  }

  // Wraps with α = diagonal / detail, and keeps the wrap if it is a sphere.
  bool attempt(double detail) {
    const double alpha = diagonal_ / detail, offset = alpha / options_.offset;
    Mesh mesh;
    CGAL::alpha_wrap_3(points_, triangles_, alpha, offset, mesh);
    mesh.collect_garbage();
    Points V(static_cast<Eigen::Index>(mesh.number_of_vertices()), 3);
    Triangles F(static_cast<Eigen::Index>(mesh.number_of_faces()), 3);
    for (const Mesh::Vertex_index v : mesh.vertices()) {
      const Kernel::Point_3& p = mesh.point(v);
      V.row(v.idx()) << p.x() * scale_, p.y() * scale_, p.z() * scale_;
    }
    for (const Mesh::Face_index f : mesh.faces()) {
      Eigen::Index i = 0;
      for (const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f)))
        F(f.idx(), i++) = static_cast<std::int32_t>(v.idx());
    }
    const Inspection found = inspect(V, F);
    result_.attempts.push_back({alpha * scale_, found.triangles, found.components, found.euler});
    if (!found.spherical()) return false;
    result_.V = std::move(V);
    result_.F = std::move(F);
    result_.alpha = alpha * scale_;
    result_.offset = offset * scale_;
    return true;
  }

  const WrapOptions& options_;
  double scale_, diagonal_ = 0.0;
  std::vector<Kernel::Point_3> points_;
  std::vector<std::array<std::size_t, 3>> triangles_;
  Wrapped result_;
};

}  // namespace

std::string_view to_string(WrapStatus status) {
  switch (status) {
    case WrapStatus::ok:
      return "a wrap of genus 0";
    case WrapStatus::no_sphere:
      return "every wrap that was tried has handles or several pieces";
    case WrapStatus::cancelled:
      return "cancelled by the caller";
  }
  return "unknown status";
}

Wrapped wrap(const ConstPoints& V, const ConstTriangles& F, const WrapOptions& options) {
  check_option("coarsest", options.coarsest, 1.0, 1000.0);
  check_option("finest", options.finest, options.coarsest, 1000.0);
  check_option("offset", options.offset, 2.0, 1000.0);
  check_option("ratio", options.ratio, 1.001, 2.0);
  detail::check_indices(V, F);
  detail::check_finite(V);
  return Wrapper(V, F, options).run();
}

}  // namespace shape3d::mapping
