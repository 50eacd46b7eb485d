#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "shape3d/levelset/export.hpp"
#include "shape3d/levelset/image_view.hpp"
#include "shape3d/levelset/progress.hpp"
#include "shape3d/levelset/status.hpp"

namespace shape3d::levelset {

/// The κ of F_G = −εκ.
enum class Curvature {
  mean,    ///< κ = κ1 + κ2: smooths everything, also vessels, which it shortens and cuts.
  minimal  ///< κ = the one of κ1 and κ2 of smaller magnitude: smooths surfaces but keeps tubes,
           ///< whose one curvature is 0.
};

/// What lies beyond the border of the volume.
enum class Border {
  outside,   ///< The outside: a front along the border, as that of box_front() over the whole grid,
             ///< moves inwards from there.
  continued  ///< The nearest node: fronts meet the border at a right angle.
};

struct FrontStatistics;

/// Settings of evolve().
struct EvolveOptions {
  int max_iterations = 1000;  ///< At least 1.
  /// A tile is at rest when the mean displacement of the front in it, per unit of time, is at most
  /// this (1: the speed of a front with F = 1) since the last redistancing, or over the last 8 of
  /// them, to and fro counting as nothing. All tiles at rest: converged. At least 0.
  double tolerance = 0.01;
  /// Δt · (max |F| · √Σ h⁻² + 2 ε max k Σ h⁻²) of a step; in (0, 1).
  double cfl = 0.9;
  double curvature = 0.0;  ///< ε, mm; 0: no curvature term.
  Curvature curvature_kind = Curvature::minimal;
  Border border = Border::outside;
  /// ψ is made a distance again when the front may have gone as far as in this many steps without
  /// curvature; 1 … 8.
  int redistance_interval = 4;
  /// Coarser grids, each of half the resolution along the finest axes, that the front moves on
  /// first, the coarsest before the others; 0 … 8, 0: none.
  ///
  /// For evolutions to rest: the front goes fast over the coarse grids wherever all nodes of a
  /// block have F of the same sign, whatever the curvature, and stays elsewhere. It comes nowhere
  /// where it would not come on the grid itself, which does the rest; but time and the ways of the
  /// front in time are those of the coarse grids.
  int coarse_levels = 0;
  int threads = 0;  ///< 0: all processors. The result does not depend on it.
  ProgressFunction progress;
  /// Called from the calling thread after each `watch_interval` iterations that do not end it, with
  /// ψ as it is then, away from the front of the right sign alone: to show the front on its way.
  /// Costs a copy of ψ each time.
  std::function<void(const FrontStatistics&, const Field&)> watch;
  int watch_interval = 10;  ///< At least 1.
};

/// The front after an iteration.
struct FrontStatistics {
  int iteration = 0;  ///< From 1, over all levels.
  int level = 0;      ///< Of the grid: 0 the one given, 1 of half its resolution, …
  double time = 0.0;  ///< Sum of the steps.
  double step = 0.0;  ///< Δt.
  /// Mean displacement per unit of time since the last reinitialisation, over the nodes beside the
  /// front; set with each reinitialisation and kept until the next.
  double speed = 0.0;
  /// Nodes that changed sides in this iteration; a node of a coarser grid counts as a whole block.
  std::int64_t crossed = 0;
  std::int64_t inside = 0;          ///< Nodes with ψ ≤ 0, counted as `crossed`.
  std::int64_t front_nodes = 0;     ///< Nodes of the level beside the front at the last
                                    ///< reinitialisation.
  std::int64_t active_tiles = 0;    ///< Tiles of 8 × 8 × 8 nodes that were computed, in part.
  std::int64_t computed_nodes = 0;  ///< Nodes that were computed.
};

/// Outcome of evolve().
struct Evolution {
  /// ψ, mm: < 0 inside, 0 on the front, > 0 outside; a distance within two nodes of the front,
  /// cut at ±band, and ±band away from it.
  /// A zero is a node that the front passes through exactly: none is moved to one side.
  Field psi;
  Status status = Status::iteration_limit;
  std::vector<FrontStatistics> iterations;
  double band = 0.0;     ///< mm: |ψ| is no more.
  double seconds = 0.0;  ///< Wall clock.
};

/// Solves ψ_t + F|∇ψ| = 0, F = advance − factor·ε·κ (dissertation, 3.1 and 3.2), until the front
/// stands still.
///
/// Narrow band: the volume is cut into tiles; only those with the front in or next to them are
/// computed, and of these not the ones where it has come to rest. Upwind differences of first order
/// (Godunov), central ones for the curvature; steps of Jacobi's kind, so that the result is the
/// same, byte for byte, for any number of threads and any instruction set.
///
/// @param grid     nx × ny × nz nodes.
/// @param psi      Start: any function of the right signs. Redistanced first.
/// @param advance  k·F_A at every node; positive expands the inside.
/// @param factor   k at every node, for the curvature term; empty: 1.
/// @return         On Status::cancelled ψ as far as it came.
/// @throws std::invalid_argument  validate(grid) fails; sizes differ; a value is not finite; no
/// node
///         is inside at the start; an option is out of range.
/// @throws std::bad_alloc  Working memory: 8 bytes a node beside ψ and the speed.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Evolution evolve(const Grid& grid, const Field& psi,
                                                       const Field& advance, const Field& factor,
                                                       const EvolveOptions& options = {});

/// The same, with a start whose memory is given up on the way.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT Evolution evolve(const Grid& grid, Field&& psi,
                                                       const Field& advance, const Field& factor,
                                                       const EvolveOptions& options = {});

}  // namespace shape3d::levelset
