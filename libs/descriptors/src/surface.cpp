#include "shape3d/descriptors/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "text.hpp"

namespace shape3d::descriptors {
namespace {

using Eigen::Vector3d;
using PointsRef = Eigen::Ref<const Points>;
using TrianglesRef = Eigen::Ref<const Triangles>;

// The vertices that triangles use, moved to the middle of their box and divided by its longest
// side.
struct Normalised {
  Vector3d middle;
  double size;  // 0 when all coincide

  Normalised(const PointsRef& V, const TrianglesRef& F) {
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
      for (int corner = 0; corner < 3; ++corner) {
        const Vector3d p = V.row(F(t, corner)).transpose();
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    middle = 0.5 * low + 0.5 * high;  // the sum could overflow
    size = (high - low).maxCoeff();
  }

  [[nodiscard]] Vector3d point(const PointsRef& V, std::int32_t vertex) const {
    return (V.row(vertex).transpose() - middle) / size;
  }
};

double triangle_area(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

// Number of parts that each edge of a triangle is divided into.
std::int64_t divisions(const Vector3d& a, const Vector3d& b, const Vector3d& c, double max_edge) {
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(longest / max_edge)));
}

// Calls use(point, weight) at the quadrature points of a triangle, as surface_points() says.
template <class Use>
void for_each_quadrature_point(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                               std::int64_t n, Use&& use) {
  const auto parts = static_cast<double>(n);
  const Vector3d u = (b - a) / parts, v = (c - a) / parts;
  const double weight = triangle_area(a, b, c) / (3.0 * parts * parts);
  const auto small = [&](const Vector3d& corner, double sign) {
    // Corners `corner`, corner + sign u, corner + sign v.
    use(corner + sign * (u + v) / 6.0, weight);
    use(corner + sign * (4.0 * u + v) / 6.0, weight);
    use(corner + sign * (u + 4.0 * v) / 6.0, weight);
  };
  for (std::int64_t i = 0; i < n; ++i) {
    for (std::int64_t j = 0; i + j < n; ++j) {
      const Vector3d corner = a + static_cast<double>(i) * u + static_cast<double>(j) * v;
      small(corner, 1.0);
      if (i + j + 1 < n) small(corner + u + v, -1.0);
    }
  }
}

// ∫ |x| dA over the normalised surface, |x| measured from `centre`.
double integral_of_radius(const PointsRef& V, const TrianglesRef& F, const Normalised& box,
                          const Vector3d& centre, double max_edge) {
  double sum = 0.0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Vector3d a = box.point(V, F(t, 0)), b = box.point(V, F(t, 1)), c = box.point(V, F(t, 2));
    for_each_quadrature_point(
        a, b, c, divisions(a, b, c, max_edge),
        [&](const Vector3d& p, double weight) { sum += weight * (p - centre).norm(); });
  }
  return sum;
}

}  // namespace

void check_surface(const PointsRef& V, const TrianglesRef& F) {
  if (V.rows() == 0) throw std::invalid_argument("the mesh has no vertices");
  if (F.rows() == 0) throw std::invalid_argument("the mesh has no triangles");
  for (Eigen::Index i = 0; i < V.rows(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (std::isfinite(V(i, axis))) continue;
      throw std::invalid_argument(std::string("coordinate ") + "xyz"[axis] + " of vertex " +
                                  std::to_string(i) + " is " + detail::number(V(i, axis)) +
                                  ", expected a finite number");
    }
  }
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
      if (F(t, corner) >= 0 && F(t, corner) < V.rows()) continue;
      throw std::invalid_argument("triangle " + std::to_string(t) + " names vertex " +
                                  std::to_string(F(t, corner)) + ", expected 0 … " +
                                  std::to_string(V.rows() - 1));
    }
  }
}

double surface_area(const PointsRef& V, const TrianglesRef& F) {
  check_surface(V, F);
  const Normalised box(V, F);
  if (box.size == 0.0) return 0.0;
  double area = 0.0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    area += triangle_area(box.point(V, F(t, 0)), box.point(V, F(t, 1)), box.point(V, F(t, 2)));
  }
  return area * box.size * box.size;
}

Frame surface_frame(const PointsRef& V, const TrianglesRef& F, Centre centre, Scale scale,
                    double factor) {
  check_surface(V, F);
  detail::require(std::isfinite(factor) && factor > 0.0, "factor", factor,
                  "a positive finite number");
  const Normalised box(V, F);
  double area = 0.0;
  Vector3d moment = Vector3d::Zero();
  if (box.size > 0.0) {
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
      const Vector3d a = box.point(V, F(t, 0)), b = box.point(V, F(t, 1)),
                     c = box.point(V, F(t, 2));
      const double part = triangle_area(a, b, c);
      area += part;
      moment += part * (a + b + c) / 3.0;
    }
  }
  // The cross product of two edges of the normalised triangle is known to about 1e-16.
  if (!(area > 1e-14)) {
    throw std::invalid_argument(
        "the mesh has no area: all " + std::to_string(F.rows()) +
        (F.rows() == 1 ? " triangle is degenerate" : " triangles are degenerate"));
  }
  const Vector3d origin = centre == Centre::area ? Vector3d(moment / area) : Vector3d::Zero();

  double largest = 0.0, second_moment = 0.0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Vector3d a = box.point(V, F(t, 0)) - origin, b = box.point(V, F(t, 1)) - origin,
                   c = box.point(V, F(t, 2)) - origin;
    largest = std::max({largest, a.norm(), b.norm(), c.norm()});
    // ∫ |x|² over a triangle: A/12 (|a|² + |b|² + |c|² + |a + b + c|²).
    second_moment +=
        triangle_area(a, b, c) / 12.0 *
        (a.squaredNorm() + b.squaredNorm() + c.squaredNorm() + (a + b + c).squaredNorm());
  }
  double length = largest;
  switch (scale) {
    case Scale::rms:
      length = std::sqrt(second_moment / area);
      break;
    case Scale::mean:
      length = integral_of_radius(V, F, box, origin, largest / 16.0) / area;
      break;
    case Scale::maximum:
      break;
  }
  Frame frame;
  frame.centre = box.middle + box.size * origin;
  frame.radius = factor * box.size * length;
  if (!(std::isfinite(frame.radius) && frame.radius > 0.0 && frame.centre.allFinite())) {
    throw std::invalid_argument("the radius of the ball round the mesh is " +
                                detail::number(frame.radius) +
                                ", expected a positive finite number");
  }
  return frame;
}

SurfacePoints surface_points(const PointsRef& V, const TrianglesRef& F, double max_edge) {
  check_surface(V, F);
  detail::require(std::isfinite(max_edge) && max_edge > 0.0, "max_edge", max_edge,
                  "a positive finite number");
  const auto corner = [&](Eigen::Index t, int c) { return Vector3d(V.row(F(t, c)).transpose()); };
  double count = 0.0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Vector3d a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const double n = std::max(1.0, std::ceil(longest / max_edge));
    count += 3.0 * n * n;
  }
  detail::require(count < 2147483648.0, "max_edge", max_edge,
                  "an edge that gives fewer than 2147483648 points");
  SurfacePoints result;
  result.points.resize(static_cast<Eigen::Index>(count), 3);
  result.weights.resize(static_cast<Eigen::Index>(count));
  Eigen::Index next = 0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Vector3d a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    for_each_quadrature_point(a, b, c, divisions(a, b, c, max_edge),
                              [&](const Vector3d& p, double weight) {
                                result.points.row(next) = p.transpose();
                                result.weights[next++] = weight;
                              });
  }
  return result;
}

}  // namespace shape3d::descriptors
