#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "shape3d/descriptors/surface.hpp"

namespace shape3d::descriptors::test {

struct Soup {
  Points V;
  Triangles F;
};

/// Axis-parallel box of the given corners, 12 triangles, outward.
Soup box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// Unit sphere: an octahedron whose triangles are divided into n² each and pushed out; 8n²
/// triangles, outward.
Soup sphere(int n);

/// A closed bumpy body without any symmetry: the sphere of 8n² triangles, at radius
/// 1 + Σ of fixed low harmonics.
Soup bumpy(int n);

/// Both as one soup.
Soup joined(const Soup& a, const Soup& b);

/// Every vertex p becomes linear · p + offset.
Soup transformed(const Soup& soup, const Eigen::Matrix3d& linear,
                 const Eigen::Vector3d& offset = Eigen::Vector3d::Zero());

/// The count-th of a sequence of rotations uniform on SO(3).
Eigen::Matrix3d random_rotation(std::uint64_t count);

}  // namespace shape3d::descriptors::test
