#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <Eigen/Core>

#include "shape3d/mapping/certificate.hpp"
#include "shape3d/mapping/distortion.hpp"
#include "shape3d/mapping/export.hpp"
#include "shape3d/mapping/mesh.hpp"
#include "shape3d/mapping/status.hpp"

namespace shape3d::mapping {

/// What Ceres minimises. Both are 0 in excess of their bound only for a conformal map.
enum class Energy {
  /// Σ over triangles A (|J|² − 2 det J) / det J = A (σ1/σ2 + σ2/σ1 − 2): the harmonic energy less
  /// the area, over the area. Crowded triangles count as much as others, and none can flip.
  conformal,
  /// ½ Σ over edges k_ij |h_i − h_j|², k_ij = ½ (cot α + cot β): (4.6) of the dissertation, of Gu
  /// and Yau. It hardly sees crowded parts, so that these may flip and the status may be tangled.
  harmonic
};

/// Settings of spherical_map().
struct SphericalMapOptions {
  Energy energy = Energy::conformal;
  bool linear = false;  ///< Only the linear map: no Ceres, about ten times as fast.
  /// After Energy::conformal, minimise the changes of angles as they are: all corners alike, and
  /// nearly their absolute values. The conformal energy, of squares and by area, leaves the mean
  /// change of an angle 1 to 15 % larger.
  bool refine_angles = true;
  /// Turns the mesh into its canonical pose, for example Pose::rotation of align(): the map is
  /// turned so that it lies as the posed mesh does. In SO(3).
  Eigen::Matrix3d pose = Eigen::Matrix3d::Identity();
  /// Weight w ≥ 0 of w Σ A log²(area scale) in a second minimisation, which trades conformality for
  /// coverage: long extrusions get more of the sphere. 0: none. The larger, the more even the areas
  /// and the more distorted the angles: see conformal_distortion and distortion of the result.
  double area_balance = 0;
  int max_iterations = 100;  ///< Of Ceres; at least 1.
  double function_tolerance =
      1e-4;  ///< Ceres stops when the cost changes by less, relatively; > 0.
  /// Called between stages and iterations from the calling thread with the share done, 0 … 1; false
  /// cancels.
  std::function<bool(double)> progress;
};

/// Wall-clock seconds of each stage.
struct StageSeconds {
  double delaunay = 0;  ///< Checking, adjacency, intrinsic Delaunay triangulation.
  double linear = 0;    ///< Choice of the pole, Cholesky factorisation, removal of the dilatation.
  double untangle = 0;  ///< Repair of flipped patches.
  double minimise = 0;  ///< Ceres.
  double centre = 0;    ///< Möbius centring and rotation.
  double certificate = 0;
  double distortion = 0;
  double total = 0;
};

/// What Ceres did.
struct MinimisationSummary {
  bool used = false;  ///< False with linear, and when the linear map could not be untangled.
  double initial_cost = 0, final_cost = 0;  ///< ½ Σ of squared residuals.
  int iterations = 0;                       ///< Successful and unsuccessful steps.
  std::string termination;                  ///< Ceres' name of it: CONVERGENCE, NO_CONVERGENCE, …
  std::string message;                      ///< Ceres' sentence.
};

/// Outcome of spherical_map().
struct SphericalMap {
  Points S;  ///< #V by 3 unit vectors, rows as V; empty unless the status is certified.
  Status status = Status::solver_failed;
  Certificate certificate;       ///< Of S; of the last map tried when there is none.
  Distortion distortion;         ///< Of S.
  Distortion linear_distortion;  ///< Of the linear map that Ceres began with.
  MinimisationSummary minimisation;
  MinimisationSummary refinement;   ///< Of the angles; used only with Energy::conformal.
  Distortion conformal_distortion;  ///< Of the conformal map that balancing began with.
  MinimisationSummary balancing;    ///< Used only with area_balance > 0.
  StageSeconds seconds;
  std::int64_t delaunay_flips = 0;  ///< Edges flipped to make the triangulation Delaunay.
  std::int64_t untangled_triangles =
      0;                ///< Flipped triangles of the linear map that were repaired.
  int poles_tried = 0;  ///< 1 unless the first pole failed.
};

/// Conformal map of a closed genus-zero mesh to the unit sphere, proved to be one to one.
///
/// Intrinsic Delaunay triangulation; the discrete harmonic map with a dipole at a regular triangle
/// in the middle of the surface (one sparse Cholesky factorisation); the constant part of its
/// dilatation removed; conformal barycentre at the origin; flipped patches untangled; then the
/// energy minimised by Ceres over the product of spheres, with three pinned vertices against the
/// Möbius group; the changes of angles themselves minimised from there; barycentre again; rotated
/// as the posed mesh lies; certified.
///
/// Equivariant: moving, turning or scaling V changes S by the rotation alone, and not at all with
/// the pose of align(). A mesh whose triangles run clockwise seen from outside is mapped with its
/// mirror image.
///
/// @param V  #V by 3, finite; any unit. Zero-area triangles are mapped as slightly fattened ones.
/// @param F  #F by 3, at least 4; closed, manifold, consistently oriented, connected, genus 0,
/// every
///           vertex used: see inspect().
/// @return   A certified map, or a status that says why there is none. Never another map.
/// @throws std::invalid_argument  V or F is not as described, or an option is out of range; the
///         message names what, where and how often.
///
/// Deterministic, the same for any number of threads. About 0.7 s (linear) and 9 s for 100k
/// triangles. May be called concurrently.
/// @cite Angenent, Haker, Tannenbaum, Kikinis 1999; Gu, Yau 2004; Baden, Crane, Kazhdan 2018.
/// Errata and deviations: docs/notes/mapping.md.
[[nodiscard]] SHAPE3D_MAPPING_EXPORT SphericalMap spherical_map(
    const ConstPoints& V, const ConstTriangles& F, const SphericalMapOptions& options = {});

}  // namespace shape3d::mapping
