#include "shape3d/descriptors/hsh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ball_voxels.hpp"
#include "coefficients.hpp"
#include "gegenbauer.hpp"
#include "interpolate.hpp"
#include "parallel.hpp"
#include "shape3d/descriptors/hsh_sampling.hpp"
#include "shell_harmonics.hpp"
#include "sphere_map.hpp"
#include "text.hpp"
#include "voxel_check.hpp"

namespace shape3d::descriptors {
namespace {

constexpr int kDissertationGrid = 20;  // appendix D: 20 × 20 × 20 angles

// R_{λ,l} at each shell times the measure of one voxel there, pairs by shells.
Eigen::MatrixXd weighted_radial(const HshOptions& options, const detail::BallVoxels& ball) {
  const detail::Gegenbauer gegenbauer(options.K);
  Eigen::MatrixXd radial(static_cast<Eigen::Index>(hsh_pair_count(options.K)),
                         static_cast<Eigen::Index>(ball.shells()));
  const double edge = 2.0 / ball.side;  // of a voxel, in units of ρ
  for (std::size_t s = 0; s < ball.shells(); ++s) {
    const double rho = ball.shell_rho[s];
    const double theta0 = hsh_angle(options.map, options.stretch, std::min(1.0, rho));
    auto column = radial.col(static_cast<Eigen::Index>(s));
    gegenbauer.evaluate(std::cos(theta0), std::sin(theta0), column.data());
    column *=
        edge * edge * edge *
        detail::mean_density(options.map, options.stretch, rho - 0.5 * edge, rho + 0.5 * edge);
    if (options.map != SphereMap::two_sided) continue;
    for (int lambda = 0; lambda <= options.K; ++lambda) {
      for (int l = 0; l <= lambda; ++l) {  // the lower half, θ0 → π − θ0
        column[static_cast<Eigen::Index>(hsh_pair_index(lambda, l))] *=
            (lambda - l) % 2 == 0 ? 2.0 : 0.0;
      }
    }
  }
  return radial;
}

}  // namespace

struct HshTransform::Plan {
  Plan(const HshOptions& wanted, int voxel_side) : options(wanted), side(voxel_side) {
    detail::check_options(options);
    detail::check_side(side);
    detail::check_bandwidth(options.K, side);
    if (options.quadrature == Quadrature::voxels) {
      ball = std::make_unique<detail::BallVoxels>(side);
      legendre = std::make_unique<Legendre>(options.K);
      radial = weighted_radial(options, *ball);
      return;
    }
    if (options.grid == 0) {
      options.grid = options.quadrature == Quadrature::svd
                         ? std::max(kDissertationGrid, 2 * options.K + 2)
                         : std::max(options.K + 1, side / 2);
    }
    sampling = std::make_unique<HshSampling>(options.K, options.quadrature, options.grid);
    nodes.resize(sampling->size(), 3);
    for (Eigen::Index i = 0; i < sampling->size(); ++i) {
      const Eigen::Vector3d angles = sampling->node(i);
      const double rho = detail::ball_radius(options.map, options.stretch, angles[0]);
      nodes.row(i) << rho * std::sin(angles[1]) * std::cos(angles[2]),
          rho * std::sin(angles[1]) * std::sin(angles[2]), rho * std::cos(angles[1]);
    }
  }

  HshOptions options;
  int side;
  std::unique_ptr<detail::BallVoxels> ball;  // Quadrature::voxels
  std::unique_ptr<Legendre> legendre;
  Eigen::MatrixXd radial;
  std::unique_ptr<HshSampling> sampling;  // the others
  Points nodes;                           // in the frame
};

HshTransform::HshTransform(const HshOptions& options, int side)
    : plan_(std::make_unique<const Plan>(options, side)) {}
HshTransform::~HshTransform() = default;
HshTransform::HshTransform(HshTransform&&) noexcept = default;
HshTransform& HshTransform::operator=(HshTransform&&) noexcept = default;

const HshOptions& HshTransform::options() const { return plan_->options; }
int HshTransform::side() const { return plan_->side; }

HshCoefficients HshTransform::operator()(const Voxels& voxels, int threads) const {
  const Plan& plan = *plan_;
  detail::check_voxels(voxels, plan.side);
  threads = detail::resolve_threads(threads);
  HshCoefficients result;
  result.K = plan.options.K;
  result.map = plan.options.map;
  result.stretch = plan.options.stretch;
  if (plan.ball != nullptr) {
    detail::ShellSums sums = detail::shell_sums(*plan.ball, *plan.legendre, voxels, threads);
    const auto pairs = static_cast<Eigen::Index>(Legendre::count(plan.options.K));
    sums.rightCols(pairs) *= -1.0;  // conj Y
    // Row by row in memory: its transpose is column by column.
    const Eigen::Map<const Eigen::MatrixXd> spheres(sums.data(), sums.cols(), sums.rows());
    result.values = detail::radial_transform(plan.options.K, plan.radial, spheres);
    return result;
  }
  Eigen::VectorXd values(plan.nodes.rows());
  detail::parallel_blocks(values.size(), 4096, threads, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last; ++i) {
      const Eigen::Vector3d point = plan.nodes.row(i).transpose();
      values[i] = point.squaredNorm() <= 1.0 + 1e-12 ? detail::trilinear(voxels, point) : 0.0;
    }
  });
  result.values = plan.sampling->coefficients(values);
  return result;
}

}  // namespace shape3d::descriptors
