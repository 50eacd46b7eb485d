#pragma once

#include <cstdint>
#include <variant>

#include "shape3d/descriptors/csm.hpp"
#include "shape3d/descriptors/hsh.hpp"
#include "shape3d/descriptors/panorama.hpp"
#include "shape3d/descriptors/sh.hpp"
#include "shape3d/descriptors/shape_distribution.hpp"
#include "shape3d/descriptors/spherical_image.hpp"
#include "shape3d/descriptors/voxelize.hpp"

namespace shape3d::descriptors {

/// Pose alignment before the descriptor is computed. A record: whoever composes the two libraries
/// aligns the mesh and then calls Descriptor::compute().
enum class Align {
  none,
  cpca  ///< Continuous principal component analysis.
};

/// Which numbers of the HSH coefficients are the vector.
enum class HshInvariants {
  energies,  ///< hsh_energies()
  gram,      ///< gram_invariants()
  roots      ///< gram_roots()
};

/// What the HSH coefficients are of.
enum class HshSource {
  voxels,  ///< The voxels.
  surface  ///< The surface as a measure (hsh_of_points()), its points not further apart than half
           ///< of a voxel edge; fill, sigma, quadrature and grid are not used.
};

/// `hsh`: hyperspherical harmonics (section 5.2).
struct HshParameters {
  HshOptions transform;
  VoxelizeOptions voxels;
  HshSource source = HshSource::voxels;
  HshInvariants invariants = HshInvariants::energies;
  bool unit = false;   ///< Divide the vector by its L2 norm.
  double power = 1.0;  ///< Then each number x becomes sign(x) |x|^power; 0.1 … 1.
};

/// `csm`: concentric spheres model (section 5.1.2).
struct CsmParameters {
  CsmOptions spheres;
  VoxelizeOptions voxels;
  bool unit = false;   ///< As of HshParameters.
  double power = 1.0;  ///< As of HshParameters.
};

/// `d2`: shape distribution of distances.
struct D2Parameters {
  D2Options options;
};

/// `egi`: power spectrum of the extended Gaussian image.
struct EgiParameters {
  int K = 16;
};

/// `random`: baseline.
struct RandomParameters {
  int length = 45;
  std::uint64_t seed = 1;
};

/// `panorama`: Fourier amplitudes of panoramic views.
struct PanoramaParameters {
  PanoramaOptions options;
  double power = 0.5;  ///< Each number x becomes x^power; 0.1 … 1.
  bool unit = true;    ///< Then the vector is divided by its L2 norm.
};

/// Which spherical image.
enum class SphericalImageKind { sni, sci, sgi };

/// Which numbers of the coefficients of a spherical image are the vector.
enum class SphericalForm {
  amplitudes,  ///< sh_amplitudes(), component after component: the dissertation's, of one pose.
  norms,       ///< sh_norms(): K + 1 numbers, invariant under rotation.
  roots        ///< sh_component_roots(): 3(K + 1) numbers, invariant under rotation; not of sci.
};

/// `sni`, `sci`, `sgi`: spherical harmonics of a spherical image (section 4.4).
struct SphericalParameters {
  SphericalImageKind image = SphericalImageKind::sni;
  int K = 16;     ///< Largest degree, 0 … sh_largest_degree(size).
  int size = 64;  ///< Rows of the image; it has twice as many columns.
  SphericalForm form = SphericalForm::norms;
  /// Of the amplitudes of sni and sgi, 1 … 3: the first so many of x, y, z. The dissertation has 2,
  /// (K+2)(K+1) numbers, since N_z follows from N_x and N_y but for its sign.
  int components = 2;
  ImageSampling sampling = ImageSampling::area;
  ShRoute route = ShRoute::fft;
};

using Parameters = std::variant<HshParameters, CsmParameters, D2Parameters, EgiParameters,
                                RandomParameters, PanoramaParameters, SphericalParameters>;

}  // namespace shape3d::descriptors
