#include "shape3d/zmc/stream.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

#include "classify.hpp"
#include "count.hpp"
#include "generate.hpp"
#include "pipeline.hpp"
#include "sparse_zero_regions.hpp"

namespace shape3d::zmc {
namespace {

/// Planes of a source in memory; moves forward through the volume and keeps what windows share.
class Window {
 public:
  explicit Window(const PlaneSource& source)
      : source_(source),
        plane_bytes_(static_cast<std::size_t>(source.dims[0] * source.dims[1]) *
                     sample_size(source.type)) {}

  /// Makes planes [first, last) the window; both never fall within a pass.
  void move_to(std::int64_t first, std::int64_t last) {
    const std::int64_t kept = std::max<std::int64_t>(0, last_ - first);
    const std::size_t bytes = static_cast<std::size_t>(last - first) * plane_bytes_;
    if (kept > 0) {
      std::memmove(samples_.data(),
                   samples_.data() + static_cast<std::size_t>(first - first_) * plane_bytes_,
                   static_cast<std::size_t>(kept) * plane_bytes_);
    }
    if (samples_.size() < bytes) samples_.resize(bytes);
    const std::int64_t begin = first + kept;
    if (begin < last) {
      source_.read(begin, last - begin,
                   samples_.data() + static_cast<std::size_t>(kept) * plane_bytes_);
    }
    first_ = first;
    last_ = last;
  }
  void rewind() { first_ = last_ = 0; }

  [[nodiscard]] std::int64_t first() const { return first_; }
  [[nodiscard]] VolumeView view() const {
    VolumeView view;
    view.data = samples_.data();
    view.type = source_.type;
    view.dims = {source_.dims[0], source_.dims[1], last_ - first_};
    view.spacing = source_.spacing;
    view.origin = source_.origin;
    view.direction = source_.direction;
    return view;
  }

 private:
  const PlaneSource& source_;
  std::size_t plane_bytes_;
  std::int64_t first_ = 0, last_ = 0;
  std::vector<std::byte> samples_;
};

/// A slab owns the vertices that begin in its planes and the cells above them; it sees one plane
/// below and two above. Planes are those of the lattice, which has one more on every side of the
/// samples when the border is capped.
struct Slab {
  std::int64_t first, last;
};

/// @param nz  Planes of the lattice.
std::vector<Slab> slabs_of(const PlaneSource& source, std::int64_t nz, std::int64_t planes) {
  if (planes == 0) {
    constexpr std::int64_t kBytes = std::int64_t{64} << 20;
    const auto plane_bytes =
        source.dims[0] * source.dims[1] * static_cast<std::int64_t>(sample_size(source.type));
    planes = std::max<std::int64_t>(1, kBytes / plane_bytes);
  }
  std::vector<Slab> slabs;
  for (std::int64_t first = 0; first < nz;) {
    std::int64_t last = std::min(nz, first + planes);
    if (nz - last == 1) last = nz;  // the last plane has no cells of its own
    slabs.push_back({first, last});
    first = last;
  }
  return slabs;
}

void add(Counts& total, const Counts& slab) {
  total.cells_with_patch += slab.cells_with_patch;
  for (std::size_t c = 0; c < total.faces_by_case.size(); ++c)
    total.faces_by_case[c] += slab.faces_by_case[c];
  total.patches += slab.patches;
  total.zero_vertices += slab.zero_vertices;
  total.zero_faces += slab.zero_faces;
  total.closing_triangles += slab.closing_triangles;
  total.masked_cells += slab.masked_cells;
  total.centroids += slab.centroids;
  if (slab.nonmanifold_edges >= 0)
    total.nonmanifold_edges =
        std::max<std::int64_t>(0, total.nonmanifold_edges) + slab.nonmanifold_edges;
}

template <class Real>
class Streamer {
 public:
  using Deliver = std::function<bool(const Surface<Real, std::int64_t>&, std::int64_t)>;

  Streamer(const PlaneSource& source, double isovalue, const Options& options, std::int64_t planes)
      : source_(source),
        isovalue_(isovalue),
        options_(options),
        quiet_(options),
        margin_(options.border == Border::capped ? 1 : 0),
        planes_(source.dims[2] + 2 * margin_),
        slabs_(slabs_of(source, planes_, planes)),
        window_(source),
        sparse_(source.dims[0] + 2 * margin_, source.dims[1] + 2 * margin_) {
    quiet_.progress = nullptr;
  }

  Status run(const Deliver& deliver, Counts& total) {
    const bool twice = source_.can_be_read_twice && slabs_.size() > 1;
    const double middle = twice ? 0.3 : 0.0;
    if (twice) {
      for (std::size_t s = 0; s < slabs_.size(); ++s) {
        load(slabs_[s]);
        const detail::AnyMagnitudeReader magnitude(view_, isovalue_, margin_ != 0);
        const detail::LatticeCells cells(lattice_, magnitude, options_.ties);
        sparse_.scan(cells, window_.first(), slabs_[s].first - window_.first(),
                     slabs_[s].last - window_.first());
        if (!report(middle * share(s))) return Status::cancelled;
      }
      sparse_.solve();
      total.all_zero_cells = sparse_.cell_count();
      window_.rewind();
    }
    std::int64_t delivered = 0;
    bool any = false;
    for (std::size_t s = 0; s < slabs_.size(); ++s) {
      load(slabs_[s]);
      const Status status = emit(slabs_[s], twice, delivered, total);
      if (status != Status::ok) return status;
      any = any || surface_.triangle_count() > 0;
      if (!deliver(surface_, delivered)) return Status::cancelled;
      delivered += surface_.vertex_count();
      if (!report(middle + (1.0 - middle) * share(s))) return Status::cancelled;
    }
    return any ? Status::ok : Status::empty;
  }

