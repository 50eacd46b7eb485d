#include "hoppe_energy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "edge_list.hpp"
#include "point_triangle.hpp"

namespace shape3d::mapping::detail {
namespace {

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

}  // namespace

HoppeEnergy::HoppeEnergy(std::vector<Eigen::Vector3d> P, const ConstTriangles& F,
                         const HoppeOptions& options)
    : options_(options), P_(std::move(P)), face_samples_(index(F.rows())), sharp_(P_.size()) {
  Eigen::Vector3d lower = P_.front(), upper = lower;
  for (const Eigen::Vector3d& p : P_) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
    samples_.push_back({p, 0.0, 0.0});
  }
  inverse_square_ = 1.0 / (upper - lower).squaredNorm();
  attributes_ = options_.attributes.transpose();
  wanted_ = attributes_;
  options_.attributes.resize(0, 0);

  std::vector<Eigen::Vector3d> normals;
  std::vector<bool> placed(P_.size(), false);
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::Vector3d& a = P_[index(F(t, 0))];
    const Eigen::Vector3d normal = (P_[index(F(t, 1))] - a).cross(P_[index(F(t, 2))] - a);
    normals.push_back(normal.stableNormalized());
    // Each vertex is a sample in a triangle that has an area, which no edge of length 0 removes.
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (placed[index(F(t, i))] || normal.isZero(0.0)) continue;
      placed[index(F(t, i))] = true;
      face_samples_[index(t)].push_back(F(t, i));
    }
  }
  const double sharp_cosine = std::cos(options_.sharp_angle);
  const std::vector<bool> all(index(F.rows()), true);
  const auto edges = edge_list(F, all, static_cast<Eigen::Index>(P_.size()));
  for_each_edge(edges, [&](const EdgeUse* begin, const EdgeUse* end) {
    const bool sharp = end - begin == 1 || normals[index(begin[0].triangle)].dot(
                                               normals[index(begin[1].triangle)]) < sharp_cosine;
    if (sharp) sharp_.add(begin->low, begin->high, P_);
  });
}

HoppeEnergy::Landing HoppeEnergy::land(const Eigen::Vector3d& p, const EdgeStar& star,
                                       const Eigen::Vector3d& x) const {
  Landing best;
  best.squared_distance = std::numeric_limits<double>::max();
  for (std::size_t t = 0; t < star.corners.size(); ++t) {
    std::array<Eigen::Vector3d, 3> q;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t v = star.corners[t][i];
      q[i] = moves(star, v) ? x : P_[index(v)];
    }
    const Foot foot = nearest_on_triangle(p, q[0], q[1], q[2]);
    if (foot.squared_distance < best.squared_distance)
      best = {t, foot.weights, foot.squared_distance};
  }
  return best;
}

std::vector<std::int32_t> HoppeEnergy::samples_of(const EdgeStar& star) const {
  std::vector<std::int32_t> samples;
  for (const auto* faces : {&star.faces, &star.removed}) {
    for (const std::int32_t f : *faces)
      samples.insert(samples.end(), face_samples_[index(f)].begin(), face_samples_[index(f)].end());
  }
  return samples;
}

std::vector<std::int32_t> HoppeEnergy::ring_of(const EdgeStar& star) const {
  std::vector<std::int32_t> ring;
  for (const auto& corners : star.corners)
    for (const std::int32_t v : corners)
      if (!moves(star, v)) ring.push_back(v);
  for (const std::int32_t v : {star.left, star.right})
    if (v >= 0) ring.push_back(v);
  std::sort(ring.begin(), ring.end());
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  return ring;
}

double HoppeEnergy::spring(const EdgeStar& star, std::size_t samples) const {
  const double ratio =
      static_cast<double>(samples) / static_cast<double>(star.faces.size() + star.removed.size());
  return options_.spring_weight * (ratio < 4.0 ? 1.0 : ratio < 8.0 ? 1e-2 : 1e-6);
}

