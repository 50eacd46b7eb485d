#include "shape3d/descriptors/csm.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

#include "ball_voxels.hpp"
#include "interpolate.hpp"
#include "parallel.hpp"
#include "shell_harmonics.hpp"
#include "sphere_grid.hpp"
#include "text.hpp"
#include "voxel_check.hpp"

namespace shape3d::descriptors {
namespace {

constexpr double kPi = 3.14159265358979323846;

// ‖f_l‖ of real functions from the coefficients of m ≥ 0, real parts then imaginary parts.
double norm_of_degree(const double* coefficients, std::size_t pairs, int l) {
  double sum = 0.0;
  for (int m = 0; m <= l; ++m) {
    const std::size_t place = Legendre::index(l, m);
    const double re = coefficients[place], im = coefficients[pairs + place];
    sum += (m == 0 ? 1.0 : 2.0) * (re * re + im * im);
  }
  return std::sqrt(sum);
}

// f_0 + f_2 as a quadratic form x'Ax on the sphere: the eigenvalues of A, descending, in the basis
// in which their distance is the distance of two such functions on the sphere with common axes.
//   f_0 = C00 / √4π, and with Y_2^m the entries of A are combinations of the five C_2^m.
Eigen::Vector3d quadratic_form(const double* c, std::size_t pairs) {
  const double f0 = c[0] / std::sqrt(4.0 * kPi);
  const auto re = [&](int m) { return c[Legendre::index(2, m)]; };
  const auto im = [&](int m) { return c[pairs + Legendre::index(2, m)]; };
  const double a0 = std::sqrt(5.0 / (16.0 * kPi)) * re(0);
  // f_2 = a0 (3z² − 1) + 2 Re(C21 Y21) + 2 Re(C22 Y22), Y21 = −√(15/8π) xz…, Y22 =
  // √(15/32π)(x+iy)².
  const double a1 = -2.0 * std::sqrt(15.0 / (8.0 * kPi));
  const double a2 = 2.0 * std::sqrt(15.0 / (32.0 * kPi));
  Eigen::Matrix3d A;
  A(0, 0) = f0 - a0 + a2 * re(2);
  A(1, 1) = f0 - a0 - a2 * re(2);
  A(2, 2) = f0 + 2.0 * a0;
  A(0, 1) = A(1, 0) = -a2 * im(2);
  A(0, 2) = A(2, 0) = 0.5 * a1 * re(1);
  A(1, 2) = A(2, 1) = -0.5 * a1 * im(1);
  const Eigen::Vector3d eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(A, Eigen::EigenvaluesOnly)
          .eigenvalues()
          .reverse();
  // ∫ (Σ e_i x_i²)² dΩ = 4π/15 (2 Σ e_i² + (Σ e_i)²) = |s e + t (Σ e_i) 1|² with these s, t.
  const double s = std::sqrt(8.0 * kPi / 15.0);
  const double t = (std::sqrt(4.0 * kPi / 3.0) - s) / 3.0;
  return s * eigenvalues + Eigen::Vector3d::Constant(t * eigenvalues.sum());
}

}  // namespace

Eigen::Index csm_length(const CsmOptions& options) {
  const bool refined = options.variant == CsmVariant::kazhdan && options.K >= 2;
  return static_cast<Eigen::Index>(options.R) * (options.K + (refined ? 2 : 1));
}

struct ConcentricSpheres::Plan {
  Plan(const CsmOptions& wanted, int voxel_side)
      : options(wanted), side(voxel_side), legendre((check(wanted, voxel_side), wanted.K)) {
    if (options.variant == CsmVariant::shells) {
      ball = std::make_unique<detail::BallVoxels>(side);
      weigh_shells();
    } else {
      // Fine enough for the voxels at the outermost sphere, of πside/2 voxels from pole to pole.
      const int rows = std::max(options.K + 1, side / 2);
      sphere = std::make_unique<detail::SphereGrid>(options.K, rows, 2 * rows);
    }
  }

  static void check(const CsmOptions& options, int side) {
    detail::check_side(side);
    detail::require_between("R", options.R, 1, side / 2);
    detail::check_bandwidth(options.K, side);
  }

