#pragma once

#include "crossings.hpp"
#include "geometry.hpp"
#include "plan.hpp"

namespace shape3d::zmc::detail {

/// Writes the vertices of row (j, k) that lie on lattice edges and at zero samples.
template <class Real, class Magnitude>
void generate_row_vertices(const SignLattice& lattice, const Plan& plan, const Geometry& geometry,
                           const Magnitude& magnitude, std::int64_t j, std::int64_t k,
                           Real* positions) {
  const std::int64_t row = lattice.row(j, k);
  const RowPlan& r = plan.rows[static_cast<std::size_t>(row)];
  const Crossings crossings(lattice);
  Real* out = positions + 3 * plan.first_vertex(row);
  const auto put = [&](const Eigen::Vector3d& p) {
    out[0] = static_cast<Real>(p[0]);
    out[1] = static_cast<Real>(p[1]);
    out[2] = static_cast<Real>(p[2]);
    out += 3;
  };
  const auto each = [&](auto&& words, auto&& visit) {
    for (std::int64_t w = 0; w < lattice.words; ++w) {
      for (Word left = words(w); left != 0; left &= left - 1) visit(64 * w + __builtin_ctzll(left));
    }
  };
  const Eigen::Vector3d plane = geometry.plane(static_cast<double>(k));
  const Eigen::Vector3d y_term = geometry.y_term(static_cast<double>(j));
  const Eigen::Vector3d line = plane + y_term;
  if (r.x != 0) {
    each([&](std::int64_t w) { return crossings.along_x(j, k, w); },
         [&](std::int64_t i) {
           const double t = crossing_parameter(magnitude(i, j, k), magnitude(i + 1, j, k));
           put(line + geometry.x_term(static_cast<double>(i) + t));
         });
  }
  if (r.y != 0) {
    each([&](std::int64_t w) { return crossings.along_y(j, k, w); },
         [&](std::int64_t i) {
           const double t = crossing_parameter(magnitude(i, j, k), magnitude(i, j + 1, k));
           put(plane + geometry.y_term(static_cast<double>(j) + t) +
               geometry.x_term(static_cast<double>(i)));
         });
  }
  if (r.z != 0) {
    each([&](std::int64_t w) { return crossings.along_z(j, k, w); },
         [&](std::int64_t i) {
           const double t = crossing_parameter(magnitude(i, j, k), magnitude(i, j, k + 1));
           put(geometry.plane(static_cast<double>(k) + t) + y_term +
               geometry.x_term(static_cast<double>(i)));
         });
  }
  if ((lattice.flags[static_cast<std::size_t>(row)] & kRowZero) != 0) {
    each([&](std::int64_t w) { return crossings.used_zeros(j, k, w); },
         [&](std::int64_t i) { put(line + geometry.x_term(static_cast<double>(i))); });
  }
}

}  // namespace shape3d::zmc::detail