double HoppeEnergy::length_change(const EdgeStar& star, const std::vector<std::int32_t>& ring,
                                  const Eigen::Vector3d& x) const {
  double sum = -(P_[index(star.v0)] - P_[index(star.v1)]).squaredNorm();
  for (const std::int32_t v : ring) sum += (x - P_[index(v)]).squaredNorm();
  const auto subtract = [&](std::int32_t from, std::int32_t to) {
    sum -= (P_[index(from)] - P_[index(to)]).squaredNorm();
  };
  // The edges that there are: each is a side of two triangles, or of one at the boundary, so that
  // the ends are collected first.
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (const auto& corners : star.corners) {
    for (const std::int32_t v : corners) {
      if (!moves(star, v)) continue;
      for (const std::int32_t w : corners)
        if (w != v) edges.emplace_back(v, w);
    }
  }
  for (const std::int32_t apex : {star.left, star.right}) {
    if (apex < 0) continue;
    edges.emplace_back(star.v0, apex);
    edges.emplace_back(star.v1, apex);
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const auto& [from, to] : edges) subtract(from, to);
  return sum;
}

std::pair<Eigen::VectorXd, double> HoppeEnergy::best_attributes(
    const EdgeStar& star, const std::vector<std::int32_t>& samples,
    const std::vector<Landing>& landings) const {
  Eigen::VectorXd value = 0.5 * (attributes_.col(star.v0) + attributes_.col(star.v1));
  Eigen::MatrixXd rest(attributes_.rows(), static_cast<Eigen::Index>(samples.size()));
  Eigen::VectorXd share(static_cast<Eigen::Index>(samples.size()));
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const auto column = static_cast<Eigen::Index>(s);
    rest.col(column) = wanted_.col(samples[s]);
    share[column] = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t v = star.corners[landings[s].triangle][i];
      const double weight = landings[s].weights[static_cast<Eigen::Index>(i)];
      if (moves(star, v)) {
        share[column] += weight;
      } else {
        rest.col(column) -= weight * attributes_.col(v);
      }
    }
  }
  const double total = share.squaredNorm();
  if (total > 0.0) value = rest * share / total;
  return {value, (rest - value * share.transpose()).squaredNorm()};
}

std::vector<HoppeEnergy::Landing> HoppeEnergy::land_all(const std::vector<std::int32_t>& samples,
                                                        const EdgeStar& star,
                                                        const Eigen::Vector3d& x) const {
  std::vector<Landing> landings;
  landings.reserve(samples.size());
  for (const std::int32_t s : samples)
    landings.push_back(land(samples_[index(s)].position, star, x));
  return landings;
}

// Least squares with fixed feet: Σ (b x + rest − p)² over samples, κ Σ (x − q)² over the ring.
Eigen::Vector3d HoppeEnergy::best_position(const EdgeStar& star, const Around& around,
                                           const std::vector<Landing>& landings,
                                           const Eigen::Vector3d& start) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0.0;
  for (std::size_t s = 0; s < around.samples.size(); ++s) {
    Eigen::Vector3d rest = samples_[index(around.samples[s])].position;
    double b = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t v = star.corners[landings[s].triangle][i];
      const double weight = landings[s].weights[static_cast<Eigen::Index>(i)];
      if (moves(star, v)) {
        b += weight;
      } else {
        rest -= weight * P_[index(v)];
      }
    }
    sum += options_.distance_weight * b * rest;
    weights += options_.distance_weight * b * b;
  }
  for (const std::int32_t v : around.ring) {
    sum += around.kappa * P_[index(v)];
    weights += around.kappa;
  }
  return weights > 0.0 ? Eigen::Vector3d(sum / weights) : start;
}

