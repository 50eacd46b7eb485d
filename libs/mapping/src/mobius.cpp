#include "mobius.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "triangle.hpp"

namespace shape3d::mapping {
namespace {

double busemann(const PlanePoints& z, const Eigen::VectorXd& weights, Complex centre,
                double scale) {
  double sum = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double r = std::abs(z[i] - centre);
    sum += weights[static_cast<Eigen::Index>(i)] * std::log(r * (r / scale) + scale);
  }
  return sum;
}

/// Weighted medians: a start amid the points, whatever their scale.
Similarity middle(const PlanePoints& z, const Eigen::VectorXd& weights) {
  const auto median = [&](auto&& value) {
    std::vector<std::pair<double, double>> sorted(z.size());
    double total = 0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      sorted[i] = {value(z[i]), weights[static_cast<Eigen::Index>(i)]};
      total += sorted[i].second;
    }
    std::sort(sorted.begin(), sorted.end());
    double sum = 0;
    for (const auto& [v, w] : sorted) {
      sum += w;
      if (2 * sum >= total) return v;
    }
    return sorted.back().first;
  };
  Similarity result;
  result.centre = {median([](Complex p) { return p.real(); }),
                   median([](Complex p) { return p.imag(); })};
  result.scale = median([&](Complex p) { return std::abs(p - result.centre); });
  if (!(result.scale > 0)) {
    for (const Complex p : z) result.scale = std::max(result.scale, std::abs(p - result.centre));
  }
  return result;
}

/// Moves along the geodesic of H³ that starts in the ball's direction d, by the length |d|.
Similarity moved(const Similarity& from, const Eigen::Vector3d& d) {
  const double length = d.norm();
  if (!(length > 0)) return from;
  const Eigen::Vector3d x = d * (std::tanh(0.5 * length) / length);
  const Eigen::Vector3d north(0, 0, 1);
  // Inversion at the north pole takes the ball to the half-space below the plane.
  const Eigen::Vector3d y = north + 2 * (x - north) / (x - north).squaredNorm();
  Similarity to = from;
  to.centre += from.scale * Complex(y.x(), y.y());
  to.scale *= -y.z();
  return to;
}

}  // namespace

Eigen::Vector3d to_sphere(Complex z) {
  const double r2 = std::norm(z);
  if (!(r2 < 1e300)) return {0, 0, 1};
  return Eigen::Vector3d(2 * z.real(), 2 * z.imag(), r2 - 1) / (1 + r2);
}

Complex to_plane(const Eigen::Vector3d& p) {
  if (p.z() <= 0) return Complex(p.x(), p.y()) / (1 - p.z());
  // 1 − z without cancellation.
  const double r2 = p.x() * p.x() + p.y() * p.y();
  return Complex(p.x(), p.y()) * ((1 + p.z()) / std::max(r2, 1e-300));
}

Similarity conformal_barycentre(const PlanePoints& z, const Eigen::VectorXd& weights) {
  const Eigen::VectorXd w = weights / weights.sum();
  Similarity current = middle(z, w);
  double value = busemann(z, w, current.centre, current.scale);
  for (int iteration = 0; iteration < 100; ++iteration) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Identity();
    for (std::size_t i = 0; i < z.size(); ++i) {
      const Eigen::Vector3d p = to_sphere((z[i] - current.centre) / current.scale);
      mean += w[static_cast<Eigen::Index>(i)] * p;
      hessian.noalias() -= w[static_cast<Eigen::Index>(i)] * p * p.transpose();
    }
    if (mean.norm() < 1e-12) {
      current.converged = true;
      break;
    }
    Eigen::Vector3d step = hessian.ldlt().solve(mean);
    if (!(step.norm() < 4)) step = mean * (4 / mean.norm());
    Similarity trial = moved(current, step);
    double trial_value = busemann(z, w, trial.centre, trial.scale);
    // Near the minimum the values agree to rounding and Newton's step is taken as it is.
    while (!(trial_value <= value + 1e-14 * std::abs(value)) && step.norm() > 1e-14) {
      step *= 0.5;
      trial = moved(current, step);
      trial_value = busemann(z, w, trial.centre, trial.scale);
    }
    current = trial;
    value = trial_value;
  }
  return current;
}

Eigen::Matrix3d closest_rotation(const ConstPoints& S, const ConstPoints& P,
                                 const Eigen::VectorXd& weights) {
  const Eigen::Matrix3d correlation = P.transpose() * weights.asDiagonal() * S;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1, 1, 1);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign.z() = -1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace shape3d::mapping
