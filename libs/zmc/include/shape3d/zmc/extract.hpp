#pragma once

#include "shape3d/zmc/export.hpp"
#include "shape3d/zmc/options.hpp"
#include "shape3d/zmc/status.hpp"
#include "shape3d/zmc/surface.hpp"
#include "shape3d/zmc/volume_view.hpp"

namespace shape3d::zmc {

/// Isosurface { x : f(x) = isovalue } by Zero-crossing Marching Cubes (dissertation, chapter 2).
///
/// A sample is negative, zero or positive by comparison with the isovalue (exact: no difference is
/// rounded). Samples equal to the isovalue become vertices of the surface at their own place; on a
/// lattice edge between opposite signs the vertex divides the edge at t = |a| / (|a| + |b|),
/// clamped into [2⁻²⁰, 1 − 2⁻²⁰], so that vertices are distinct in double. Patches follow the rules
/// of sections 2.3.1 to 2.3.3 and appendix A; cells of eight zeros take the sign that reaches them
/// first from around (docs/notes/zmc.md), so that the surface is closed for every volume: each edge
/// that is not on the volume's border (or at masked cells) belongs to an even number of triangles.
///
/// @param view      nx × ny × nz samples, each dimension at least 2.
/// @param isovalue  Any finite value, representable in the sample type or not.
/// @param surface   Overwritten; its storage is reused. No triangle repeats a vertex, none occurs
/// twice, every
///                  vertex is used. On a status other than ok, and after std::bad_alloc, it has
///                  no triangles and no vertices.
/// @return          Status::empty for a volume that the isovalue does not divide.
/// @throws std::invalid_argument  validate(view) fails; the isovalue is not finite; options.threads
/// or
///         max_vertices is negative; a sample is not finite and options.non_finite is error.
/// @throws std::bad_alloc         working memory (0.25 byte a sample, and 2 × 0.125 more when there
/// are cells
///         of eight zeros) or the surface cannot be allocated.
///
/// Deterministic: the same bytes for any number of threads. O(samples + triangles).
/// May be called concurrently with different surfaces.
template <class Real, class Index>
SHAPE3D_ZMC_EXPORT Status extract(const VolumeView& view, double isovalue, const Options& options,
                                  Surface<Real, Index>& surface);

extern template SHAPE3D_ZMC_EXPORT Status extract(const VolumeView&, double, const Options&,
                                                  Surface<float, std::int32_t>&);
extern template SHAPE3D_ZMC_EXPORT Status extract(const VolumeView&, double, const Options&,
                                                  Surface<float, std::int64_t>&);
extern template SHAPE3D_ZMC_EXPORT Status extract(const VolumeView&, double, const Options&,
                                                  Surface<double, std::int32_t>&);
extern template SHAPE3D_ZMC_EXPORT Status extract(const VolumeView&, double, const Options&,
                                                  Surface<double, std::int64_t>&);

/// The same, returning the surface.
/// @throws std::length_error  the surface has more vertices than 32-bit ids can number.
/// @throws std::runtime_error options.progress cancelled it.
[[nodiscard]] SHAPE3D_ZMC_EXPORT Surface<double, std::int32_t> extract(const VolumeView& view,
                                                                       double isovalue,
                                                                       const Options& options = {});

}  // namespace shape3d::zmc
