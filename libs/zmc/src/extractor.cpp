#include "shape3d/zmc/extractor.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>

#include "count.hpp"
#include "generate.hpp"
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
  surface.gradients.clear();
  surface.normals.clear();
  surface.edges.clear();
  surface.edge_parameters.clear();
  surface.first_zero_face = surface.first_closing = 0;
  return status;
}

/// Working memory of one isovalue.
struct Job {
  detail::SignLattice lattice;
  detail::ZeroRegions regions;
  detail::Plan plan;
};

/// Everything after classification; reports progress between `from` and `to`.
template <class Real, class Index>
Status build_surface(const VolumeView& view, double isovalue, const Options& options, double from,
                     double to, Job& job, Surface<Real, Index>& surface) {
  auto clock = Clock::now();
  const detail::AnyMagnitudeReader magnitude(view, isovalue, options.border == Border::capped);
  const detail::LatticeCells cells(job.lattice, magnitude, options.ties);
  job.regions.solve(cells);
  surface.timings.zero_regions = seconds_since(clock);

  const double middle = from + 0.4 * (to - from);
  if (!detail::make_plan(job.lattice, cells, job.regions, options, {0, job.lattice.nz},
                         detail::layer_loop(options, detail::sample_count(view), from, middle),
                         job.plan)) {
    return finish_empty(surface, Status::cancelled);
  }
  surface.counts = job.plan.counts;
  surface.timings.count = seconds_since(clock);

  const bool centred = options.triangulation == Triangulation::centroid;
  const std::int64_t vertices = job.plan.vertices;
  constexpr std::int64_t kMost = std::numeric_limits<Index>::max();
  if (vertices > (options.max_vertices > 0 ? std::min(options.max_vertices, kMost) : kMost)) {
    return finish_empty(surface, Status::too_many_vertices);
  }
  surface.first_zero_face = job.plan.patch_triangles;
  surface.first_closing = surface.first_zero_face + (centred ? 4 : 2) * job.plan.counts.zero_faces;
  const std::int64_t triangles = surface.first_closing + job.plan.counts.closing_triangles;
  if (triangles == 0) return finish_empty(surface, Status::empty);
  surface.positions.resize(static_cast<std::size_t>(3 * vertices));
  surface.indices.resize(static_cast<std::size_t>(3 * triangles));
  if (options.gradients) surface.gradients.resize(surface.positions.size());
  if (options.normals) surface.normals.resize(surface.positions.size());
  if (options.edges) {
    surface.edges.resize(static_cast<std::size_t>(vertices));
    surface.edge_parameters.resize(static_cast<std::size_t>(vertices));
  }
  const detail::Geometry geometry(view, options.border == Border::capped);
  if (!detail::generate(view, isovalue, options, geometry, cells, job.plan,
                        detail::layer_loop(options, detail::sample_count(view), middle, to),
                        surface)) {
    return finish_empty(surface, Status::cancelled);
  }
  surface.timings.generate = seconds_since(clock);
  return Status::ok;
}

template <class Real, class Index>
void reset(Surface<Real, Index>& surface) {
  finish_empty(surface, Status::empty);
  surface.counts = Counts{};
  surface.timings = Timings{};
}

/// Empties surfaces at the end of its scope unless told that they are done.
template <class Real, class Index>
struct EmptyOnException {
  Surface<Real, Index>* surfaces;
  std::size_t count;
  bool done = false;
  ~EmptyOnException() {
    for (std::size_t n = 0; !done && n < count; ++n) reset(surfaces[n]);
  }
};

}  // namespace

struct Extractor::Workspace {
  std::vector<Job> jobs;
};

Extractor::Extractor() : workspace_(std::make_unique<Workspace>()) {}
Extractor::~Extractor() = default;
Extractor::Extractor(Extractor&&) noexcept = default;
Extractor& Extractor::operator=(Extractor&&) noexcept = default;

template <class Real, class Index>
Status Extractor::extract(const VolumeView& view, double isovalue, const Options& options,
                          Surface<Real, Index>& surface) {
  detail::check_arguments(view, isovalue, options);
  reset(surface);
  EmptyOnException<Real, Index> guard{&surface, 1};
  auto clock = Clock::now();
  if (workspace_->jobs.empty()) workspace_->jobs.resize(1);
  Job& job = workspace_->jobs[0];
  constexpr double kClassified = 0.2;
  Status status = Status::cancelled;
  if (detail::classify(view, {{isovalue, &job.lattice}}, options,
                       detail::layer_loop(options, detail::sample_count(view), 0.0, kClassified))) {
    surface.timings.classify = seconds_since(clock);
    status = build_surface(view, isovalue, options, kClassified, 1.0, job, surface);
  }
  guard.done = true;
  return status;
}

template <class Real, class Index>
std::vector<Status> Extractor::extract(const VolumeView& view, const std::vector<double>& isovalues,
                                       const Options& options,
                                       std::vector<Surface<Real, Index>>& surfaces) {
  if (isovalues.empty()) throw std::invalid_argument("isovalues: expected at least one, got none");
  for (const double isovalue : isovalues) detail::check_arguments(view, isovalue, options);
  surfaces.resize(isovalues.size());
  for (auto& surface : surfaces) reset(surface);
  EmptyOnException<Real, Index> guard{surfaces.data(), surfaces.size()};
  auto clock = Clock::now();
  auto& jobs = workspace_->jobs;
  if (jobs.size() < isovalues.size()) jobs.resize(isovalues.size());
  std::vector<detail::Classification> targets;
  for (std::size_t n = 0; n < isovalues.size(); ++n)
    targets.push_back({isovalues[n], &jobs[n].lattice});
  constexpr double kClassified = 0.1;
  std::vector<Status> statuses(isovalues.size(), Status::cancelled);
  if (!detail::classify(
          view, targets, options,
          detail::layer_loop(options, detail::sample_count(view), 0.0, kClassified))) {
    guard.done = true;
    return statuses;
  }
  surfaces[0].timings.classify = seconds_since(clock);
  const double share = (1.0 - kClassified) / static_cast<double>(isovalues.size());
  for (std::size_t n = 0; n < isovalues.size(); ++n) {
    const double from = kClassified + share * static_cast<double>(n);
    statuses[n] =
        build_surface(view, isovalues[n], options, from, from + share, jobs[n], surfaces[n]);
    if (statuses[n] == Status::cancelled) break;
  }
  guard.done = true;
  return statuses;
}

#define SHAPE3D_ZMC_INSTANTIATE(Real, Index)                                                     \
  template Status Extractor::extract(const VolumeView&, double, const Options&,                  \
                                     Surface<Real, Index>&);                                     \
  template std::vector<Status> Extractor::extract(const VolumeView&, const std::vector<double>&, \
                                                  const Options&,                                \
                                                  std::vector<Surface<Real, Index>>&);
SHAPE3D_ZMC_INSTANTIATE(float, std::int32_t)
SHAPE3D_ZMC_INSTANTIATE(float, std::int64_t)
SHAPE3D_ZMC_INSTANTIATE(double, std::int32_t)
SHAPE3D_ZMC_INSTANTIATE(double, std::int64_t)
#undef SHAPE3D_ZMC_INSTANTIATE

}  // namespace shape3d::zmc
