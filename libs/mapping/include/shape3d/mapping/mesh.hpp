#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace shape3d::mapping {

/// #V by 3, one vertex a row.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// #F by 3 rows of V, counter-clockwise seen from outside.
using Triangles = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// How functions take them: row-major matrices and maps are borrowed, others are copied.
using ConstPoints = Eigen::Ref<const Points>;
using ConstTriangles = Eigen::Ref<const Triangles>;

}  // namespace shape3d::mapping
