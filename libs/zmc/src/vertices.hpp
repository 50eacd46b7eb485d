#pragma once

// Vertices on lattice edges and at zero samples.

#include <cstdint>
#include <vector>

#include "geometry.hpp"
#include "plan.hpp"
#include "sign_lattice.hpp"

namespace shape3d::zmc::detail {

/// Writes the vertices of lattice rows; one object per thread.
template <class Real>
class VertexWriter {
 public:
  VertexWriter(const VolumeView& view, double isovalue, bool capped, const SignLattice& lattice,
               const Plan& plan, Real* positions);

  /// Crossings along x, y, z and used zero samples of row (j, k).
  void write_row(std::int64_t j, std::int64_t k);

 private:
  void write_crossings(std::int64_t j, std::int64_t k, int axis, Real* out);
  void write_zeros(std::int64_t j, std::int64_t k, Real* out);

  const VolumeView& view_;
  std::array<std::int64_t, 3> strides_;
  double isovalue_;
  bool capped_;
  const SignLattice& lattice_;
  const Plan& plan_;
  Real* positions_;
  Geometry geometry_;
  std::vector<std::uint32_t> index_;  ///< Along x, of the vertices in hand.
  std::vector<double> parameter_;     ///< Their places on their edges, 0 … 1.
};

}  // namespace shape3d::zmc::detail
