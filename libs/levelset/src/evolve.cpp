#include "shape3d/levelset/evolve.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "forecast.hpp"
#include "halving.hpp"
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
  require(options.coarse_levels >= 0 && options.coarse_levels <= 8, "coarse_levels",
          options.coarse_levels, "0 to 8");
  require(options.watch_interval >= 1, "watch_interval", options.watch_interval, "at least 1");
  check_field("psi", psi, grid);
  check_field("advance", advance, grid);
  if (factor.size() > 0) check_field("factor", factor, grid);
  if (!(psi <= 0.0F).any()) detail::refuse("psi", "positive everywhere", "a node inside");
}

/// How much longer steps may be where F is small.
constexpr float kLocalSteps = 4.0F;

/// |κ| is cut at this, 1/mm.
double max_curvature(const Grid& grid) { return 2.0 / grid.spacing.minCoeff(); }

/// A field on the grid asked for, from one on a coarser.
using Lift = std::function<Field(const Field&)>;

/// A grid, what moves the front on it, and how it lies to the grid asked for.
struct Problem {
  const Grid& grid;
  const Field& advance;
  const Field& factor;  ///< Empty: 1.
  double curvature;     ///< ε, mm.
  int level;            ///< 0: the grid asked for, 1: of half its resolution, …
  std::int64_t cell;    ///< Nodes of the grid asked for to one of this.
  Lift lift;            ///< Empty: the grid is the one asked for.
};

class Solver {
 public:
  explicit Solver(const EvolveOptions& options)
      : options_(options), threads_(detail::resolve_threads(options.threads)) {}

  Evolution solve(const Grid& grid, Field psi, const Field& advance, const Field& factor) {
    levels_ = 0;
    for (Grid at = grid; levels_ < options_.coarse_levels && detail::Halving::possible(at);
         ++levels_)
      at = detail::Halving(at).coarse();
    result_.psi = rest({grid, advance, factor, options_.curvature, 0, 1, {}}, std::move(psi));
    result_.seconds = seconds_since(start_);
    return std::move(result_);
  }

 private:
  /// ψ at rest, the front moved on coarser grids first.
  Field rest(const Problem& problem, Field psi) {
    if (problem.level < levels_) {
      Field refined = coarse_start(problem, psi);
      if (refined.size() > 0) psi = std::move(refined);
    }
    return move(problem, std::move(psi));
  }

  /// ψ after the front came to rest on the grid of half the resolution; empty when there is none.
  Field coarse_start(const Problem& problem, const Field& psi) {
    const detail::Halving halving(problem.grid);
    const Field before = halving.restrict_front(psi, threads_);
    if (!(before <= 0.0F).any()) return {};
    // Where curvature may outweigh F_A the front stays. Elsewhere it changes neither the sign of F
    // nor how far the front comes, and is left out. A front slower than the tolerance is at rest.
    const auto bound = static_cast<float>(problem.curvature * max_curvature(problem.grid));
    const detail::Drive drive = detail::drive_of(problem.advance, problem.factor, bound,
                                                 static_cast<float>(options_.tolerance), threads_);
    const Field speed = halving.restrict_speed(drive, threads_);
    const auto prolong = [&](const Field& coarse) {
      return halving.prolong(psi, before, coarse, problem.advance, drive,
                             options_.border == Border::outside, threads_);
    };
    const auto lift = [&](const Field& coarse) {
      const Field fine = prolong(coarse);
      return problem.lift ? problem.lift(fine) : fine;
    };
    const Field none;
    const Field after = rest({halving.coarse(), speed, none, 0.0, problem.level + 1,
                              problem.cell * halving.block(), lift},
                             before);
    return prolong(after);
  }

  Field move(const Problem& problem, Field psi);
  [[nodiscard]] detail::Step make_step(const Problem& problem, float limit) const;
  bool report(const Problem& problem, const detail::NarrowBand& band);

  const EvolveOptions& options_;
  int threads_, levels_ = 0;
  Clock::time_point start_ = Clock::now();
  detail::Forecast forecast_{1};
  bool ended_ = false;  // by the limit of iterations, or cancelled
  FrontStatistics statistics_;
  Evolution result_;
};

/// Calls watch and progress; false cancels.
bool Solver::report(const Problem& problem, const detail::NarrowBand& band) {
  if (options_.watch && statistics_.iteration % options_.watch_interval == 0)
    options_.watch(statistics_, problem.lift ? problem.lift(band.copy()) : band.copy());
  if (!options_.progress) return true;
  forecast_.add(statistics_.iteration, band.active_tiles(), seconds_since(start_));
  if (levels_ == 0)
    return options_.progress({"evolution", forecast_.share, forecast_.seconds_left});
  // The coarser levels take a small part of the time; what the finer ones will take is not known.
  constexpr double kCoarse = 0.3;
  const double span = problem.level > 0 ? kCoarse / levels_ : 1.0 - kCoarse;
  const double base = problem.level > 0 ? span * (levels_ - problem.level) : kCoarse;
  const double left =
      problem.level > 0 ? std::numeric_limits<double>::quiet_NaN() : forecast_.seconds_left;
  return options_.progress({"evolution", base + span * forecast_.share, left});
}

