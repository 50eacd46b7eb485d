#include "shape3d/mapping/certificate.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "surface.hpp"
#include "triangle.hpp"

namespace shape3d::mapping {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

/// Exact sign of det(p, q, r).
int determinant_sign(const Point& p, const Point& q, const Point& r) {
  return static_cast<int>(CGAL::orientation(Point(0, 0, 0), p, q, r));
}

/// Signed triangles whose cone holds the direction; false when it lies on the border of one.
bool count_over(const Point& direction, const std::vector<Point>& points, const ConstTriangles& F,
                const std::vector<signed char>& signs, std::int64_t& degree) {
  degree = 0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    if (signs[t] == 0) continue;
    bool inside = true, on_border = false;
    for (int k = 0; k < 3 && inside; ++k) {
      const int side =
          determinant_sign(direction, points[F(t, k)], points[F(t, (k + 1) % 3)]) * signs[t];
      inside = side >= 0;
      on_border = on_border || side == 0;
    }
    if (inside && on_border) return false;
    if (inside) degree += signs[t];
  }
  return true;
}

}  // namespace

Certificate certify(const ConstPoints& S, const ConstTriangles& F) {
  require_finite(S, "S");
  require_indices(F, S.rows());
  std::vector<Point> points;
  points.reserve(S.rows());
  for (Eigen::Index i = 0; i < S.rows(); ++i) {
    if (S.row(i).isZero(0)) {
      throw std::invalid_argument("S: row " + std::to_string(i) + " is zero; expected a direction");
    }
    points.emplace_back(S(i, 0), S(i, 1), S(i, 2));
  }

  Certificate result;
  std::vector<signed char> signs(F.rows());
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const int sign = determinant_sign(points[F(t, 0)], points[F(t, 1)], points[F(t, 2)]);
    signs[t] = static_cast<signed char>(sign);
    result.flipped += sign < 0 ? 1 : 0;
    result.degenerate += sign == 0 ? 1 : 0;
    result.total_solid_angle +=
        solid_angle(row(S, F(t, 0)).stableNormalized(), row(S, F(t, 1)).stableNormalized(),
                    row(S, F(t, 2)).stableNormalized());
  }

  // Directions that lie on an edge are few: the first or second one serves. mt19937's numbers are
  // the same everywhere.
  std::mt19937 random(1);
  const auto coordinate = [&random] { return static_cast<double>(random()) * 0x1p-31 - 1; };
  while (true) {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    if (count_over(Point(x, y, z), points, F, signs, result.degree)) return result;
  }
}

}  // namespace shape3d::mapping
