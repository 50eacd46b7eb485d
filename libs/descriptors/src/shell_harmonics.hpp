#pragma once

#include <Eigen/Core>

#include "ball_voxels.hpp"
#include "legendre.hpp"
#include "shape3d/descriptors/voxels.hpp"

namespace shape3d::descriptors::detail {

/// Sums of voxels times spherical harmonics over each shell, #shells by 2 · Legendre::count(K):
///   column Legendre::index(l, m)                       Σ share f P̄_l^m(cos θ) cos mφ
///   column Legendre::count(K) + Legendre::index(l, m)  Σ share f P̄_l^m(cos θ) sin mφ
/// over the voxels of the shell, so that Σ share f conj(Y_l^m) is the first minus i times the
/// second.
using ShellSums = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Folds the mirror images first: each harmonic is even or odd in each coordinate, so that it needs
/// one of eight sums over the octant. Shells are independent: any number of threads, same result.
ShellSums shell_sums(const BallVoxels& ball, const Legendre& legendre, const Voxels& voxels,
                     int threads);

}  // namespace shape3d::descriptors::detail