double HoppeEnergy::change(const EdgeStar& star, const Around& around,
                           const std::vector<Landing>& landings, const Eigen::Vector3d& x) const {
  double distance = 0.0, scalar = 0.0;
  for (std::size_t s = 0; s < around.samples.size(); ++s) {
    const Sample& sample = samples_[index(around.samples[s])];
    distance += landings[s].squared_distance - sample.squared_distance;
    scalar -= sample.scalar_error;
  }
  if (attributes_.size() > 0) scalar += best_attributes(star, around.samples, landings).second;
  return inverse_square_ *
             (options_.distance_weight * distance +
              around.kappa * length_change(star, around.ring, x) +
              options_.discontinuity_weight * sharp_.change(star.v0, star.v1, x, P_)) +
         options_.scalar_weight * scalar;
}

std::optional<HoppeEnergy::Choice> HoppeEnergy::evaluate(const EdgeStar& star) const {
  if (star.corners.empty()) return std::nullopt;
  const SharpEdges::Rule rule = sharp_.rule(star.v0, star.v1, star.left, star.right);
  if (rule == SharpEdges::Rule::forbidden) return std::nullopt;
  Around around{samples_of(star), ring_of(star), 0.0};
  around.kappa = spring(star, around.samples.size());
  const Eigen::Vector3d &p0 = P_[index(star.v0)], &p1 = P_[index(star.v1)];
  const Eigen::Vector3d middle = 0.5 * (p0 + p1);
  if (rule == SharpEdges::Rule::free && sharp_.degree(star.v0) == 0) {
    const auto feet = land_all(around.samples, star, middle);
    const Eigen::Vector3d x = best_position(star, around, feet, middle);
    return Choice{x, change(star, around, land_all(around.samples, star, x), x)};
  }
  // On a curve of sharp edges: where it is allowed, the best of both ends and the middle.
  std::optional<Choice> best;
  for (const Eigen::Vector3d& x : {p0, middle, p1}) {
    if (rule == SharpEdges::Rule::stay_at_v0 && x != p0) continue;
    if (rule == SharpEdges::Rule::stay_at_v1 && x != p1) continue;
    const double cost = change(star, around, land_all(around.samples, star, x), x);
    if (!best || cost < best->cost) best = Choice{x, cost};
  }
  return best;
}

void HoppeEnergy::collapse(const EdgeStar& star, std::int32_t removed, std::int32_t kept,
                           const Eigen::Vector3d& position) {
  const std::vector<std::int32_t> samples = samples_of(star);
  for (const auto* faces : {&star.faces, &star.removed})
    for (const std::int32_t f : *faces) face_samples_[index(f)].clear();
  std::vector<Landing> landings;
  for (const std::int32_t s : samples) {
    Sample& sample = samples_[index(s)];
    landings.push_back(land(sample.position, star, position));
    sample.squared_distance = landings.back().squared_distance;
    face_samples_[index(star.faces[landings.back().triangle])].push_back(s);
  }
  if (attributes_.size() > 0) {
    attributes_.col(kept) = best_attributes(star, samples, landings).first;
    for (std::size_t s = 0; s < samples.size(); ++s) {
      Eigen::VectorXd difference = wanted_.col(samples[s]);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t v = star.corners[landings[s].triangle][i];
        difference -= landings[s].weights[static_cast<Eigen::Index>(i)] *
                      attributes_.col(moves(star, v) ? kept : v);
      }
      samples_[index(samples[s])].scalar_error = difference.squaredNorm();
    }
  }
  P_[index(kept)] = position;
  sharp_.collapse(removed, kept, P_);
}

std::array<double, 3> HoppeEnergy::terms() const {
  double distance = 0.0, scalar = 0.0;
  for (const Sample& sample : samples_) {
    distance += sample.squared_distance;
    scalar += sample.scalar_error;
  }
  return {options_.distance_weight * inverse_square_ * distance, options_.scalar_weight * scalar,
          options_.discontinuity_weight * inverse_square_ * sharp_.energy()};
}

}  // namespace shape3d::mapping::detail
