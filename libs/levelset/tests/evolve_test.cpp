#include "shape3d/levelset/evolve.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/levelset/front.hpp"
#include "shape3d/levelset/instruction_set.hpp"

namespace {
using namespace shape3d::levelset;
using Catch::Contains;

Field constant(const Grid& grid, float value) { return Field::Constant(grid.size(), value); }

/// Radius of the ball with the volume of ψ < 0, linear in ψ across the front.
double radius_of(const Grid& grid, const Field& psi) {
  const auto h = static_cast<float>(grid.mean_spacing());
  const double nodes = (0.5F - psi / h).max(0.0F).min(1.0F).cast<double>().sum();
  return std::cbrt(nodes * grid.spacing.prod() * 3.0 / (4.0 * 3.14159265358979323846));
}

/// A cube of 48 mm, its centre at node (n−1)/2.
Grid cube(double h, double z_ratio) {
  const auto n = static_cast<std::int64_t>(std::lround(48.0 / h)) + 1;
  const auto nz = static_cast<std::int64_t>(std::lround(48.0 / (h * z_ratio))) + 1;
  return {{n, n, nz}, {h, h, h * z_ratio}};
}

Eigen::Vector3d centre(const Grid& grid) {
  return 0.5 * Eigen::Vector3d(static_cast<double>(grid.dims[0] - 1),
                               static_cast<double>(grid.dims[1] - 1),
                               static_cast<double>(grid.dims[2] - 1));
}

/// Steps until `time` has passed.
EvolveOptions steps_for(const Grid& grid, double time, double speed, double epsilon = 0.0) {
  EvolveOptions options;
  const double square = grid.spacing.cwiseAbs2().cwiseInverse().sum();
  const double dt = options.cfl / (speed * std::sqrt(square) + 2 * epsilon * square);
  options.max_iterations = static_cast<int>(std::ceil(time / dt));
  options.tolerance = 0.0;
  options.border = Border::continued;
  return options;
}

TEST_CASE("a sphere under constant speed moves at that speed, to first order",
          "[levelset][analytic]") {
  const double ratio = GENERATE(1.0, 3.0);
  const float speed = GENERATE(1.0F, -1.0F);
  double previous = 0.0;
  for (const double h : {2.0, 1.0, 0.5}) {
    const Grid grid = cube(h, ratio);
    const double r0 = speed > 0 ? 8.0 : 16.0;
    const Evolution e = evolve(grid, sphere_front(grid, centre(grid), r0), constant(grid, speed),
                               {}, steps_for(grid, 6.0, 1.0));
    const double exact = r0 + speed * e.iterations.back().time;
    const double error = std::abs(radius_of(grid, e.psi) - exact);
    INFO("h = " << h << ", 1:1:" << ratio << ", speed " << speed << ", r = "
                << radius_of(grid, e.psi) << ", exact " << exact << ", error " << error);
    CHECK(error < 0.35 * h * ratio);
    if (previous > 0.05) CHECK(error < previous / 1.5);
    previous = error;
  }
}

TEST_CASE("under mean curvature a sphere shrinks by dr/dt = -2 epsilon / r",
          "[levelset][analytic]") {
  for (const double h : {1.0, 0.5}) {
    const Grid grid = cube(h, 1.0);
    EvolveOptions options = steps_for(grid, 24.0, 0.0, 1.0);
    options.curvature = 1.0;
    options.curvature_kind = Curvature::mean;
    const double r0 = 14.0;
    const Evolution e =
        evolve(grid, sphere_front(grid, centre(grid), r0), constant(grid, 0.0F), {}, options);
    const double exact = std::sqrt(r0 * r0 - 4.0 * e.iterations.back().time);
    INFO("h = " << h << ": r = " << radius_of(grid, e.psi) << ", exact " << exact);
    CHECK(radius_of(grid, e.psi) == Approx(exact).margin(0.3 * h));
  }
}

TEST_CASE("under minimal curvature a tube keeps its radius, under mean it shrinks",
          "[levelset][analytic]") {
  const Grid grid{{33, 33, 40}, {1, 1, 1}};
  Field tube(grid.size());
  for (std::int64_t k = 0; k < 40; ++k)
    for (std::int64_t j = 0; j < 33; ++j)
      for (std::int64_t i = 0; i < 33; ++i)
        tube[grid.index(i, j, k)] = static_cast<float>(
            std::hypot(static_cast<double>(i) - 16.0, static_cast<double>(j) - 16.0) - 6.0);
  const auto radius = [&](const Field& psi) {
    return std::sqrt((0.5F - psi).max(0.0F).min(1.0F).cast<double>().sum() / 40.0 / 3.14159265);
  };
  EvolveOptions options = steps_for(grid, 6.0, 0.0, 1.0);
  options.curvature = 1.0;
  const Evolution minimal = evolve(grid, tube, constant(grid, 0.0F), {}, options);
  CHECK(radius(minimal.psi) == Approx(6.0).margin(0.15));
  options.curvature_kind = Curvature::mean;  // dr/dt = −ε/r
  const Evolution mean = evolve(grid, tube, constant(grid, 0.0F), {}, options);
  const double time = mean.iterations.back().time;
  CHECK(radius(mean.psi) == Approx(std::sqrt(36.0 - 2.0 * time)).margin(0.2));
  // Not so a ball: both of its curvatures are 1/r.
  const Field ball = sphere_front(grid, {16, 16, 20}, 6.0);
  options.curvature_kind = Curvature::minimal;
  const Evolution shrunk = evolve(grid, ball, constant(grid, 0.0F), {}, options);
  CHECK(radius_of(grid, shrunk.psi) ==
        Approx(std::sqrt(36.0 - 2.0 * shrunk.iterations.back().time)).margin(0.4));
}

TEST_CASE("psi stays a distance near the front", "[levelset][analytic]") {
  const Grid grid = cube(0.75, 1.0);
  const Evolution e = evolve(grid, sphere_front(grid, centre(grid), 8.0), constant(grid, 1.0F), {},
                             steps_for(grid, 6.0, 1.0));
  // |∇ψ| by central differences at nodes less than one spacing from the front; ψ itself against the
  // distance to the sphere it has become.
  const double r = radius_of(grid, e.psi);
  double worst = 0.0, sum = 0.0;
  int count = 0;
  for (std::int64_t k = 1; k + 1 < grid.dims[2]; ++k)
    for (std::int64_t j = 1; j + 1 < grid.dims[1]; ++j)
      for (std::int64_t i = 1; i + 1 < grid.dims[0]; ++i) {
        const double value = e.psi[grid.index(i, j, k)];
        if (std::abs(value) > 0.75) continue;
        const Eigen::Vector3d gradient(
            e.psi[grid.index(i + 1, j, k)] - e.psi[grid.index(i - 1, j, k)],
            e.psi[grid.index(i, j + 1, k)] - e.psi[grid.index(i, j - 1, k)],
            e.psi[grid.index(i, j, k + 1)] - e.psi[grid.index(i, j, k - 1)]);
        sum += std::abs(gradient.norm() / 1.5 - 1.0);
        ++count;
        const Eigen::Vector3d node(static_cast<double>(i), static_cast<double>(j),
                                   static_cast<double>(k));
        worst = std::max(worst, std::abs((node - centre(grid)).norm() * 0.75 - r - value));
      }
  REQUIRE(count > 1000);
  CHECK(sum / count < 0.08);
  CHECK(worst < 0.5);
}

/// An object with a speed that is 1 in it and −1 outside, from the border of the volume.
Field object_speed(const Grid& grid, bool noisy) {
  std::mt19937 random(5);
  Field speed(grid.size());
  for (std::int64_t k = 0; k < grid.dims[2]; ++k)
    for (std::int64_t j = 0; j < grid.dims[1]; ++j)
      for (std::int64_t i = 0; i < grid.dims[0]; ++i) {
        const double ball =
            7.0 - std::hypot(static_cast<double>(i) - 20.3, static_cast<double>(j) - 19.1,
                             static_cast<double>(k) - 14.6);
        const double rod =
            1.4 - std::hypot(static_cast<double>(j) - 19.0, static_cast<double>(k) - 14.0);
        const double noise = noisy ? 0.4 * static_cast<double>(random() % 1000) / 1000.0 : 0.0;
        speed[grid.index(i, j, k)] =
            static_cast<float>(std::tanh(2.0 * std::max(ball, rod)) * (1.0 - noise));
      }
  return speed;
}

TEST_CASE("the front comes to rest at the zero of the speed, and psi is negative inside",
          "[levelset]") {
  const Grid grid{{41, 40, 30}, {1, 1, 1}};
  const Field speed = object_speed(grid, false);
  const Evolution e = evolve(grid, box_front(grid, {{0, 0, 0}, grid.dims}), speed, {});
  CHECK(e.status == Status::converged);
  CHECK(((e.psi <= 0.0F) == (speed >= 0.0F)).all());
  CHECK(e.iterations.back().inside == (speed >= 0.0F).count());
  CHECK(e.iterations.back().crossed == 0);
  // From the inside outwards it is the same object.
  const Evolution out = evolve(grid, sphere_front(grid, {20, 19, 14}, 3.0), speed, {});
  CHECK(out.status == Status::converged);
  CHECK(((out.psi <= 0.0F) == (e.psi <= 0.0F)).all());
}

TEST_CASE("any number of threads and any instruction set give the same bytes", "[levelset]") {
  const Grid grid{{83, 40, 30}, {0.8, 0.8, 1.4}};
  const Field speed = object_speed(grid, true);
  EvolveOptions options;
  options.curvature = GENERATE(0.0, 0.05);
  options.coarse_levels = GENERATE(0, 2);
  options.threads = 1;
  const Field start = box_front(grid, {{0, 0, 0}, grid.dims});
  const Evolution one = evolve(grid, start, speed, speed.abs(), options);
  for (const int threads : {2, 3, 8}) {
    options.threads = threads;
    const Evolution other = evolve(grid, start, speed, speed.abs(), options);
    CHECK((other.psi == one.psi).all());
    CHECK(other.iterations.size() == one.iterations.size());
  }
  use_instruction_set(InstructionSet::portable);
  const Evolution portable = evolve(grid, start, speed, speed.abs(), options);
  use_instruction_set(InstructionSet::avx2);
  CHECK((portable.psi == one.psi).all());
  CHECK(to_string(InstructionSet::portable) == "portable");
}

TEST_CASE("zeros stay zeros", "[levelset]") {
  // A front through nodes that nothing moves: every zero is still one, and no other node became
  // one.
  const Grid grid{{20, 20, 20}, {1, 1, 1}};
  Field psi(grid.size());
  for (std::int64_t k = 0; k < 20; ++k)
    for (std::int64_t j = 0; j < 20; ++j)
      for (std::int64_t i = 0; i < 20; ++i) psi[grid.index(i, j, k)] = static_cast<float>(i - 9);
  EvolveOptions options;
  options.border = Border::continued;
  options.max_iterations = 20;
  options.tolerance = 0.0;
  Field speed = constant(grid, 0.0F);
  speed[0] = 1.0F;  // far from the front: steps are made
  const Evolution e = evolve(grid, psi, speed, {}, options);
  CHECK(((e.psi == 0.0F) == (psi == 0.0F)).all());
  CHECK((e.psi == 0.0F).count() == 400);
}

TEST_CASE("fronts that vanish or fill the volume are named", "[levelset]") {
  const Grid grid{{20, 20, 20}, {1, 1, 1}};
  const Evolution gone =
      evolve(grid, sphere_front(grid, {10, 10, 10}, 5.0), constant(grid, -1.0F), {});
  CHECK(gone.status == Status::front_vanished);
  CHECK(gone.iterations.back().inside == 0);
  const Evolution full =
      evolve(grid, sphere_front(grid, {10, 10, 10}, 5.0), constant(grid, 1.0F), {});
  CHECK(full.status == Status::front_filled);
  CHECK((full.psi <= 0.0F).all());
  EvolveOptions options;
  options.max_iterations = 3;
  CHECK(evolve(grid, sphere_front(grid, {10, 10, 10}, 5.0), constant(grid, 1.0F), {}, options)
            .status == Status::iteration_limit);
}

TEST_CASE("a step keeps to the CFL bound and the statistics add up", "[levelset]") {
  const Grid grid = cube(1.0, 3.0);
  EvolveOptions options = steps_for(grid, 4.0, 0.5);
  const Evolution e =
      evolve(grid, sphere_front(grid, centre(grid), 8.0), constant(grid, 0.5F), {}, options);
  const double bound = 0.9 / (0.5 * std::sqrt(grid.spacing.cwiseAbs2().cwiseInverse().sum()));
  double time = 0.0;
  for (const FrontStatistics& s : e.iterations) {
    CHECK(s.step == Approx(bound).epsilon(1e-5));
    time += s.step;
    CHECK(s.time == Approx(time));
    CHECK(s.active_tiles > 0);
    CHECK(s.computed_nodes > s.active_tiles);
    CHECK(s.computed_nodes <= 512 * s.active_tiles);
  }
  CHECK(e.iterations.back().speed == Approx(0.5).epsilon(0.25));
  CHECK(e.iterations.back().inside == (e.psi <= 0.0F).count());
}

TEST_CASE("from coarser grids the front comes to the same rest", "[levelset]") {
  const Grid grid{{61, 60, 43}, {0.8, 0.8, 1.1}};
  const bool noisy = GENERATE(false, true);
  const double epsilon = GENERATE(0.0, 0.03);
  const Field speed = object_speed(grid, noisy);
  EvolveOptions options;
  options.curvature = epsilon;
  const Field box = box_front(grid, {{0, 0, 0}, grid.dims});
  const Evolution fine = evolve(grid, box, speed, {}, options);
  REQUIRE(fine.status == Status::converged);
  // Of nodes that the front rests on, |F| under 0.05, either side is right.
  const auto different = [&](const Field& a, const Field& b) {
    return (((a <= 0.0F) != (b <= 0.0F)) && speed.abs() > 0.05F).count();
  };
  const Field ball = sphere_front(grid, {20, 19, 14}, 3.0);
  const Evolution fine_grown = evolve(grid, ball, speed, {}, options);
  for (const int levels : {1, 2, 3, 8}) {
    options.coarse_levels = levels;
    const Evolution coarse = evolve(grid, box, speed, {}, options);
    INFO(levels << " levels, noisy " << noisy << ", curvature " << epsilon);
    CHECK(coarse.status == Status::converged);
    CHECK(different(coarse.psi, fine.psi) <= 4);
    CHECK(coarse.band == fine.band);
    // Levels come down to 0, iterations and time go on.
    const FrontStatistics* before = nullptr;
    for (const FrontStatistics& at : coarse.iterations) {
      CHECK(at.level <= (before ? before->level : levels));
      CHECK(at.iteration == (before ? before->iteration : 0) + 1);
      before = &at;
    }
    CHECK(coarse.iterations.front().level > 0);
    CHECK(coarse.iterations.back().level == 0);
    CHECK(coarse.iterations.back().inside == (coarse.psi <= 0.0F).count());
    // From within, too.
    const Evolution grown = evolve(grid, ball, speed, {}, options);
    CHECK(different(grown.psi, fine_grown.psi) <= 4);
  }
}

TEST_CASE("a coarse front does not pass walls of one node", "[levelset]") {
  // A hollow cube with a wall of one node: from the box the cavity is not found, whatever the
  // level.
  const Grid grid{{40, 40, 40}, {1, 1, 1}};
  Field speed = constant(grid, -1.0F);
  const auto at = [](std::int64_t i, std::int64_t j, std::int64_t k) {
    return std::max({std::abs(i - 19), std::abs(j - 20), std::abs(k - 21)});
  };
  std::int64_t inside = 0;
  for (std::int64_t k = 0; k < 40; ++k)
    for (std::int64_t j = 0; j < 40; ++j)
      for (std::int64_t i = 0; i < 40; ++i) {
        if (at(i, j, k) == 12) speed[grid.index(i, j, k)] = 1.0F;
        inside += at(i, j, k) <= 12 ? 1 : 0;
      }
  for (const int levels : {0, 1, 2}) {
    EvolveOptions options;
    options.coarse_levels = levels;
    const Evolution e = evolve(grid, box_front(grid, {{0, 0, 0}, grid.dims}), speed, {}, options);
    INFO(levels << " levels");
    CHECK(e.status == Status::converged);
    CHECK(e.iterations.back().inside == inside);
    CHECK(e.psi[grid.index(19, 20, 21)] < 0.0F);
    CHECK(e.psi[grid.index(2, 2, 2)] > 0.0F);
  }
}

TEST_CASE("a front that vanishes or fills the volume on a coarse grid says so", "[levelset]") {
  const Grid grid{{40, 40, 40}, {1, 1, 1}};
  EvolveOptions options;
  options.coarse_levels = 2;
  const Field ball = sphere_front(grid, {20, 20, 20}, 9.0);
  const Evolution gone = evolve(grid, ball, constant(grid, -1.0F), {}, options);
  CHECK(gone.status == Status::front_vanished);
  CHECK((gone.psi > 0.0F).all());
  const Evolution full = evolve(grid, ball, constant(grid, 1.0F), {}, options);
  CHECK(full.status == Status::front_filled);
  CHECK((full.psi <= 0.0F).all());
  // Stopped there, by the limit or by the caller, it is a front of the grid asked for.
  options.max_iterations = 3;
  const Evolution few = evolve(grid, ball, constant(grid, 1.0F), {}, options);
  CHECK(few.status == Status::iteration_limit);
  CHECK(few.iterations.size() == 3);
  CHECK(few.psi.size() == grid.size());
  CHECK((few.psi <= 0.0F).count() > (ball <= 0.0F).count());
  CHECK((few.psi > 0.0F).any());
  options.max_iterations = 1000;
  options.watch_interval = 1;
  int seen = 0;
  options.watch = [&](const FrontStatistics&, const Field& psi) {
    CHECK(psi.size() == grid.size());
    CHECK((psi <= 0.0F).count() >= (ball <= 0.0F).count());
    ++seen;
  };
  options.progress = [](const Progress& p) { return p.share < 0.05; };
  const Evolution stopped = evolve(grid, ball, constant(grid, 1.0F), {}, options);
  CHECK(stopped.status == Status::cancelled);
  CHECK(stopped.iterations.back().level > 0);
  CHECK(stopped.psi.size() == grid.size());
  CHECK(seen > 0);
}

TEST_CASE("a front on its way is that of an evolution which ends there", "[levelset]") {
  const Grid grid = cube(2.0, 1.0);
  const Field start = sphere_front(grid, centre(grid), 8.0);
  EvolveOptions options = steps_for(grid, 6.0, 1.0);
  options.watch_interval = 2;
  std::vector<std::pair<FrontStatistics, Field>> seen;
  options.watch = [&seen](const FrontStatistics& at, const Field& psi) {
    seen.emplace_back(at, psi);
  };
  const Evolution whole = evolve(grid, start, constant(grid, 1.0F), {}, options);
  REQUIRE(static_cast<int>(seen.size()) == (options.max_iterations - 1) / 2);
  for (const auto& [at, psi] : seen) {
    EvolveOptions shorter = options;
    shorter.watch = nullptr;
    shorter.max_iterations = at.iteration;
    const Evolution part = evolve(grid, start, constant(grid, 1.0F), {}, shorter);
    CHECK(((psi <= 0.0F) == (part.psi <= 0.0F)).all());
    CHECK(at.inside == (psi <= 0.0F).count());
  }
  // Watching changes nothing.
  options.watch = nullptr;
  CHECK((evolve(grid, start, constant(grid, 1.0F), {}, options).psi == whole.psi).all());
}

TEST_CASE("an evolution reports and can be cancelled", "[levelset]") {
  const Grid grid{{30, 30, 30}, {1, 1, 1}};
  EvolveOptions options;
  double share = 0.0;
  int calls = 0;
  options.progress = [&](const Progress& p) {
    CHECK(p.stage == "evolution");
    CHECK(p.share >= share);
    CHECK(p.share < 1.0);
    CHECK(p.seconds_left >= 0.0);
    share = p.share;
    return ++calls < 5;
  };
  const Evolution e =
      evolve(grid, sphere_front(grid, {15, 15, 15}, 12.0), constant(grid, -1.0F), {}, options);
  CHECK(e.status == Status::cancelled);
  CHECK(e.iterations.size() == 5);
  CHECK(e.psi.size() == grid.size());
}

TEST_CASE("settings and fields of an evolution that are wrong are refused",
          "[levelset][contract]") {
  const Grid grid{{8, 8, 8}, {1, 1, 1}};
  const Field psi = sphere_front(grid, {4, 4, 4}, 2.0), speed = constant(grid, 1.0F);
  const auto refused = [&](void (*change)(EvolveOptions&), const char* message) {
    EvolveOptions options;
    change(options);
    CHECK_THROWS_WITH(evolve(grid, psi, speed, {}, options), Contains(message));
  };
  refused([](EvolveOptions& o) { o.max_iterations = 0; },
          "max_iterations is 0; expected at least 1");
  refused([](EvolveOptions& o) { o.tolerance = -1; }, "tolerance is -1");
  refused([](EvolveOptions& o) { o.cfl = 1; }, "cfl is 1; expected a number between 0 and 1");
  refused([](EvolveOptions& o) { o.curvature = -0.1; }, "curvature is -0.1");
  refused([](EvolveOptions& o) { o.redistance_interval = 9; }, "redistance_interval is 9");
  refused([](EvolveOptions& o) { o.coarse_levels = 9; }, "coarse_levels is 9; expected 0 to 8");
  refused([](EvolveOptions& o) { o.watch_interval = 0; }, "watch_interval is 0");
  refused([](EvolveOptions& o) { o.threads = -1; }, "threads is -1");
  CHECK_THROWS_WITH(evolve(grid, Field::Zero(3), speed, {}),
                    Contains("psi: size is 3; expected 512"));
  CHECK_THROWS_WITH(evolve(grid, psi, Field::Zero(3), {}), Contains("advance: size is 3"));
  CHECK_THROWS_WITH(evolve(grid, psi, speed, Field::Zero(3)), Contains("factor: size is 3"));
  CHECK_THROWS_WITH(evolve(grid, constant(grid, 1.0F), speed, {}),
                    Contains("psi is positive everywhere; expected a node inside"));
  Field bad = speed;
  bad[77] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(evolve(grid, psi, bad, {}), Contains("advance[77] is NaN"));
  CHECK_THROWS_WITH(evolve(grid, bad, speed, {}), Contains("psi[77] is NaN"));
  CHECK_THROWS_AS(evolve(Grid{}, psi, speed, {}), std::invalid_argument);
}
}  // namespace
