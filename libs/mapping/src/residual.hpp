#pragma once

#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "angle_residual.hpp"
#include "rest_shape.hpp"
#include "shape3d/mapping/spherical_map.hpp"

namespace shape3d::mapping {

inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// √A (J_v − n × J_u) / √χ of the linear map J from a triangle of the surface to the plane triangle
/// of its points on the sphere. n is the unit normal on the outer side, D = n · (J_u × J_v) = ± det
/// J with the sign of det(p, q, r), and χ = (D + √(D² + ε²)) / 2, which is D for ε = 0. Then the
/// square is A (|J|² − 2 det J) / det J. For Energy::harmonic the same without the division: the
/// harmonic energy less the area, twice.
///
/// @param epsilon    0 for a triangle of det(p, q, r) > 0.
/// @param jacobians  Of the residual by each corner; not computed when null.
inline Eigen::Vector3d conformal_residual(const RestShape& shape, Energy energy, double epsilon,
                                          const std::array<Eigen::Vector3d, 3>& corners,
                                          std::array<RowMatrix3, 3>* jacobians) {
  // From differences of corners: Σ du = Σ dv = 0.
  const Eigen::Vector3d e = corners[1] - corners[0], g = corners[2] - corners[0];
  const Eigen::Vector3d Ju = shape.du[1] * e + shape.du[2] * g;
  const Eigen::Vector3d Jv = shape.dv[1] * e + shape.dv[2] * g;
  const Eigen::Vector3d N = Ju.cross(Jv);
  const double D = std::copysign(N.norm(), corners[0].dot(e.cross(g)));
  const Eigen::Vector3d n = N / D;
  const Eigen::Vector3d q = Jv - n.cross(Ju);
  const bool invariant = energy == Energy::conformal;
  const double root = epsilon > 0 ? std::hypot(D, epsilon) : std::abs(D);
  // ε² / (√ − D) for negative D, without cancellation.
  const double chi = D > 0 ? 0.5 * (D + root) : 0.5 * epsilon * epsilon / (root - D);
  const double scale = std::sqrt(invariant ? shape.area / chi : shape.area);
  const Eigen::Vector3d residual = scale * q;
  if (jacobians != nullptr) {
    // dN = dJu × Jv + Ju × dJv, dn = (1 − n nᵀ) dN / D, dD = n · dN, d(n × Ju) = −Ju × dn + n ×
    // dJu.
    const Eigen::Matrix3d P = (Eigen::Matrix3d::Identity() - n * n.transpose()) / D;
    const Eigen::Matrix3d K = -cross_matrix(Ju) * P;
    Eigen::Matrix3d by_u = scale * (K * cross_matrix(Jv) - cross_matrix(n));
    Eigen::Matrix3d by_v = scale * (Eigen::Matrix3d::Identity() - K * cross_matrix(Ju));
    if (invariant) {
      // dχ = ½ (1 + D / √) dD = (χ / √) dD
      const Eigen::Vector3d half = (-0.5 / root) * residual;
      by_u += half * Jv.cross(n).transpose();
      by_v += half * n.cross(Ju).transpose();
    }
    for (int k = 0; k < 3; ++k) (*jacobians)[k] = by_u * shape.du[k] + by_v * shape.dv[k];
  }
  return residual;
}

/// √(w A) log(det J / 4π): zero where a triangle of a surface of total area 1 gets its fair part of
/// the sphere. det J as above.
/// @param jacobians  Of the residual by each corner; not computed when null.
inline double area_residual(const RestShape& shape, double weight,
                            const std::array<Eigen::Vector3d, 3>& corners,
                            std::array<Eigen::RowVector3d, 3>* jacobians) {
  const Eigen::Vector3d e = corners[1] - corners[0], g = corners[2] - corners[0];
  const Eigen::Vector3d N = e.cross(g);  // its length is 2 A det J
  const double twice_area = N.norm();
  const double scale = std::sqrt(weight * shape.area);
  if (jacobians != nullptr) {
    const Eigen::RowVector3d n = N.transpose() * (scale / (twice_area * twice_area));
    (*jacobians)[1] = -n.cross(g.transpose());
    (*jacobians)[2] = -e.transpose().cross(n);
    (*jacobians)[0] = -(*jacobians)[1] - (*jacobians)[2];
  }
  constexpr double kFourPi = 12.566370614359172954;
  return scale * std::log(twice_area / (2 * shape.area * kFourPi));
}

}  // namespace shape3d::mapping
