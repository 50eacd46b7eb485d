#pragma once

// Vertices on lattice edges and at zero samples.

#include <cstdint>
#include <vector>

#include "geometry.hpp"
#include "gradient.hpp"
#include "plan.hpp"
#include "sign_lattice.hpp"

namespace shape3d::zmc::detail {

/// Where vertices go. Null: not wanted.
template <class Real>
struct VertexArrays {
  Real* positions = nullptr;
  Real* gradients = nullptr;
  Real* normals = nullptr;
  std::int64_t* edges = nullptr;  ///< As Surface::edges; with it, edge_parameters.
  Real* edge_parameters = nullptr;

  void put(std::int64_t vertex, const VertexAttributes& attributes) const {
    for (int d = 0; d < 3; ++d) {
      if (gradients != nullptr)
        gradients[3 * vertex + d] = static_cast<Real>(attributes.gradient[d]);
      if (normals != nullptr) normals[3 * vertex + d] = static_cast<Real>(attributes.normal[d]);
    }
  }
  [[nodiscard]] bool with_attributes() const { return gradients != nullptr || normals != nullptr; }
};

/// Writes the vertices of lattice rows; one object per thread.
template <class Real>
class VertexWriter {
 public:
  VertexWriter(const VolumeView& view, double isovalue, const Options& options,
               const Geometry& geometry, const SignLattice& lattice, const Plan& plan,
               const VertexArrays<Real>& arrays);

  /// Crossings along x, y, z and used zero samples of row (j, k).
  void write_row(std::int64_t j, std::int64_t k);

 private:
  void write_crossings(std::int64_t j, std::int64_t k, int axis, std::int64_t first);
  void write_edges(std::int64_t j, std::int64_t k, int axis, std::size_t count,
                   std::int64_t first) const;
  void write_zeros(std::int64_t j, std::int64_t k, std::int64_t first);
  /// Edges and attributes of `count` vertices in hand on edges along an axis; parameters of 0 stand
  /// for lattice points.
  void write_attributes(std::int64_t j, std::int64_t k, int axis, std::size_t count,
                        std::int64_t first);

  const VolumeView& view_;
  std::array<std::int64_t, 3> strides_;
  double isovalue_;
  bool capped_;
  const SignLattice& lattice_;
  const Plan& plan_;
  VertexArrays<Real> arrays_;
  const Geometry& geometry_;
  AttributeSampler attributes_;
  std::vector<std::uint32_t> index_;  ///< Along x, of the vertices in hand.
  std::vector<double> parameter_;     ///< Their places on their edges, 0 … 1.
};

}  // namespace shape3d::zmc::detail
