#include "shape3d/levelset/front.hpp"

#include <algorithm>
#include <cmath>

#include "message.hpp"
#include "padded_field.hpp"
#include "parallel.hpp"
#include "samples.hpp"

namespace shape3d::levelset {
namespace {

using detail::text;

void check_size(const char* name, Eigen::Index size, const Grid& grid) {
  if (size != grid.size()) {
    detail::refuse(std::string(name) + ": size", text(static_cast<std::int64_t>(size)),
                   text(grid.size()) + ", one value a node");
  }
}

/// Calls value(i, j, k) for every node.
template <class Value>
Field fill(const Grid& grid, const Value& value) {
  Field field(grid.size());
  for (std::int64_t k = 0; k < grid.dims[2]; ++k)
    for (std::int64_t j = 0; j < grid.dims[1]; ++j)
      for (std::int64_t i = 0; i < grid.dims[0]; ++i)
        field[grid.index(i, j, k)] = static_cast<float>(value(i, j, k));
  return field;
}

}  // namespace

Field box_front(const Grid& grid, const Box& box) {
  validate(grid);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (box.lower[axis] < 0 || box.lower[axis] >= box.upper[axis] ||
        box.upper[axis] > grid.dims[axis]) {
      detail::refuse("box: range of axis " + std::string(1, "xyz"[axis]),
                     "[" + text(box.lower[axis]) + ", " + text(box.upper[axis]) + ")",
                     "a non-empty range within [0, " + text(grid.dims[axis]) + ")");
    }
  }
  // Signed distances to the slabs between opposite faces, positive outside.
  std::array<Eigen::ArrayXd, 3> slab;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    slab[axis].resize(grid.dims[axis]);
    for (std::int64_t n = 0; n < grid.dims[axis]; ++n) {
      const double below = static_cast<double>(box.lower[axis] - n) - 0.5;
      const double above = static_cast<double>(n - box.upper[axis]) + 0.5;
      slab[axis][n] = std::max(below, above) * grid.spacing[static_cast<Eigen::Index>(axis)];
    }
  }
  return fill(grid, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    const double x = slab[0][i], y = slab[1][j], z = slab[2][k];
    const double inside = std::min(std::max({x, y, z}), 0.0);
    return inside + std::hypot(std::max(x, 0.0), std::max(y, 0.0), std::max(z, 0.0));
  });
}

Field sphere_front(const Grid& grid, const Eigen::Vector3d& center, double radius) {
  validate(grid);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto last = static_cast<double>(grid.dims[static_cast<std::size_t>(axis)] - 1);
    if (!(center[axis] >= 0.0 && center[axis] <= last)) {
      detail::refuse("seed point: " + std::string(1, "xyz"[axis]), text(center[axis]),
                     "a lattice coordinate within [0, " + text(last) + "]");
    }
  }
  detail::require(std::isfinite(radius) && radius > 0.0, "radius", radius,
                  "a finite positive number of mm");
  return fill(grid, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    const Eigen::Vector3d node(static_cast<double>(i), static_cast<double>(j),
                               static_cast<double>(k));
    return (node - center).cwiseProduct(grid.spacing).norm() - radius;
  });
}

Field redistance(const Grid& grid, const Field& psi, double limit, int requested_threads) {
  validate(grid);
  check_size("psi", psi.size(), grid);
  detail::require_finite(psi, "psi");
  detail::require(std::isfinite(limit) && limit > 0.0, "limit", limit,
                  "a finite positive number of mm");
  const int threads = detail::resolve_threads(requested_threads);
  const detail::Lattice lattice(grid);
  Field from = detail::pad(lattice, psi, threads), to(from.size());
  const auto reach = static_cast<float>(limit);
  detail::parallel_for(lattice.tiles.size(), threads, [&](std::int64_t t) {
    const detail::Tile tile = lattice.tiles[t];
    detail::distance_beside(lattice.rows(tile), detail::kAllRows, from.data(), {}, lattice.spacings,
                            reach, detail::Far::cut, to.data());
    detail::set_ghosts(lattice, tile, to.data());
  });
  // Distance spreads by one node a pass, along the diagonal of a cell by one in three.
  const int passes =
      static_cast<int>(std::min(std::ceil(std::sqrt(3.0) * limit / grid.spacing.minCoeff()),
                                static_cast<double>(grid.dims[0] + grid.dims[1] + grid.dims[2])));
  for (int pass = 0; pass < passes; ++pass) {
    std::swap(from, to);
    detail::parallel_for(lattice.tiles.size(), threads, [&](std::int64_t t) {
      const detail::Tile tile = lattice.tiles[t];
      detail::relax_distance(lattice.rows(tile), detail::kAllRows, from.data(), lattice.spacings,
                             reach, to.data());
      detail::set_ghosts(lattice, tile, to.data());
    });
  }
  from.resize(0);
  return detail::unpad(lattice, to, threads);
}

Field label_front(const Grid& grid,
                  const Eigen::Ref<const Eigen::Array<std::uint8_t, -1, 1>>& labels) {
  validate(grid);
  check_size("labels", labels.size(), grid);
  Field psi(grid.size());
  for (Eigen::Index i = 0; i < psi.size(); ++i) psi[i] = labels[i] != 0 ? -1.0F : 1.0F;
  return redistance(grid, psi, 4.0 * grid.spacing.maxCoeff());
}

}  // namespace shape3d::levelset
