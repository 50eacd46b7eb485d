#include "attributes.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

#include "cell_words.hpp"
#include "isa.hpp"
#include "vector_blocks.hpp"

namespace shape3d::zmc::detail {
namespace {

/// Steps to the neighbours of a sample along an axis, none where the lattice ends, and the factor
/// of their difference.
struct Neighbours {
  std::int64_t lower = 0, upper = 0;
  double scale = 1.0;

  Neighbours(std::int64_t at, std::int64_t dim, std::int64_t stride)
      : lower(at > 0 ? -stride : 0),
        upper(at + 1 < dim ? stride : 0),
        scale(at > 0 && at + 1 < dim ? 0.5 : 1.0) {}
};

/// Differences along x, y, z at one end of the edges of a block, as LatticeGradient gives them.
template <class T>
SHAPE3D_ZMC_INLINE void end_gradient(const VolumeView& view, const EdgeVertices& vertices,
                                     std::size_t first, int end, Doubles (&g)[3]) {
  using Wide = std::conditional_t<std::is_floating_point_v<T>, T, std::int32_t>;
  const std::array<std::int64_t, 3> strides = view.effective_strides();
  const std::int64_t i_step = vertices.axis == 0 ? end : 0,
                     j = vertices.j + (vertices.axis == 1 ? end : 0),
                     k = vertices.k + (vertices.axis == 2 ? end : 0);
  const T* row = static_cast<const T*>(view.data) + j * strides[1] + k * strides[2];
  const Neighbours y(j, view.dims[1], strides[1]), z(k, view.dims[2], strides[2]);
  std::array<Wide, kBlock> low[3], high[3];
  std::array<double, kBlock> x_scale;
  for (std::size_t m = 0; m < kBlock; ++m) {
    const std::int64_t i = static_cast<std::int64_t>(vertices.index[first + m]) + i_step;
    const T* here = row + i * strides[0];
    const Neighbours x(i, view.dims[0], strides[0]);
    low[0][m] = here[x.lower];
    high[0][m] = here[x.upper];
    x_scale[m] = x.scale;
    low[1][m] = here[y.lower];
    high[1][m] = here[y.upper];
    low[2][m] = here[z.lower];
    high[2][m] = here[z.upper];
  }
  Doubles scale;
  load_block(x_scale.data(), scale);
  for (int d = 0; d < 3; ++d) {
    if (d == 1) scale = Doubles{} + y.scale;
    if (d == 2) scale = Doubles{} + z.scale;
    Doubles lower, upper;
    load_block(low[d].data(), lower);
    load_block(high[d].data(), upper);
    g[d] = scale * upper - scale * lower;
  }
}

template <class T, class Real>
SHAPE3D_ZMC_INLINE void attributes_body(const VolumeView& view, const AttributeSampler& sampler,
                                        const EdgeVertices& vertices, Real* gradients,
                                        Real* normals) {
  const Eigen::Matrix3d& to_world = sampler.world_matrix();
  for (std::size_t first = 0; first < vertices.count; first += kBlock) {
    const std::size_t n = std::min(kBlock, vertices.count - first);
    Doubles lower[3], upper[3], world[3], t;
    end_gradient<T>(view, vertices, first, 0, lower);
    end_gradient<T>(view, vertices, first, 1, upper);
    load_block(vertices.parameter + first, t);
    for (int d = 0; d < 3; ++d) lower[d] = (1.0 - t) * lower[d] + t * upper[d];
    for (int d = 0; d < 3; ++d) {
      world[d] =
          (to_world(d, 0) * lower[0] + to_world(d, 1) * lower[1]) + to_world(d, 2) * lower[2];
    }
    if (gradients != nullptr) store_points(world, n, gradients + 3 * first);
    if (normals == nullptr) continue;
    const Doubles square = (world[0] * world[0] + world[1] * world[1]) + world[2] * world[2];
    bool plain = true;
    for (std::size_t m = 0; m < n; ++m)
      plain = plain && AttributeSampler::is_plain_square(square[m]);
    if (plain) {
      Doubles length = square, normal[3];
      for (std::size_t m = 0; m < kBlock; ++m) length[m] = std::sqrt(square[m]);
      for (int d = 0; d < 3; ++d) normal[d] = sampler.outward() * (world[d] / length);
      store_points(normal, n, normals + 3 * first);
      continue;
    }
    for (std::size_t m = 0; m < n; ++m) {
      const VertexAttributes a = sampler.from_gradient({world[0][m], world[1][m], world[2][m]});
      for (std::size_t d = 0; d < 3; ++d) {
        normals[3 * (first + m) + d] = static_cast<Real>(a.normal[static_cast<Eigen::Index>(d)]);
      }
    }
  }
}

template <class T, class Real>
void attributes_portable(const VolumeView& view, const AttributeSampler& sampler,
                         const EdgeVertices& vertices, Real* gradients, Real* normals) {
  attributes_body<T>(view, sampler, vertices, gradients, normals);
}
#if SHAPE3D_ZMC_X86
template <class T, class Real>
SHAPE3D_ZMC_TARGET_AVX2 void attributes_avx2(const VolumeView& view,
                                             const AttributeSampler& sampler,
                                             const EdgeVertices& vertices, Real* gradients,
                                             Real* normals) {
  attributes_body<T>(view, sampler, vertices, gradients, normals);
}
#endif

}  // namespace

template <class Real>
void write_attributes(const VolumeView& view, const AttributeSampler& sampler,
                      const EdgeVertices& vertices, Real* gradients, Real* normals) {
  visit_sample_type(view.type, [&](auto sample) {
    using T = decltype(sample);
#if SHAPE3D_ZMC_X86
    if (active_isa() != Isa::portable)
      return attributes_avx2<T>(view, sampler, vertices, gradients, normals);
#endif
    attributes_portable<T>(view, sampler, vertices, gradients, normals);
  });
}

template void write_attributes(const VolumeView&, const AttributeSampler&, const EdgeVertices&,
                               float*, float*);
template void write_attributes(const VolumeView&, const AttributeSampler&, const EdgeVertices&,
                               double*, double*);

}  // namespace shape3d::zmc::detail