 private:
  [[nodiscard]] double share(std::size_t slab) const {
    return static_cast<double>(slab + 1) / static_cast<double>(slabs_.size());
  }
  [[nodiscard]] bool report(double share) const {
    return !options_.progress || options_.progress(share);
  }

  /// Samples and signs of a slab and the planes around it.
  ///
  /// With a capped border the lattice of a window has imaginary planes below and above its samples,
  /// also where the volume goes on: the window is so large that they lie outside what the slab
  /// sees. Plane 0 of the window's lattice is plane window_.first() of the whole in either case.
  void load(const Slab& slab) {
    window_.move_to(std::max<std::int64_t>(0, slab.first - 1 - margin_),
                    std::min(source_.dims[2], slab.last + 2 - margin_));
    view_ = window_.view();
    detail::classify(view_, {{isovalue_, &lattice_}}, quiet_,
                     detail::layer_loop(quiet_, detail::sample_count(view_), 0.0, 1.0),
                     window_.first());
  }

  Status emit(const Slab& slab, bool regions_known, std::int64_t delivered, Counts& total) {
    const detail::AnyMagnitudeReader magnitude(view_, isovalue_, margin_ != 0);
    const detail::LatticeCells cells(lattice_, magnitude, options_.ties);
    const detail::Plan::Part part{slab.first - window_.first(), slab.last - window_.first()};
    if (regions_known) {
      sparse_.apply(lattice_, window_.first(), regions_);
    } else {
      bool at_seam = false;
      const auto mark = [&](const detail::CellPlace&) { at_seam = true; };
      if (slab.first > 0)
        detail::for_each_all_zero_cell(lattice_, part.first - 1, part.first + 1, mark);
      if (slab.last < planes_) {
        detail::for_each_all_zero_cell(lattice_, part.last - 1, part.last + 1, mark);
      }
      if (at_seam) return Status::zero_region_at_seam;
      regions_.solve(cells);
      total.all_zero_cells += regions_.cell_count();
    }
    const auto loop = detail::layer_loop(quiet_, detail::sample_count(view_), 0.0, 1.0);
    detail::make_plan(lattice_, cells, regions_, quiet_, part, loop, plan_);
    plan_.first_id = delivered;
    add(total, plan_.counts);
    if (options_.max_vertices > 0 && delivered + plan_.vertices > options_.max_vertices) {
      return Status::too_many_vertices;
    }
    surface_.counts = plan_.counts;
    const std::int64_t per_quad = options_.triangulation == Triangulation::centroid ? 4 : 2;
    surface_.first_zero_face = plan_.patch_triangles;
    surface_.first_closing = surface_.first_zero_face + per_quad * plan_.counts.zero_faces;
    resize(surface_.positions, plan_.vertices, true);
    resize(surface_.gradients, plan_.vertices, options_.gradients);
    resize(surface_.normals, plan_.vertices, options_.normals);
    resize(surface_.indices, surface_.first_closing + plan_.counts.closing_triangles, true);
    const detail::Geometry geometry(view_, margin_ != 0, window_.first());
    detail::generate(view_, isovalue_, quiet_, geometry, cells, plan_, loop, surface_);
    return Status::ok;
  }

  template <class Buffer>
  static void resize(Buffer& buffer, std::int64_t triples, bool wanted) {
    buffer.clear();
    if (wanted) buffer.resize(static_cast<std::size_t>(3 * triples));
  }

  const PlaneSource& source_;
  double isovalue_;
  const Options& options_;
  Options quiet_;
  std::int64_t margin_;  ///< Planes of the lattice outside the samples, on either side.
  std::int64_t planes_;  ///< Of the lattice.
  std::vector<Slab> slabs_;
  Window window_;
  VolumeView view_;
  detail::SignLattice lattice_;
  detail::SparseZeroRegions sparse_;
  detail::ZeroRegions regions_;
  detail::Plan plan_;
  Surface<Real, std::int64_t> surface_;
};

}  // namespace

template <class Real>
Status stream(const PlaneSource& source, double isovalue, const Options& options,
              const StreamOptions& stream_options,
              const std::function<bool(const Surface<Real, std::int64_t>&, std::int64_t)>& deliver,
              Counts* counts) {
  if (!source.read) throw std::invalid_argument("source.read: expected a function, got none");
  VolumeView whole;
  whole.data = &source;  // only the shape is looked at
  whole.type = source.type;
  whole.dims = source.dims;
  whole.spacing = source.spacing;
  whole.origin = source.origin;
  whole.direction = source.direction;
  detail::check_arguments(whole, isovalue, options);
  if (options.edges) {
    throw std::invalid_argument("options.edges: stream() does not say on which edges vertices lie");
  }
  if (stream_options.planes_per_slab < 0) {
    throw std::invalid_argument("planes_per_slab: expected 0 or more, got " +
                                std::to_string(stream_options.planes_per_slab));
  }
  Counts total;
  const Status status =
      Streamer<Real>(source, isovalue, options, stream_options.planes_per_slab).run(deliver, total);
  if (counts != nullptr) *counts = total;
  return status;
}

template Status stream(
    const PlaneSource&, double, const Options&, const StreamOptions&,
    const std::function<bool(const Surface<float, std::int64_t>&, std::int64_t)>&, Counts*);
template Status stream(
    const PlaneSource&, double, const Options&, const StreamOptions&,
    const std::function<bool(const Surface<double, std::int64_t>&, std::int64_t)>&, Counts*);

}  // namespace shape3d::zmc
