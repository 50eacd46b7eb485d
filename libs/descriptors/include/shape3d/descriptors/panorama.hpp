#pragma once

#include <array>

#include <Eigen/Core>

#include "shape3d/descriptors/export.hpp"
#include "shape3d/descriptors/surface.hpp"

namespace shape3d::descriptors {

/// Whose principal axes the cylinders stand on.
enum class PanoramaAxes {
  surface,  ///< Of ∫ x xᵀ dA, x from the centroid: where the surface is.
  normals  ///< Of ∫ n nᵀ dA: where it faces; for boxes and whatever has flat sides these are exact.
};

/// Settings of panorama_images() and panorama_spectrum().
struct PanoramaOptions {
  PanoramaAxes axes = PanoramaAxes::surface;
  int size = 64;  ///< Rows of an image, 8 … 512; it has twice as many columns.
  int K = 12;     ///< Largest frequency along and around the cylinder, 0 … size/2 − 1.
};

/// Panoramic views of a surface (Papadakis, Pratikakis, Theoharis, Perantonis 2010): for each of
/// its three principal axes, those of largest moment first, the surface seen from all round,
/// projected on a cylinder about the axis. Unit: the RMS distance from the centroid.
struct PanoramaImages {
  /// Distance from the axis of the outermost surface in a pixel, 0 where there is none. Rows by the
  /// place on the axis, −2 … 2, columns by the angle about it, −π … π from the next axis (in the
  /// cycle x y z). Surface further out than 3, or beyond the ends, is left out.
  std::array<Eigen::MatrixXd, 3> distance;
  /// |n · e| there: how squarely the surface faces outwards.
  std::array<Eigen::MatrixXd, 3> facing;
};

/// Surfaces are sampled at the middles of parts of triangles with edges of at most one row; a
/// pixel that none of them meets, a few in a hundred, is empty. Where
/// principal moments are equal the axes are arbitrary.
/// @throws std::invalid_argument  as surface_frame(); an option is out of range.
/// O(F + area / pixel²). The same for any number of threads and any order and orientation of the
/// triangles, but for rounding of the moments.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT PanoramaImages
panorama_images(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
                const PanoramaOptions& options = {}, int threads = 0);

/// Numbers of panorama_spectrum(): 6 (K+1)².
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::Index panorama_length(
    const PanoramaOptions& options);

/// Fourier amplitudes of the six images: √((|F(u,v)|² + |F(−u,v)|²) / 2) / pixels, u = 0 … K along
/// the cylinder and v = 0 … K around it; distance and facing of the first axis, then of the second
/// and third, v fastest. Reversing an axis, and turning the image about it, leave them, so that the
/// signs of the axes, which no rule finds reliably, are no matter.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd panorama_spectrum(
    const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
    const PanoramaOptions& options = {}, int threads = 0);

}  // namespace shape3d::descriptors
