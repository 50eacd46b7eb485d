#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include <Eigen/Core>

#include "shape3d/zmc/export.hpp"
#include "shape3d/zmc/options.hpp"
#include "shape3d/zmc/status.hpp"
#include "shape3d/zmc/surface.hpp"
#include "shape3d/zmc/volume_view.hpp"

namespace shape3d::zmc {

/// A volume that is not in memory but delivered plane by plane.
struct PlaneSource {
  SampleType type = SampleType::float32;
  std::array<std::int64_t, 3> dims{0, 0, 0};
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();
  /// Writes planes z = first … first + count − 1, dense, x fastest. Each pass asks for consecutive
  /// ranges from plane 0 to the last. What it throws is passed on.
  std::function<void(std::int64_t first, std::int64_t count, void* samples)> read;
  /// Whether read() may be called for a second pass from plane 0.
  bool can_be_read_twice = true;
};

/// Settings of stream() beyond Options.
struct StreamOptions {
  std::int64_t planes_per_slab = 0;  ///< 0: as many as make about 64 MB of samples.
};

/// extract() for volumes larger than memory, slab by slab.
///
/// `deliver` receives the surface of each slab in order: the vertices that begin in its planes, and
/// the triangles of its cells with ids of the whole surface. Vertices are numbered in the order of
/// delivery, as extract() numbers them; a triangle may name vertices that the next slab delivers.
/// All slabs together are exactly the surface that extract() gives, triangles in another order: by
/// slab, within a slab patch, zero face, closing. `first_id` is the id of the slab's first vertex.
/// Returning false cancels.
///
/// A region of all-zero cells can reach through every slab, so the source is read twice: the first
/// pass resolves the zero regions (9 bytes for each all-zero cell), the second emits. A source that
/// cannot be read twice ends with Status::zero_region_at_seam at the first slab that has a cell of
/// eight zeros in one of the two layers at its seam.
///
/// @param counts  Totals over all slabs; may be null. options.max_vertices is a limit on the total.
/// A slab of a capped surface counts planes of the lattice that has one more on every side: the
/// first slab begins with the cap below plane 0.
///
/// @throws std::invalid_argument  as extract() (a bad source is named by the field); options.edges
///         is set; source.read is empty; planes_per_slab is negative.
/// @throws std::bad_alloc  as extract(), for a slab; what was delivered before it stays valid.
/// Memory: planes_per_slab + 3 planes of samples (capped: 4) and of signs, and the surface of a
/// slab.
template <class Real>
SHAPE3D_ZMC_EXPORT Status stream(const PlaneSource& source, double isovalue, const Options& options,
                                 const StreamOptions& stream_options,
                                 const std::function<bool(const Surface<Real, std::int64_t>& slab,
                                                          std::int64_t first_id)>& deliver,
                                 Counts* counts = nullptr);

extern template SHAPE3D_ZMC_EXPORT Status
stream(const PlaneSource&, double, const Options&, const StreamOptions&,
       const std::function<bool(const Surface<float, std::int64_t>&, std::int64_t)>&, Counts*);
extern template SHAPE3D_ZMC_EXPORT Status
stream(const PlaneSource&, double, const Options&, const StreamOptions&,
       const std::function<bool(const Surface<double, std::int64_t>&, std::int64_t)>&, Counts*);

}  // namespace shape3d::zmc
