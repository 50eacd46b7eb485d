#pragma once

// Gradients and normals of the vertices of one row, side by side.

#include <cstddef>
#include <cstdint>

#include "gradient.hpp"
#include "shape3d/zmc/volume_view.hpp"

namespace shape3d::zmc::detail {

/// Vertices inside the lattice edges of one row.
struct EdgeVertices {
  std::int64_t j = 0, k = 0;
  int axis = 0;  ///< Along which the edges run.
  /// Indices of their lower ends along x and places on them, padded to a multiple of four.
  const std::uint32_t* index = nullptr;
  const double* parameter = nullptr;
  std::size_t count = 0;
};

/// Writes what sampler.at_edge() gives for each vertex, bit for bit. For views whose samples are
/// all finite, without a cap.
/// @param gradients, normals  3·count each, or null.
template <class Real>
void write_attributes(const VolumeView& view, const AttributeSampler& sampler,
                      const EdgeVertices& vertices, Real* gradients, Real* normals);

}  // namespace shape3d::zmc::detail
