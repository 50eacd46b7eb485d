#include "shape3d/zmc/extract.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "classify.hpp"
#include "count.hpp"
#include "generate.hpp"
#include "parallel.hpp"
#include "pipeline.hpp"

namespace shape3d::zmc {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point& start) {
  const auto now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - start).count();
  start = now;
  return seconds;
}

template <class Real, class Index>
Status finish_empty(Surface<Real, Index>& surface, Status status) {
  surface.positions.clear();
  surface.indices.clear();
  surface.first_zero_face = surface.first_closing = 0;
  return status;
}

}  // namespace

namespace detail {

void check_arguments(const VolumeView& view, double isovalue, const Options& options) {
  validate(view);
  if (view.dims[0] > Plan::kLongestRow - 2) {
    throw std::invalid_argument("dims[0]: expected at most " +
                                std::to_string(Plan::kLongestRow - 2) + " samples in a row, got " +
                                std::to_string(view.dims[0]));
  }
  if (!std::isfinite(isovalue)) {
    throw std::invalid_argument("isovalue: expected a finite value, got " +
                                std::to_string(isovalue));
  }
  if (options.threads < 0) {
    throw std::invalid_argument("options.threads: expected 0 or more, got " +
                                std::to_string(options.threads));
  }
  if (options.max_vertices < 0) {
    throw std::invalid_argument("options.max_vertices: expected 0 or more, got " +
                                std::to_string(options.max_vertices));
  }
}

LayerLoop layer_loop(const Options& options, double from, double to) {
  const int threads = resolve_threads(options.threads);
  return [&options, threads, from, to, reached = from](
             std::int64_t count,
             const std::function<void(std::int64_t, std::int64_t)>& body) mutable {
    constexpr std::int64_t kGrain = 1;
    if (!options.progress) {
      parallel_ranges(count, kGrain, threads, body);
      return true;
    }
    constexpr std::int64_t kBatches = 16;
    const std::int64_t step = std::max<std::int64_t>(1, (count + kBatches - 1) / kBatches);
    for (std::int64_t first = 0; first < count; first += step) {
      const std::int64_t last = std::min(first + step, count);
      parallel_ranges(last - first, kGrain, threads,
                      [&](std::int64_t a, std::int64_t b) { body(first + a, first + b); });
      const double share = static_cast<double>(last) / static_cast<double>(count);
      reached = std::max(reached, from + (to - from) * share);  // several loops may share the range
      if (!options.progress(reached)) return false;
    }
    return true;
  };
}

}  // namespace detail

template <class Real, class Index>
Status extract(const VolumeView& view, double isovalue, const Options& options,
               Surface<Real, Index>& surface) {
  detail::check_arguments(view, isovalue, options);
  surface.counts = Counts{};
  surface.timings = Timings{};
  auto clock = Clock::now();

  detail::SignLattice lattice;
  if (!detail::classify(view, isovalue, options, detail::layer_loop(options, 0.0, 0.2), lattice)) {
    return finish_empty(surface, Status::cancelled);
  }
  surface.timings.classify = seconds_since(clock);

  const detail::AnyMagnitudeReader magnitude(view, isovalue, options.border == Border::capped);
  const detail::LatticeCells cells(lattice, magnitude, options.ties);
  detail::ZeroRegions regions;
  regions.solve(cells);
  surface.timings.zero_regions = seconds_since(clock);

  detail::Plan plan;
  if (!detail::make_plan(lattice, cells, regions, options, detail::layer_loop(options, 0.2, 0.5),
                         plan)) {
    return finish_empty(surface, Status::cancelled);
  }
  surface.counts = plan.counts;
  surface.timings.count = seconds_since(clock);

  const std::int64_t per_quad = options.triangulation == Triangulation::centroid ? 4 : 2;
  const std::int64_t vertices =
      plan.row_vertices +
      (options.triangulation == Triangulation::centroid ? plan.counts.zero_faces : 0);
  const std::int64_t most =
      options.max_vertices > 0 ? options.max_vertices : std::numeric_limits<Index>::max();
  if (vertices > std::min<std::int64_t>(most, std::numeric_limits<Index>::max())) {
    return finish_empty(surface, Status::too_many_vertices);
  }
  surface.first_zero_face = plan.patch_triangles;
  surface.first_closing = surface.first_zero_face + per_quad * plan.counts.zero_faces;
  const std::int64_t triangles = surface.first_closing + plan.counts.closing_triangles;
  if (triangles == 0) return finish_empty(surface, Status::empty);
  surface.positions.clear();  // what was there need not be moved
  surface.indices.clear();
  surface.positions.resize(static_cast<std::size_t>(3 * vertices));
  surface.indices.resize(static_cast<std::size_t>(3 * triangles));
  if (!detail::generate(view, isovalue, options, cells, plan, detail::layer_loop(options, 0.5, 1.0),
                        surface)) {
    return finish_empty(surface, Status::cancelled);
  }
  surface.timings.generate = seconds_since(clock);
  return Status::ok;
}

template Status extract(const VolumeView&, double, const Options&, Surface<float, std::int32_t>&);
template Status extract(const VolumeView&, double, const Options&, Surface<float, std::int64_t>&);
template Status extract(const VolumeView&, double, const Options&, Surface<double, std::int32_t>&);
template Status extract(const VolumeView&, double, const Options&, Surface<double, std::int64_t>&);

Surface<double, std::int32_t> extract(const VolumeView& view, double isovalue,
                                      const Options& options) {
  Surface<double, std::int32_t> surface;
  switch (extract(view, isovalue, options, surface)) {
    case Status::ok:
    case Status::empty:
      break;
    case Status::too_many_vertices:
      throw std::length_error(
          "the surface has more vertices than 32-bit ids or options.max_vertices allow");
    case Status::cancelled:
      throw std::runtime_error("the extraction was cancelled by options.progress");
  }
  return surface;
}

}  // namespace shape3d::zmc
