#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "shape3d/descriptors/export.hpp"
#include "shape3d/descriptors/surface.hpp"

namespace shape3d::descriptors {

/// Settings of d2_histogram().
struct D2Options {
  int bins = 64;           ///< 2 … 4096.
  int pairs = 500000;      ///< Pairs of random points, 1 … 10⁹.
  double range = 3.0;      ///< The last bin ends at `range` times the mean distance; > 0.
  std::uint64_t seed = 1;  ///< Of the points.
};

/// D2 shape distribution (Osada et al. 2002): the histogram of the distance between two random
/// points of the surface, in units of the mean of these distances.
///
/// Points are drawn exactly by area: the triangle by the cumulated areas, the place in it by
/// (1 − √u, √u(1 − v), √u v). Each block of 2¹⁴ pairs has a generator of its own, seeded by (seed,
/// block), so that the result is the same for any number of threads.
/// @return `bins` shares of the pairs, summing to 1; distances beyond the range fall in the last
/// bin.
/// @throws std::invalid_argument  as surface_frame(); an option is out of range.
/// O(V + F + pairs log F).
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd d2_histogram(
    const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
    const D2Options& options = {}, int threads = 0);

/// Extended Gaussian image (Horn 1984) as spherical harmonics of the measure of normals:
/// E_l^m = Σ_t (A_t / A) conj Y_l^m(n_t), the exact transform, without a histogram's cells.
///
/// @param K  Largest degree, 0 … 1000.
/// @return   (K+1)² values: (l, m) at l² + l + m.
/// @throws std::invalid_argument  as surface_frame(); K is out of range.
/// Depends on the orientation of the triangles: turning all of them multiplies E_l by (−1)^l.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXcd extended_gaussian_image(
    const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F, int K,
    int threads = 0);

/// Power of the extended Gaussian image by degree: √Σ_m |E_l^m|², l = 0 … K; invariant under
/// rotation and under reversing all triangles.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd egi_power(
    const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F, int K,
    int threads = 0);

/// The baseline that knows nothing: numbers uniform in [0, 1), drawn from a generator seeded by
/// `seed` and by the bytes of the mesh, so that a mesh keeps its vector.
/// @throws std::invalid_argument  length is not positive; check_surface() fails.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd random_descriptor(
    const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F, int length,
    std::uint64_t seed = 1);

}  // namespace shape3d::descriptors