  // A voxel belongs to the shells that its radius ± half an edge overlaps, by the parts.
  void weigh_shells() {
    weights = Eigen::MatrixXd::Zero(options.R, static_cast<Eigen::Index>(ball->shells()));
    Eigen::VectorXd total = Eigen::VectorXd::Zero(options.R);
    const double thickness = 0.5 * side / options.R;  // voxel edges
    for (std::size_t s = 0; s < ball->shells(); ++s) {
      const double radius = 0.5 * side * ball->shell_rho[s];
      double share = 0.0;
      for (std::size_t v = ball->shell_begin[s]; v < ball->shell_begin[s + 1]; ++v) {
        share += 8.0 * ball->share[v];
      }
      for (int r = 0; r < options.R; ++r) {
        const double low = std::max(radius - 0.5, thickness * r);
        const double high = std::min(radius + 0.5, thickness * (r + 1));
        double overlap = std::max(0.0, high - low);
        if (r + 1 == options.R) overlap += std::max(0.0, radius + 0.5 - thickness * (r + 1));
        weights(r, static_cast<Eigen::Index>(s)) = overlap;
        total[r] += overlap * share;
      }
    }
    for (int r = 0; r < options.R; ++r) {
      weights.row(r) *= 4.0 * kPi / total[r] * (options.weighted ? (r + 0.5) / options.R : 1.0);
    }
  }

  CsmOptions options;
  int side;
  Legendre legendre;
  std::unique_ptr<detail::BallVoxels> ball;    // shells
  Eigen::MatrixXd weights;                     // R by shells of equal radius
  std::unique_ptr<detail::SphereGrid> sphere;  // kazhdan
};

ConcentricSpheres::ConcentricSpheres(const CsmOptions& options, int side)
    : plan_(std::make_unique<const Plan>(options, side)) {}
ConcentricSpheres::~ConcentricSpheres() = default;
ConcentricSpheres::ConcentricSpheres(ConcentricSpheres&&) noexcept = default;
ConcentricSpheres& ConcentricSpheres::operator=(ConcentricSpheres&&) noexcept = default;

Eigen::VectorXd ConcentricSpheres::operator()(const Voxels& voxels, int threads) const {
  const Plan& plan = *plan_;
  detail::check_voxels(voxels, plan.side);
  threads = detail::resolve_threads(threads);
  const int R = plan.options.R, K = plan.options.K;
  const std::size_t pairs = Legendre::count(K);
  Eigen::VectorXd result(csm_length(plan.options));
  const Eigen::Index numbers = result.size() / R;
  if (plan.ball != nullptr) {
    const detail::ShellSums sums = detail::shell_sums(*plan.ball, plan.legendre, voxels, threads);
    const detail::ShellSums spheres = plan.weights * sums;
    for (int r = 0; r < R; ++r) {
      for (int l = 0; l <= K; ++l) {
        result[r * numbers + l] = norm_of_degree(spheres.row(r).data(), pairs, l);
      }
    }
    return result;
  }
  detail::parallel_blocks(R, 1, threads, [&](std::int64_t r, std::int64_t) {
    const double radius = (static_cast<double>(r) + 0.5) / R;
    Eigen::MatrixXd samples(plan.sphere->rows(), plan.sphere->columns());
    for (int i = 0; i < plan.sphere->rows(); ++i) {
      for (int j = 0; j < plan.sphere->columns(); ++j) {
        samples(i, j) = radius * detail::trilinear(voxels, radius * plan.sphere->direction(i, j));
      }
    }
    std::vector<double> coefficients(2 * pairs);
    plan.sphere->transform(samples, coefficients.data());
    double* out = result.data() + r * numbers;
    if (K >= 2) {
      const Eigen::Vector3d form = quadratic_form(coefficients.data(), pairs);
      out = std::copy(form.data(), form.data() + 3, out);
    }
    for (int l = 0; l <= K; ++l) {
      if (K >= 2 && (l == 0 || l == 2)) continue;
      *out++ = norm_of_degree(coefficients.data(), pairs, l);
    }
  });
  return result;
}

}  // namespace shape3d::descriptors
