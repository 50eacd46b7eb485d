#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "sh_checks.hpp"
#include "shape3d/descriptors/spherical_image.hpp"
#include "text.hpp"

namespace shape3d::descriptors {
namespace {

// Six times the signed volume from the middle of the bounding box, in units of the box's size
// cubed.
double signed_volume(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F) {
  const Eigen::RowVector3d low = V.colwise().minCoeff(), high = V.colwise().maxCoeff();
  const Eigen::RowVector3d middle = low + 0.5 * (high - low);
  const double size = (high - low).maxCoeff();
  if (size == 0.0) return 0.0;
  double volume = 0.0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::Vector3d a = (V.row(F(t, 0)) - middle) / size;
    const Eigen::Vector3d b = (V.row(F(t, 1)) - middle) / size;
    const Eigen::Vector3d c = (V.row(F(t, 2)) - middle) / size;
    volume += a.dot(b.cross(c));
  }
  return volume;
}

void check_rows(const Eigen::Ref<const Points>& S, Eigen::Index rows) {
  if (S.rows() != rows) {
    throw std::invalid_argument("S has " + std::to_string(S.rows()) +
                                " rows, expected those of V, " + std::to_string(rows));
  }
  for (Eigen::Index i = 0; i < S.rows(); ++i) {
    const double length = S.row(i).norm();
    if (!(std::abs(length - 1.0) <= 1e-6)) {
      throw std::invalid_argument("S: row " + std::to_string(i) + " has the length " +
                                  detail::number(length) + ", expected unit vectors");
    }
  }
}

}  // namespace

int check_spherical_map(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
                        const Eigen::Ref<const Points>& S) {
  check_surface(V, F);
  check_rows(S, V.rows());

  double cover = 0.0;  // solid angle of all triangles
  Eigen::Index outward = 0, inward = 0, first_outward = -1, first_inward = -1;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::Vector3d A = S.row(F(t, 0)).normalized(), B = S.row(F(t, 1)).normalized(),
                          C = S.row(F(t, 2)).normalized();
    const double det = A.dot((B - A).cross(C - A));
    // Ω of a spherical triangle: tan(Ω/2) = det / (1 + A·B + B·C + C·A).
    cover += 2.0 * std::atan2(det, 1.0 + A.dot(B) + B.dot(C) + C.dot(A));
    // Coordinates are known to ε/2, which moves a corner against a side of length L by a few ε L.
    const double side = std::max({(B - A).norm(), (C - B).norm(), (A - C).norm()});
    const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * side;
    if (det > rounding && ++outward == 1) first_outward = t;
    if (det < -rounding && ++inward == 1) first_inward = t;
  }

  const int orientation = cover >= 0.0 ? 1 : -1;
  const Eigen::Index flipped = orientation > 0 ? inward : outward;
  if (flipped > 0) {
    throw std::invalid_argument("S: " + std::to_string(flipped) + " of " +
                                std::to_string(F.rows()) +
                                " triangles are flipped, first triangle " +
                                std::to_string(orientation > 0 ? first_inward : first_outward) +
                                ", expected a spherical map without folds");
  }
  const double times = std::abs(cover) / (4.0 * detail::kPi);
  if (std::abs(times - 1.0) > 1e-6) {
    throw std::invalid_argument("S covers the sphere " +
                                detail::number(std::round(1e6 * times) / 1e6) +
                                " times, expected once");
  }
  if (orientation < 0 && signed_volume(V, F) >= 0.0) {
    throw std::invalid_argument(
        "S is the mirror image of a spherical map: its triangles turn inwards and those of the "
        "mesh do not");
  }
  return orientation;
}

}  // namespace shape3d::descriptors