detail::Step Solver::make_step(const Problem& problem, float limit) const {
  detail::Step step;
  step.limit = limit;
  step.curvature = static_cast<float>(problem.curvature);
  step.max_curvature = static_cast<float>(max_curvature(problem.grid));
  if (problem.curvature > 0.0) {
    step.term = options_.curvature_kind == Curvature::mean ? detail::CurvatureTerm::mean
                                                           : detail::CurvatureTerm::minimal;
  } else if (levels_ > 0 && problem.level == 0) {
    // After a coarse start time means nothing any more: only where the front rests does, and that
    // does not depend on the length of the steps, which may differ from node to node.
    step.gain = kLocalSteps;
  }
  return step;
}

/// ψ at rest on one grid.
Field Solver::move(const Problem& problem, Field psi) {
  const Grid& grid = problem.grid;
  detail::Lattice lattice(grid);
  if (options_.border == Border::outside) {
    for (int axis = 0; axis < 3; ++axis)
      lattice.ghost_floor[axis] = 0.5F * lattice.spacings.h[axis];
  }
  // A node beside the front may be the largest spacing away from it; the front then moves by up to
  // two of the smallest before distances are made again.
  const double least = grid.spacing.minCoeff(),
               square = grid.spacing.cwiseAbs2().cwiseInverse().sum();
  const auto limit = static_cast<float>(grid.spacing.maxCoeff() + 2.1 * least);
  result_.band = limit;
  const double epsilon = problem.curvature;
  const Field ones = epsilon > 0.0 && problem.factor.size() == 0
                         ? Field::Ones(problem.advance.size()).eval()
                         : Field();
  const Field& k = problem.factor.size() > 0 ? problem.factor : ones;
  const double max_factor = epsilon > 0.0 ? static_cast<double>(k.maxCoeff()) : 0.0;

  // Redistancing moves a curved front by a share of h²/r. So it is done by the way that the front
  // may have gone, not by the number of steps, which curvature makes short; a curvature of half a
  // spacing is as much as counts.
  const double reach = options_.redistance_interval * options_.cfl / std::sqrt(square);
  // Curvature looks at more nodes, and over more steps.
  const double margin = epsilon > 0.0 ? 1.5 : 1.0;
  detail::NarrowBand band(lattice, std::move(psi), problem.advance, k, limit, margin * reach,
                          threads_);
  detail::Step step = make_step(problem, limit);
  // Fronts of coarse grids need not rest as near to their place.
  const double tolerance =
      options_.tolerance * (problem.level > 0 ? 5.0 : static_cast<double>(step.gain));
  forecast_ = detail::Forecast(options_.max_iterations);
  const auto end = [this](Status status) {
    result_.status = status;
    ended_ = status == Status::iteration_limit || status == Status::cancelled;
  };
  double since_redistance = 0.0, travelled = 0.0;
  while (!ended_) {
    const double rate = band.max_speed() * std::sqrt(square) + 2.0 * epsilon * max_factor * square;
    const bool still = !(rate > 0.0);
    step.most = band.max_speed();
    step.dt = still ? 0.0F : static_cast<float>(options_.cfl / rate);

    ++statistics_.iteration;
    statistics_.level = problem.level;
    statistics_.active_tiles = band.active_tiles();
    statistics_.computed_nodes = band.computed_nodes();
    statistics_.step = step.dt;
    statistics_.time += step.dt;
    statistics_.crossed = band.advance(step) * problem.cell;
    since_redistance += step.dt;
    travelled += step.dt * (band.max_speed() + epsilon * max_factor * 0.5 / least);
    const bool last = statistics_.iteration == options_.max_iterations || still;
    if (last || travelled >= 0.999 * reach) {
      const detail::NarrowBand::Motion motion = band.redistance(tolerance * since_redistance);
      statistics_.speed = since_redistance > 0.0 ? motion.mean / since_redistance : 0.0;
      statistics_.front_nodes = motion.nodes;
      since_redistance = travelled = 0.0;
    }
    statistics_.inside = band.inside() * problem.cell;
    result_.iterations.push_back(statistics_);

    const bool resting = still || band.active_tiles() == 0;
    if (band.inside() == 0) {
      end(Status::front_vanished);
      break;
    }
    if (resting) {
      end(band.inside() == grid.size() ? Status::front_filled : Status::converged);
      break;
    }
    if (last) {
      end(Status::iteration_limit);
    } else if (!report(problem, band)) {
      end(Status::cancelled);
    }
  }
  return band.take();
}

}  // namespace

Evolution evolve(const Grid& grid, Field&& psi, const Field& advance, const Field& factor,
                 const EvolveOptions& options) {
  check(grid, psi, advance, factor, options);
  return Solver(options).solve(grid, std::move(psi), advance, factor);
}

Evolution evolve(const Grid& grid, const Field& psi, const Field& advance, const Field& factor,
                 const EvolveOptions& options) {
  check(grid, psi, advance, factor, options);
  return Solver(options).solve(grid, psi, advance, factor);
}

}  // namespace shape3d::levelset
