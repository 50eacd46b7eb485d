#pragma once

#include <vector>

#include <Eigen/Core>

#include "shape3d/descriptors/export.hpp"
#include "shape3d/descriptors/sh.hpp"
#include "shape3d/descriptors/surface.hpp"

// Images on the sphere of a genus-zero surface and its spherical map S (section 4.3): S has the
// rows of V, unit vectors, and its triangles, those of F, cover the sphere once.
namespace shape3d::descriptors {

/// What a pixel of an image is.
enum class ImageSampling {
  point,  ///< The value at the pixel's direction: the triangle that holds it, and there (4.8).
  area  ///< The mean over the pixel's cell, θ_j ± π/2n, φ_k ± π/2n, in the measure of the sphere:
        ///< antialiased where a cell covers many triangles.
};

/// Functions on the sphere at the pixels of image_direction().
struct SphericalImage {
  int size = 0;             ///< Rows n; there are 2n columns.
  Eigen::MatrixXd samples;  ///< 2n² by components.
};

/// Settings of the images.
struct SphericalImageOptions {
  int size = 64;  ///< Rows, even, kMinImageSize … kMaxImageSize.
  ImageSampling sampling = ImageSampling::area;
  int threads = 0;  ///< 0: all processors. The result is the same, byte for byte, for any number.
};

/// Refuses what is not a spherical map of the mesh.
///
/// @return +1; −1 when the triangles of both, mesh and map, are turned inwards, which the functions
/// below take as well.
/// @throws std::invalid_argument  as check_surface(); S has another number of rows, an entry that
/// is not finite, a row whose length differs from 1 by more than 1e-6; triangles of S are flipped
/// (their number and the first are named), S is the mirror image, or covers the sphere not exactly
/// once.
/// O(V + F).
SHAPE3D_DESCRIPTORS_EXPORT int check_spherical_map(const Eigen::Ref<const Points>& V,
                                                   const Eigen::Ref<const Triangles>& F,
                                                   const Eigen::Ref<const Points>& S);

/// Image of an attribute that is linear in the triangles of the mesh.
///
/// With P in the spherical triangle ABC of S, its place (u, v, w) is that of the gnomonic
/// projection (4.8) and its value u a + v b + w c.
/// - point: each pixel lies in one triangle, decided by the signs of det(P, A, B), computed once
///   per edge and the same for both triangles at it; a pixel that rounding leaves out, at a vertex
///   or in a sliver, goes to the nearest triangle.
/// - area: triangles larger than half a cell are divided; each piece counts in each cell by the
///   area of both together, exactly, with the value at its middle. What a cell's border cuts off
///   makes an error of up to 8 % of the change across a cell, which vanishes where triangles are
///   small.
///
/// @param values  #V by components; finite.
/// @throws std::invalid_argument  as check_spherical_map(); values has another number of rows or a
/// number that is not finite; an option is out of range, size is odd.
/// O(F + size²). Deterministic.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT SphericalImage
vertex_image(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
             const Eigen::Ref<const Points>& S, const Eigen::Ref<const Eigen::MatrixXd>& values,
             const SphericalImageOptions& options = {});

/// Image of an attribute that is constant on each triangle. @param values  #F by components.
/// Otherwise as vertex_image(); area is exact.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT SphericalImage
triangle_image(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
               const Eigen::Ref<const Points>& S, const Eigen::Ref<const Eigen::MatrixXd>& values,
               const SphericalImageOptions& options = {});

/// Spherical normal image: the outward unit normal of the triangle, N_x N_y N_z. Triangles of zero
/// area have the normal 0.
/// @throws std::invalid_argument  as vertex_image().
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT SphericalImage spherical_normal_image(
    const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
    const Eigen::Ref<const Points>& S, const SphericalImageOptions& options = {});

/// Spherical geometry image: the positions, from the centroid of the surface and in units of its
/// RMS radius, X Y Z, linear in the triangles.
/// @throws std::invalid_argument  as vertex_image(); surface_frame() refuses the mesh.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT SphericalImage spherical_geometry_image(
    const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
    const Eigen::Ref<const Points>& S, const SphericalImageOptions& options = {});

/// Spherical curvature image: (2/π) atan(r H) with the mean curvature H of vertex_mean_curvature()
/// and r = √(area/4π), linear in the triangles. Between −1 and 1, ½ for a ball of any size; without
/// the arc tangent the image is that of the few vertices at slivers, where H is without bound.
/// @throws std::invalid_argument  as vertex_image(); every triangle has zero area.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT SphericalImage spherical_curvature_image(
    const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
    const Eigen::Ref<const Points>& S, const SphericalImageOptions& options = {});

/// Mean curvature at each vertex, positive where the surface is convex: H = ½ n · Σ_j (cot α_j +
/// cot β_j)(p − p_j) / (2A), n the vertex's area-weighted normal and A a third of the area of its
/// triangles (Meyer et al. 2003, eq. 8, with barycentric cells). 1/radius for a sphere.
/// 0 at vertices without a triangle of positive area.
/// @throws std::invalid_argument  as check_surface(). O(V + F).
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::VectorXd vertex_mean_curvature(
    const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F);

/// Equirectangular picture, `height` rows of 2·height pixels, red green blue: north at the top, φ
/// from −π at the left to π at the right. Three components become colours by (x − low)/(high −
/// low); one becomes a colour between blue (low), white and red (high). Values beyond are cut.
/// @param height  1 … 4096. @throws std::invalid_argument  the components are neither 1 nor 3, the
/// image is empty, height is out of range, low is not below high.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT std::vector<unsigned char> equirectangular_picture(
    const SphericalImage& image, int height, double low = -1.0, double high = 1.0);

}  // namespace shape3d::descriptors
