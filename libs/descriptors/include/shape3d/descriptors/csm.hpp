#pragma once

#include <memory>

#include <Eigen/Core>

#include "shape3d/descriptors/export.hpp"
#include "shape3d/descriptors/voxels.hpp"

namespace shape3d::descriptors {

/// What the concentric spheres model makes of one sphere (section 5.1.2).
enum class CsmVariant {
  shells,  ///< The dissertation's (5.1): R shells of equal thickness, and for each the K + 1 norms
           ///< ‖f_l‖ of the function averaged over the shell's thickness. Length R (K + 1).
  kazhdan  ///< Kazhdan et al. 2003: R spheres of radius (i + ½)/R, f by trilinear interpolation,
           ///< scaled by the radius (the root of the sphere's area); the norms of l = 0 and l = 2
           ///< of each sphere give way to the three numbers of its quadratic form in principal
           ///< axes. Length R (K + 2); R (K + 1) for K < 2.
};

/// Settings of the concentric spheres model.
struct CsmOptions {
  CsmVariant variant = CsmVariant::shells;
  bool weighted = false;  ///< shells: each times its middle radius, the root of its area, as
                          ///< kazhdan always is.
  int R = 5;              ///< Spheres, 1 … side/2.
  int K = 8;              ///< Largest degree of the spherical harmonics, 0 … side/2 − 1.
};

/// Numbers of the descriptor.
[[nodiscard]] SHAPE3D_DESCRIPTORS_EXPORT Eigen::Index csm_length(const CsmOptions& options);

/// The concentric spheres model of voxels, prepared once for its options and a side.
class SHAPE3D_DESCRIPTORS_EXPORT ConcentricSpheres {
 public:
  /// @throws std::invalid_argument  an option or the side is out of range; the message holds the
  /// largest value allowed.
  ConcentricSpheres(const CsmOptions& options, int side);
  ~ConcentricSpheres();
  ConcentricSpheres(ConcentricSpheres&&) noexcept;
  ConcentricSpheres& operator=(ConcentricSpheres&&) noexcept;

  /// csm_length() numbers, sphere by sphere from the centre out, each by degree l (kazhdan: the
  /// three of the quadratic form, descending, then l = 1, 3, 4 …).
  /// Parts of the shape on different spheres may turn freely without any change: the ambiguity of
  /// Fig. 5.4.
  /// @throws std::invalid_argument  the voxels' side is another; threads is negative.
  /// O(side³ K²). Deterministic for any number of threads; may be called concurrently.
  [[nodiscard]] Eigen::VectorXd operator()(const Voxels& voxels, int threads = 0) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace shape3d::descriptors
