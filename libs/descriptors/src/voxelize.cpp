#include "shape3d/descriptors/voxelize.hpp"

#include <cmath>
#include <stdexcept>

#include "parallel.hpp"
#include "text.hpp"
#include "voxel_check.hpp"
#include "voxel_fills.hpp"

namespace shape3d::descriptors {
namespace detail {

std::vector<GridTriangle> grid_triangles(const Eigen::Ref<const Points>& V,
                                         const Eigen::Ref<const Triangles>& F, const Frame& frame,
                                         int side, double margin) {
  Points U(V.rows(), 3);
  const double half = 0.5 * side;
  for (Eigen::Index i = 0; i < V.rows(); ++i) {
    U.row(i) = ((V.row(i) - frame.centre.transpose()) / frame.radius * half).array() + half;
  }
  std::vector<GridTriangle> triangles;
  triangles.reserve(static_cast<std::size_t>(F.rows()));
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const GridTriangle triangle{U.row(F(t, 0)), U.row(F(t, 1)), U.row(F(t, 2))};
    if ((triangle.high().array() < -margin).any() ||
        (triangle.low().array() > side + margin).any()) {
      continue;
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

}  // namespace detail

Voxels voxelize(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
                const Frame& frame, const VoxelizeOptions& options) {
  check_surface(V, F);
  detail::check_side(options.side);
  detail::require(options.sigma >= 0.25 && options.sigma <= options.side, "sigma", options.sigma,
                  "0.25 … " + std::to_string(options.side));
  const int threads = detail::resolve_threads(options.threads);
  if (!(frame.centre.allFinite() && std::isfinite(frame.radius) && frame.radius > 0.0)) {
    throw std::invalid_argument("the frame has radius " + detail::number(frame.radius) +
                                ", expected a positive finite one and a finite centre");
  }
  Voxels voxels;
  voxels.side = options.side;
  voxels.frame = frame;
  const double reach = kGaussianReach * options.sigma;
  const bool to_surface = options.fill == Fill::distance;
  const std::vector<detail::GridTriangle> triangles =
      detail::grid_triangles(V, F, frame, options.side, to_surface ? reach : 0.0);
  switch (options.fill) {
    case Fill::binary: {
      const auto set = detail::meets_surface(triangles, options.side, threads);
      voxels.values.assign(set.begin(), set.end());
      break;
    }
    case Fill::area:
      voxels.values = detail::area_splat(triangles, options.side, threads);
      break;
    case Fill::gedt:
      voxels.values =
          detail::gaussian_of_voxels(detail::meets_surface(triangles, options.side, threads),
                                     options.side, options.sigma, reach, threads);
      break;
    case Fill::distance:
      voxels.values =
          detail::gaussian_of_surface(triangles, options.side, options.sigma, reach, threads);
      break;
  }
  return voxels;
}

Voxels voxelize(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
                const VoxelizeOptions& options) {
  detail::check_side(options.side);
  return voxelize(V, F, surface_frame(V, F, options.centre, options.scale, options.factor),
                  options);
}

}  // namespace shape3d::descriptors
