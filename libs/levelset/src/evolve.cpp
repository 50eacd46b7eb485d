#include "shape3d/levelset/evolve.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "message.hpp"
#include "narrow_band.hpp"
#include "parallel.hpp"
#include "samples.hpp"

namespace shape3d::levelset {
namespace {

using detail::text;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void check_field(const char* name, const Field& field, const Grid& grid) {
  if (field.size() != grid.size()) {
    detail::refuse(std::string(name) + ": size", text(static_cast<std::int64_t>(field.size())),
                   text(grid.size()) + ", one value a node");
  }
  detail::require_finite(field, name);
}

void check(const Grid& grid, const Field& psi, const Field& advance, const Field& factor,
           const EvolveOptions& options) {
  using detail::require;
  validate(grid);
  require(options.max_iterations >= 1, "max_iterations", options.max_iterations, "at least 1");
  require(std::isfinite(options.tolerance) && options.tolerance >= 0.0, "tolerance",
          options.tolerance, "a finite number that is not negative");
  require(options.cfl > 0.0 && options.cfl < 1.0, "cfl", options.cfl, "a number between 0 and 1");
  require(std::isfinite(options.curvature) && options.curvature >= 0.0, "curvature",
          options.curvature, "a finite number of mm that is not negative");
  require(options.redistance_interval >= 1 && options.redistance_interval <= 8,
          "redistance_interval", options.redistance_interval, "1 to 8");
  require(options.watch_interval >= 1, "watch_interval", options.watch_interval, "at least 1");
  check_field("psi", psi, grid);
  check_field("advance", advance, grid);
  if (factor.size() > 0) check_field("factor", factor, grid);
  if (!(psi <= 0.0F).any()) detail::refuse("psi", "positive everywhere", "a node inside");
}

/// Foretells when the front will rest, from how the number of active tiles falls.
class Forecast {
 public:
  explicit Forecast(int limit) : limit_(limit) {}

  void add(int iteration, std::int64_t tiles, double seconds) {
    work_ += static_cast<double>(tiles);
    history_.push_back({iteration, tiles});
    const double per_tile = work_ > 0.0 ? seconds / work_ : 0.0;
    // The tiles of ten records ago against those of now: a line to zero.
    const std::size_t back = std::min<std::size_t>(history_.size() - 1, 10);
    const auto& past = history_[history_.size() - 1 - back];
    double left = limit_ - iteration;
    if (back > 0 && past.second > tiles) {
      const double fall =
          static_cast<double>(past.second - tiles) / static_cast<double>(iteration - past.first);
      left = std::min(left, static_cast<double>(tiles) / fall);
    }
    seconds_left = left * per_tile * 0.5 * static_cast<double>(tiles);
    if (seconds + seconds_left > 0.0)
      share = std::max(share, std::min(seconds / (seconds + seconds_left), 0.999));
  }

  double share = 0.0, seconds_left = 0.0;

 private:
  int limit_;
  double work_ = 0.0;
  std::vector<std::pair<int, std::int64_t>> history_;
};

detail::Step make_step(const Grid& grid, const EvolveOptions& options, float limit) {
  detail::Step step;
  step.limit = limit;
  step.curvature = static_cast<float>(options.curvature);
  step.max_curvature = static_cast<float>(2.0 / grid.spacing.minCoeff());
  if (options.curvature > 0.0) {
    step.term = options.curvature_kind == Curvature::mean ? detail::CurvatureTerm::mean
                                                          : detail::CurvatureTerm::minimal;
  }
  return step;
}

}  // namespace

Evolution evolve(const Grid& grid, const Field& psi, const Field& advance, const Field& factor,
                 const EvolveOptions& options) {
  check(grid, psi, advance, factor, options);
  const int threads = detail::resolve_threads(options.threads);
  const Clock::time_point start = Clock::now();

  Evolution result;
  detail::Lattice lattice(grid);
  if (options.border == Border::outside) {
    for (int axis = 0; axis < 3; ++axis)
      lattice.ghost_floor[axis] = 0.5F * lattice.spacings.h[axis];
  }
  // A node beside the front may be the largest spacing away from it; the front then moves by up to
  // two of the smallest before distances are made again.
  const double least = grid.spacing.minCoeff(),
               square = grid.spacing.cwiseAbs2().cwiseInverse().sum();
  const auto limit = static_cast<float>(grid.spacing.maxCoeff() + 2.1 * least);
  result.band = limit;
  const Field ones =
      options.curvature > 0.0 && factor.size() == 0 ? Field::Ones(advance.size()).eval() : Field();
  const Field& k = factor.size() > 0 ? factor : ones;
  const double max_factor = options.curvature > 0.0 ? static_cast<double>(k.maxCoeff()) : 0.0;

  // Redistancing moves a curved front by a share of h²/r. So it is done by the way that the front
  // may have gone, not by the number of steps, which curvature makes short; a curvature of half a
  // spacing is as much as counts.
  const double reach = options.redistance_interval * options.cfl / std::sqrt(square);
  // Curvature looks at more nodes, and over more steps.
  const double margin = options.curvature > 0.0 ? 1.5 : 1.0;
  detail::NarrowBand band(lattice, psi, advance, k, limit, margin * reach, threads);
  detail::Step step = make_step(grid, options, limit);
  Forecast forecast(options.max_iterations);
  FrontStatistics statistics;
  double since_redistance = 0.0, travelled = 0.0;
  for (int iteration = 1;; ++iteration) {
    const double rate =
        band.max_speed() * std::sqrt(square) + 2.0 * options.curvature * max_factor * square;
    const bool still = !(rate > 0.0);
    step.dt = still ? 0.0F : static_cast<float>(options.cfl / rate);

    statistics.iteration = iteration;
    statistics.active_tiles = band.active_tiles();
    statistics.step = step.dt;
    statistics.time += step.dt;
    statistics.crossed = band.advance(step);
    since_redistance += step.dt;
    travelled += step.dt * (band.max_speed() + options.curvature * max_factor * 0.5 / least);
    const bool last = iteration == options.max_iterations || still;
    if (last || travelled >= 0.999 * reach) {
      const detail::NarrowBand::Motion motion =
          band.redistance(options.tolerance * since_redistance);
      statistics.speed = since_redistance > 0.0 ? motion.mean / since_redistance : 0.0;
      statistics.front_nodes = motion.nodes;
      since_redistance = travelled = 0.0;
    }
    statistics.inside = band.inside();
    result.iterations.push_back(statistics);

    if (statistics.inside == 0) {
      result.status = Status::front_vanished;
      break;
    }
    if (statistics.inside == grid.size() && (still || band.active_tiles() == 0)) {
      result.status = Status::front_filled;
      break;
    }
    if (still || band.active_tiles() == 0) {
      result.status = Status::converged;
      break;
    }
    if (last) {
      result.status = Status::iteration_limit;
      break;
    }
    if (options.watch && iteration % options.watch_interval == 0)
      options.watch(statistics, band.copy());
    if (options.progress) {
      forecast.add(iteration, band.active_tiles(), seconds_since(start));
      if (!options.progress({"evolution", forecast.share, forecast.seconds_left})) {
        result.status = Status::cancelled;
        break;
      }
    }
  }
  result.psi = band.take();
  result.seconds = seconds_since(start);
  return result;
}

}  // namespace shape3d::levelset
