#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

using Complex = std::complex<double>;
using PlanePoints = std::vector<Complex>;

/// Stereographic projection between the plane and the sphere; the point at infinity is (0, 0, 1)
/// and z = 0 is (0, 0, −1). Orientation: counter-clockwise in the plane is clockwise seen from
/// outside the sphere, so that a mesh embedded in the plane comes out with its mirror image unless
/// conjugated.
[[nodiscard]] Eigen::Vector3d to_sphere(Complex z);
[[nodiscard]] Complex to_plane(const Eigen::Vector3d& p);

/// z → (z − centre) / scale. With rotations of the sphere these make up the whole Möbius group.
struct Similarity {
  Complex centre = 0;
  double scale = 1;
  bool converged = false;  ///< The barycentre was reached to 1e-12.
};

/// The similarity after which the weighted mean of the points on the sphere is the origin: their
/// conformal barycentre, which is unique (Baden, Crane, Kazhdan 2018, algorithm 1; here in the
/// half-space model, where crowded points keep their digits).
///
/// Minimises Σ w log((|z − centre|² + scale²) / scale), which is convex along geodesics, by
/// Newton's method with step control.
/// @param weights  Non-negative; no point has half of the total.
[[nodiscard]] Similarity conformal_barycentre(const PlanePoints& z, const Eigen::VectorXd& weights);

/// The rotation that brings the rows of S closest to those of P in the weighted mean square (Kabsch
/// 1976): maximises Σ w (R S_i) · P_i over SO(3).
[[nodiscard]] Eigen::Matrix3d closest_rotation(const ConstPoints& S, const ConstPoints& P,
                                               const Eigen::VectorXd& weights);

}  // namespace shape3d::mapping
