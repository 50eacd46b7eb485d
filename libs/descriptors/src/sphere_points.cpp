#include "sphere_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "sh_checks.hpp"
#include "shape3d/descriptors/sh.hpp"
#include "sphere_cells.hpp"

namespace shape3d::descriptors {
namespace {

using detail::kPi;

// An edge of a triangle as seen from it. Its plane is computed from the vertex of the lower number,
// so that the two triangles at an edge have the same plane to the last bit; of a point in the plane
// they both ask the direction of the edge, and one says yes.
struct Side {
  Eigen::Vector3d normal;
  double sign;

  [[nodiscard]] bool holds(const Eigen::Vector3d& P) const {
    const double side = normal.dot(P);
    return side == 0.0 ? sign > 0.0 : sign * side > 0.0;
  }
  [[nodiscard]] double height(const Eigen::Vector3d& P) const { return sign * normal.dot(P); }
};

struct SphereTriangle {
  std::array<Eigen::Vector3d, 3> corners;
  std::array<Side, 3> sides;  // opposite to the corner of that number

  SphereTriangle(const Eigen::Ref<const Points>& S, const Eigen::Ref<const Triangles>& F,
                 Eigen::Index t) {
    for (int i = 0; i < 3; ++i) {
      corners[static_cast<std::size_t>(i)] = S.row(F(t, i));
      std::int32_t a = F(t, (i + 1) % 3), b = F(t, (i + 2) % 3);
      Side& side = sides[static_cast<std::size_t>(i)];
      side.sign = a < b ? 1.0 : -1.0;
      if (b < a) std::swap(a, b);
      const Eigen::Vector3d A = S.row(a), B = S.row(b);
      side.normal = A.cross(B - A);
    }
  }
  [[nodiscard]] bool holds(const Eigen::Vector3d& P) const {
    return sides[0].holds(P) && sides[1].holds(P) && sides[2].holds(P);
  }
  [[nodiscard]] SpherePlace place(const Eigen::Vector3d& P, Eigen::Index t) const {
    Eigen::Vector3d part(sides[0].height(P), sides[1].height(P), sides[2].height(P));
    part = part.cwiseMax(0.0);
    const double sum = part.sum();
    part = sum > 0.0 ? Eigen::Vector3d(part / sum) : Eigen::Vector3d::Constant(1.0 / 3.0);
    return {static_cast<std::int32_t>(t), part[0], part[1], part[2]};
  }
  // Distance from P, a point outside, to the nearest point of the sides.
  [[nodiscard]] double distance(const Eigen::Vector3d& P) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d &A = corners[(i + 1) % 3], &B = corners[(i + 2) % 3];
      const Eigen::Vector3d N = A.cross(B - A);
      const bool between = N.dot(A.cross(P)) > 0.0 && N.dot(P.cross(B)) > 0.0;
      least = std::min(least, between ? std::abs(N.dot(P)) / N.norm() : (P - A).norm());
    }
    return least;
  }
};

// Rows and columns that may hold pixels of a triangle, a rounding wider than it.
struct PixelBox {
  int top, bottom;     // rows
  int first, columns;  // column numbers modulo 2n
};

PixelBox box_of(const SphereTriangle& triangle, int size) {
  double low = kPi, high = 0.0;  // θ
  double phi = std::atan2(triangle.corners[0].y(), triangle.corners[0].x());
  double west = phi, east = phi, whole = 0.0;  // φ
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d A = triangle.corners[i], B = triangle.corners[(i + 1) % 3];
    const double theta = std::atan2(std::hypot(A.x(), A.y()), A.z());
    low = std::min(low, theta);
    high = std::max(high, theta);
    // The northernmost and southernmost point of the edge's circle, if on the edge.
    const Eigen::Vector3d N = A.cross(B - A);
    const Eigen::Vector3d apex(-N.z() * N.x(), -N.z() * N.y(), N.x() * N.x() + N.y() * N.y());
    if (N.dot(A.cross(apex)) >= 0.0 && N.dot(apex.cross(B)) >= 0.0) {
      low = std::min(low, std::atan2(std::hypot(apex.x(), apex.y()), apex.z()));
    }
    if (N.dot(A.cross(apex)) <= 0.0 && N.dot(apex.cross(B)) <= 0.0) {
      high = std::max(high, std::atan2(std::hypot(apex.x(), apex.y()), -apex.z()));
    }
    const double sweep = sweep_of(off_axis(A), off_axis(B));
    whole += sweep;
    phi += sweep;
    west = std::min(west, phi);
    east = std::max(east, phi);
  }
  const double margin = 1e-9;
  const double step = kPi / size;
  PixelBox box{};
  if (whole > kPi) low = 0.0;
  if (whole < -kPi) high = kPi;
  box.top = std::max(0, static_cast<int>(std::ceil((low - margin) / step - 0.5)));
  box.bottom = std::min(size - 1, static_cast<int>(std::floor((high + margin) / step - 0.5)));
  box.first = static_cast<int>(std::ceil((west - margin) / step));
  box.columns = static_cast<int>(std::floor((east + margin) / step)) - box.first + 1;
  if (std::abs(whole) > kPi || box.columns > 2 * size) {
    box.first = 0;
    box.columns = 2 * size;
  }
  return box;
}

}  // namespace

std::vector<SpherePlace> locate_pixels(const Eigen::Ref<const Points>& S,
                                       const Eigen::Ref<const Triangles>& F, int size) {
  std::vector<Eigen::Vector3d> directions;
  for (int j = 0; j < size; ++j) {
    for (int k = 0; k < 2 * size; ++k) directions.push_back(image_direction(size, j, k));
  }
  std::vector<SpherePlace> places(directions.size());
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const SphereTriangle triangle(S, F, t);
    const PixelBox box = box_of(triangle, size);
    for (int row = box.top; row <= box.bottom; ++row) {
      for (int i = 0; i < box.columns; ++i) {
        const int column = (((box.first + i) % (2 * size)) + 2 * size) % (2 * size);
        const std::size_t pixel =
            static_cast<std::size_t>(row) * 2 * static_cast<std::size_t>(size) +
            static_cast<std::size_t>(column);
        if (places[pixel].triangle < 0 && triangle.holds(directions[pixel])) {
          places[pixel] = triangle.place(directions[pixel], t);
        }
      }
    }
  }
  // What rounding left out, at vertices and slivers.
  for (std::size_t pixel = 0; pixel < places.size(); ++pixel) {
    if (places[pixel].triangle >= 0) continue;
    double least = std::numeric_limits<double>::infinity();
    Eigen::Index nearest = 0;
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
      const double distance = SphereTriangle(S, F, t).distance(directions[pixel]);
      if (distance < least) {
        least = distance;
        nearest = t;
      }
    }
    places[pixel] = SphereTriangle(S, F, nearest).place(directions[pixel], nearest);
  }
  return places;
}

}  // namespace shape3d::descriptors
