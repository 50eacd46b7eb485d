#include "support/lung_anatomy.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

namespace shape3d::test {
namespace {

// The difficulty: what thresholding loses are the ends of the trees.
constexpr double kTrees = 90e-6;                // a sample of lung
constexpr double kRoot = 3.0, kThinnest = 0.6;  // radii
constexpr double kLengthFactor = 5.5;           // radii

Eigen::Vector3d random_direction(RandomNumbers& random) {
  const Eigen::Vector3d v(random.normal(), random.normal(), random.normal());
  return v.normalized();
}

// A direction at an angle to another, turned about it at random.
Eigen::Vector3d deviate(const Eigen::Vector3d& direction, double angle, RandomNumbers& random) {
  const Eigen::Vector3d across = direction.cross(random_direction(random)).normalized();
  return (std::cos(angle) * direction + std::sin(angle) * across).normalized();
}

double depth_in(const Eigen::Vector3d& offset, const Eigen::Vector3d& axes) {
  const Eigen::Array3d u = (offset.array() / axes.array()).abs();
  const double value = std::cbrt((u * u * u).sum());
  if (value < 0.1) return 0.9 * axes.minCoeff();
  // f = (Σ u³)^⅓ has the gradient u²/(f² a).
  const double slope = (u * u / axes.array()).matrix().norm() / (value * value);
  return (1.0 - value) / slope;
}

double distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                           const Eigen::Vector3d& b) {
  const Eigen::Vector3d axis = b - a;
  const double t = std::clamp((p - a).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
  return (p - a - t * axis).norm();
}

}  // namespace

LungAnatomy::LungAnatomy(const std::array<std::int64_t, 3>& dims, RandomNumbers& random)
    : dims_(static_cast<double>(dims[0]), static_cast<double>(dims[1]),
            static_cast<double>(dims[2])) {
  const Eigen::Vector3d axes = dims_.cwiseProduct(Eigen::Vector3d(0.21, 0.43, 1.3));
  lungs_[0] = {dims_.cwiseProduct(Eigen::Vector3d(0.255, 0.5, 0.5)), axes};
  lungs_[1] = {dims_.cwiseProduct(Eigen::Vector3d(0.745, 0.5, 0.5)), axes};
  place_nodules(random);
  grow_trees(random);
}

double LungAnatomy::depth_in_lung(const Eigen::Vector3d& p) const {
  return std::max(depth_in(p - lungs_[0].centre, lungs_[0].axes),
                  depth_in(p - lungs_[1].centre, lungs_[1].axes));
}

void LungAnatomy::place_nodules(RandomNumbers& random) {
  const int each = dims_.prod() >= 1e6 ? 2 : 1;
  const double scale = std::min({1.0, dims_[0] / 120.0, dims_[1] / 120.0, dims_[2] / 40.0});
  for (int n = 0; n < each; ++n) {
    for (const NoduleKind kind : {NoduleKind::isolated, NoduleKind::on_vessel,
                                  NoduleKind::at_pleura, NoduleKind::ground_glass}) {
      const double radius = scale * random.uniform(5.0, 7.0);
      double gap = 12.0;
      while (gap > 0.5 && !place_nodule(kind, radius, gap, random)) gap /= 1.5;
      if (gap <= 0.5)
        throw std::invalid_argument("dims leave no room for nodule " +
                                    std::to_string(nodules_.size()));
    }
  }
}

bool LungAnatomy::place_nodule(NoduleKind kind, double radius, double gap, RandomNumbers& random) {
  for (int attempt = 0; attempt < 2000; ++attempt) {
    Eigen::Vector3d p =
        dims_.cwiseProduct(Eigen::Vector3d(random.uniform(), random.uniform(), random.uniform()));
    if (p.z() < radius + 2.0 || p.z() > dims_.z() - 3.0 - radius) continue;
    if (kind == NoduleKind::at_pleura) {
      // Along the first-order distance until half a radius lies between the centre and the wall.
      const Eigen::Vector3d centre = p.x() < dims_.x() / 2 ? lungs_[0].centre : lungs_[1].centre;
      Eigen::Vector3d outwards = p - centre;
      outwards.z() = 0.0;
      outwards.normalize();
      if (!(depth_in_lung(p) > radius)) continue;
      for (int step = 0; step < 2000 && depth_in_lung(p) > 0.5 * radius; ++step)
        p += 0.1 * outwards;
    } else if (depth_in_lung(p) < radius + gap) {
      continue;
    }
    const bool apart =
        std::all_of(nodules_.begin(), nodules_.end(), [&](const AnatomicNodule& other) {
          return (other.centre - p).norm() > other.radius + radius + 2 * gap;
        });
    if (!apart) continue;
    if (kind == NoduleKind::on_vessel) {
      const double thickness = 0.3 * radius;
      Eigen::Vector3d along = random_direction(random);
      along.z() *= 0.3;
      along = along.normalized() * (radius + std::min(12.0, gap));
      const bool clear =
          std::all_of(nodules_.begin(), nodules_.end(), [&](const AnatomicNodule& other) {
            return distance_to_segment(other.centre, p - along, p + along) >
                   other.radius + thickness + 4.0;
          });
      if (!clear) continue;
      vessels_.push_back({p - along, p + along, thickness, thickness});
    }
    nodules_.push_back({kind, p, radius});
    return true;
  }
  return false;
}

bool LungAnatomy::free_for_vessel(const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                                  double radius) const {
  if (depth_in_lung(end) < radius + 2.0) return false;
  if (end.z() < -4.0 || end.z() > dims_.z() + 4.0) return false;
  return std::all_of(nodules_.begin(), nodules_.end(), [&](const AnatomicNodule& nodule) {
    return distance_to_segment(nodule.centre, start, end) > nodule.radius + radius + 4.0;
  });
}

void LungAnatomy::grow_trees(RandomNumbers& random) {
  for (const Lung& lung : lungs_) {
    const double volume = 0.88 * 4 * lung.axes.x() * lung.axes.y() * dims_.z();
    const int trees = std::max(1, static_cast<int>(std::lround(kTrees * volume)));
    const double side = lung.centre.x() < dims_.x() / 2 ? 1.0 : -1.0;
    for (int tree = 0; tree < trees; ++tree) {
      const Eigen::Vector3d root =
          lung.centre + Eigen::Vector3d(side * 0.8 * lung.axes.x(),
                                        random.uniform(-0.4, 0.4) * lung.axes.y(),
                                        random.uniform(-0.4, 0.4) * dims_.z());
      Eigen::Vector3d direction(-side, random.uniform(-1.0, 1.0), random.uniform(-0.3, 0.3));
      grow(root, direction.normalized(), kRoot * random.uniform(0.8, 1.1), random);
    }
  }
}

void LungAnatomy::grow(const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                       double radius, RandomNumbers& random) {
  if (radius < kThinnest) return;
  const double length = kLengthFactor * radius * random.uniform(0.8, 1.3);
  for (int attempt = 0; attempt < 8; ++attempt) {
    const Eigen::Vector3d way = deviate(direction, 0.12 * attempt, random);
    const Eigen::Vector3d end = start + length * way;
    if (!free_for_vessel(start, end, radius)) continue;
    vessels_.push_back({start, end, radius, 0.95 * radius});
    const double share = random.uniform(0.2, 0.5), thick = 0.95 * radius;
    grow(end, deviate(way, random.uniform(0.2, 0.5), random), thick * std::cbrt(1.0 - share),
         random);
    grow(end, deviate(way, random.uniform(0.6, 1.1), random), thick * std::cbrt(share), random);
    return;
  }
}

}  // namespace shape3d::test
