#pragma once

#include <Eigen/Core>

#include "shape3d/descriptors/parameters.hpp"
#include "shape3d/descriptors/sh.hpp"
#include "shape3d/descriptors/surface.hpp"

namespace shape3d::descriptors::detail {

/// Numbers of a vector of a spherical image.
Eigen::Index length(const SphericalParameters& parameters);

/// The transform that describe() takes.
/// @throws std::invalid_argument  a parameter is out of range.
ShTransform prepare(const SphericalParameters& parameters);

/// The vector of a spherical image of a mesh with its spherical map S.
Eigen::VectorXd describe(const SphericalParameters& parameters, const ShTransform& transform,
                         const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
                         const Eigen::Ref<const Points>& S, int threads);

}  // namespace shape3d::descriptors::detail
