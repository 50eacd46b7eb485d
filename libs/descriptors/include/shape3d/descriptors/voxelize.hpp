#pragma once

#include "shape3d/descriptors/export.hpp"
#include "shape3d/descriptors/surface.hpp"
#include "shape3d/descriptors/voxels.hpp"

namespace shape3d::descriptors {

/// What a voxel holds.
enum class Fill {
  binary,  ///< 1 where the closed cube of the voxel meets a triangle, else 0. Exact (separating
           ///< axes), not the dissertation's test of cube corners on both sides (section 5.2.1).
  area,    ///< Antialiased: ∫_S t(x − voxel centre) dA in squared voxel edges, t the tent
         ///< Π max(0, 1 − |x_i|) of one voxel edge: the surface's area, distributed trilinearly.
         ///< Exact on each piece between planes of voxel centres; the sum over all voxels is the
         ///< area inside [½, side − ½]³.
  gedt,  ///< exp(−d² / 2σ²), d the exact Euclidean distance between the centre of the voxel and
         ///< the nearest centre of a voxel that `binary` sets (Kazhdan's GEDT).
  distance  ///< exp(−d² / 2σ²), d the distance from the centre of the voxel to the surface itself.
};

/// Where Gaussian fills end, in units of σ: exp(−8) = 3.4e-4.
inline constexpr double kGaussianReach = 4.0;

/// Settings of voxelize().
struct VoxelizeOptions {
  int side = 64;  ///< Voxels along an axis, kMinSide … kMaxSide.
  Fill fill = Fill::distance;
  Centre centre = Centre::area;
  Scale scale = Scale::rms;
  double factor = 2.0;                ///< Radius of the ball in units of `scale`, > 0 and finite.
  double sigma = 2.8284271247461903;  ///< σ of gedt and distance in voxel edges (√8), ¼ … side. The
                                      ///< result is 0 beyond kGaussianReach σ.
  int threads = 0;  ///< 0: all processors. The result is the same, byte for byte, for any number.
};

/// Voxels of a triangle soup in the frame surface_frame(V, F, centre, scale, factor).
///
/// Parts outside the grid are cut off. Triangles much larger and much smaller than a voxel cost
/// time by the voxels they meet, and by their number.
/// @throws std::invalid_argument  as surface_frame(); an option is out of range. The message names
/// the option and its value.
/// Working memory: 4 to 12 bytes a voxel, and for `distance` 200 bytes a triangle.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Voxels voxelize(const Eigen::Ref<const Points>& V,
                                                         const Eigen::Ref<const Triangles>& F,
                                                         const VoxelizeOptions& options = {});

/// The same in a given frame; centre, scale and factor of the options are not used.
/// @throws std::invalid_argument  as voxelize(); the frame is not finite or its radius not
/// positive.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Voxels voxelize(const Eigen::Ref<const Points>& V,
                                                         const Eigen::Ref<const Triangles>& F,
                                                         const Frame& frame,
                                                         const VoxelizeOptions& options);

}  // namespace shape3d::descriptors
