#include "untangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <Eigen/SparseCholesky>

#include "rest_shape.hpp"
#include "triangle.hpp"

namespace shape3d::mapping {
namespace {

bool positive(const ConstTriangles& F, const Points& S, std::int64_t t) {
  return orientation_determinant(row(S, F(t, 0)), row(S, F(t, 1)), row(S, F(t, 2))) >
         kSmallestDeterminant;
}

/// Triangles stretched more than this get their surroundings relaxed: they hinder later steps.
constexpr double kStretched = 4;

/// σ1 / σ2 of the map of a triangle exceeds kStretched: (σ1² + σ2²) / (σ1 σ2) > r + 1 / r.
bool stretched(const ConstPoints& V, const ConstTriangles& F, const Points& S, std::int64_t t) {
  const RestShape shape = rest_shape(row(V, F(t, 0)), row(V, F(t, 1)), row(V, F(t, 2)));
  const Eigen::Vector3d e = row(S, F(t, 1)) - row(S, F(t, 0));
  const Eigen::Vector3d g = row(S, F(t, 2)) - row(S, F(t, 0));
  const Eigen::Vector3d Ju = shape.du[1] * e + shape.du[2] * g;
  const Eigen::Vector3d Jv = shape.dv[1] * e + shape.dv[2] * g;
  return Ju.squaredNorm() + Jv.squaredNorm() > (kStretched + 1 / kStretched) * Ju.cross(Jv).norm();
}

/// A patch in the plane: inner vertices come first and may move.
struct Patch {
  std::vector<std::int32_t> vertices;
  std::int64_t inner = 0;
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< By place in `vertices`.
  std::vector<RestShape> shapes;
  Eigen::Matrix2Xd x;  ///< Positions.
};

/// Σ A |conformal part|² / χ over the patch, its gradient and its Gauss–Newton matrix.
class PatchEnergy {
 public:
  explicit PatchEnergy(const Patch& patch) : patch_(patch) {}

  [[nodiscard]] double smallest_determinant(const Eigen::Matrix2Xd& x) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < patch_.triangles.size(); ++t) {
      least = std::min(least, jacobian(x, t).determinant());
    }
    return least;
  }

  [[nodiscard]] double value(const Eigen::Matrix2Xd& x, double epsilon) const {
    double sum = 0;
    for (std::size_t t = 0; t < patch_.triangles.size(); ++t) {
      const Eigen::Matrix2d J = jacobian(x, t);
      const double determinant = J.determinant();
      const double chi = 0.5 * (determinant + std::hypot(determinant, epsilon));
      const double p = J(0, 0) - J(1, 1), q = J(0, 1) + J(1, 0);
      sum += patch_.shapes[t].area * (p * p + q * q) / std::max(chi, 1e-300);
    }
    return sum;
  }

  void linearise(const Eigen::Matrix2Xd& x, double epsilon, Eigen::SparseMatrix<double>& matrix,
                 Eigen::VectorXd& gradient) const {
    std::vector<Eigen::Triplet<double>> entries;
    gradient = Eigen::VectorXd::Zero(2 * patch_.inner);
    for (std::size_t t = 0; t < patch_.triangles.size(); ++t) {
      const RestShape& shape = patch_.shapes[t];
      const Eigen::Matrix2d J = jacobian(x, t);
      const double determinant = J.determinant(), root = std::hypot(determinant, epsilon);
      const double chi = std::max(0.5 * (determinant + root), 1e-300);
      const double chi_slope = 0.5 * (1 + determinant / std::max(root, 1e-300));
      const Eigen::Vector2d q(J(0, 0) - J(1, 1), J(0, 1) + J(1, 0));
      const double scale = std::sqrt(shape.area / chi);
      const Eigen::Vector2d residual = scale * q;
      Eigen::Matrix<double, 2, 6> D;
      for (int k = 0; k < 3; ++k) {
        const double a = shape.du[k], b = shape.dv[k];
        // J = Σ x_k (a, b): its determinant's gradient is (a J11 − b J10, b J00 − a J01).
        const Eigen::Vector2d slope(a * J(1, 1) - b * J(1, 0), b * J(0, 0) - a * J(0, 1));
        D.block<2, 2>(0, 2 * k) << a, -b, b, a;
        D.block<2, 2>(0, 2 * k) *= scale;
        D.block<2, 2>(0, 2 * k) -= (0.5 * chi_slope / chi) * residual * slope.transpose();
      }
      const Eigen::Matrix<double, 6, 6> H = D.transpose() * D;
      const Eigen::Matrix<double, 6, 1> g = D.transpose() * residual;
      for (int k = 0; k < 3; ++k) {
        const std::int32_t i = patch_.triangles[t][k];
        if (i >= patch_.inner) continue;
        gradient.segment<2>(2 * i) += g.segment<2>(2 * k);
        for (int l = 0; l < 3; ++l) {
          const std::int32_t j = patch_.triangles[t][l];
          if (j >= patch_.inner) continue;
          for (int r = 0; r < 2; ++r) {
            for (int c = 0; c < 2; ++c) {
              entries.emplace_back(2 * i + r, 2 * j + c, H(2 * k + r, 2 * l + c));
            }
          }
        }
      }
    }
    matrix.resize(2 * patch_.inner, 2 * patch_.inner);
    matrix.setFromTriplets(entries.begin(), entries.end());
  }

 private:
  [[nodiscard]] Eigen::Matrix2d jacobian(const Eigen::Matrix2Xd& x, std::size_t t) const {
    Eigen::Matrix2d J = Eigen::Matrix2d::Zero();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d p = x.col(patch_.triangles[t][k]);
      J.col(0) += p * patch_.shapes[t].du[k];
      J.col(1) += p * patch_.shapes[t].dv[k];
    }
    return J;
  }

  const Patch& patch_;
};

/// Levenberg–Marquardt with ε following the worst determinant.
bool untangle_patch(Patch& patch) {
  const PatchEnergy energy(patch);
  Eigen::SparseMatrix<double> matrix;
  Eigen::VectorXd gradient;
  constexpr double kLargestDamping = 1e9;
  double damping = 1e-4;
  int after = 0;  // steps since all determinants are positive: they round the patch off
  for (int iteration = 0; iteration < 200 && after < 12; ++iteration) {
    const double least = energy.smallest_determinant(patch.x);
    if (least > 1e-6) ++after;
    // Positions are scaled so that the mean determinant is 1.
    const double epsilon = least > 0 ? 0 : std::sqrt(1e-12 + 0.04 * least * least);
    const double before = energy.value(patch.x, epsilon);
    energy.linearise(patch.x, epsilon, matrix, gradient);
    const double mean_diagonal = matrix.diagonal().mean();
    bool moved = false;
    for (int attempt = 0; attempt < 12 && !moved; ++attempt) {
      Eigen::SparseMatrix<double> damped = matrix;
      damped.diagonal() += damping * (matrix.diagonal().array() + 1e-3 * mean_diagonal).matrix();
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(damped);
      if (solver.info() == Eigen::Success) {
        const Eigen::VectorXd step = solver.solve(gradient);
        Eigen::Matrix2Xd trial = patch.x;
        for (std::int64_t i = 0; i < patch.inner; ++i) trial.col(i) -= step.segment<2>(2 * i);
        const bool feasible = least <= 0 || energy.smallest_determinant(trial) > 0;
        if (feasible && energy.value(trial, epsilon) < before) {
          patch.x = trial;
          moved = true;
        }
      }
      damping = moved ? std::max(damping * 0.2, 1e-9) : std::min(damping * 6, kLargestDamping);
    }
    // With the largest damping the next iteration would try the same steps.
    if (!moved && (least > 0 || damping >= kLargestDamping)) break;
  }
  return energy.smallest_determinant(patch.x) > 0;
}

class Untangler {
 public:
  Untangler(const ConstPoints& V, const ConstTriangles& F, const Twins& twins, Points& S)
      : V_(V), F_(F), twins_(twins), S_(S), any_(V.rows(), -1) {
    for (std::int32_t h = 0; h < static_cast<std::int32_t>(twins.size()); ++h) {
      any_[F(h / 3, h % 3)] = h;
    }
  }

  /// Makes the flipped triangles that hang together with `seed` positive. Those that it could not
  /// are not tried again in this pass.
  bool repair(std::int32_t seed) {
    if (failed_.count(seed) > 0) return false;
    const std::vector<std::int32_t> flipped = flipped_patch(seed);
    std::vector<std::int32_t> triangles = grown(flipped);
    constexpr int kRings = 7;
    for (int ring = 0; ring < kRings; ++ring) {
      triangles = grown(triangles);
      if (10 * triangles.size() > 9 * static_cast<std::size_t>(F_.rows())) break;
      if (solve(triangles)) return true;
    }
    failed_.insert(flipped.begin(), flipped.end());
    return false;
  }

  void next_pass() { failed_.clear(); }

  /// Lowers the energy around a positive triangle.
  void relax(std::int32_t seed) {
    std::vector<std::int32_t> triangles{seed};
    for (int ring = 0; ring < 3; ++ring) triangles = grown(triangles);
    if (2 * triangles.size() < static_cast<std::size_t>(F_.rows())) solve(triangles);
  }

 private:
  template <class Function>
  void around(std::int32_t vertex, Function&& function) const {
    std::int32_t h = any_[vertex];
    do {
      function(h / 3);
      h = twins_[previous_half_edge(h)];
    } while (h != any_[vertex]);
  }

  [[nodiscard]] std::vector<std::int32_t> grown(const std::vector<std::int32_t>& triangles) const {
    std::vector<std::int32_t> result;
    for (const std::int32_t t : triangles) {
      for (int k = 0; k < 3; ++k) {
        around(F_(t, k), [&](std::int32_t other) { result.push_back(other); });
      }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  /// The flipped triangles that hang together with `seed` by vertices.
  [[nodiscard]] std::vector<std::int32_t> flipped_patch(std::int32_t seed) const {
    std::vector<std::int32_t> patch{seed};
    std::unordered_set<std::int32_t> seen{seed};
    for (std::size_t next = 0; next < patch.size(); ++next) {
      for (int k = 0; k < 3; ++k) {
        around(F_(patch[next], k), [&](std::int32_t other) {
          if (!positive(F_, S_, other) && seen.insert(other).second) patch.push_back(other);
        });
      }
    }
    return patch;
  }

  bool solve(const std::vector<std::int32_t>& triangles) {
    Patch patch;
    if (!fill(triangles, patch)) return false;
    // Gnomonic projection about the middle of the patch.
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::int32_t v : patch.vertices) middle += row(S_, v);
    middle.normalize();
    const Eigen::Vector3d u = middle.unitOrthogonal(), v = middle.cross(u);
    patch.x.resize(2, static_cast<Eigen::Index>(patch.vertices.size()));
    for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
      const Eigen::Vector3d p = row(S_, patch.vertices[i]);
      const double along = p.dot(middle);
      if (!(along > 0.1)) return false;  // too large a part of the sphere for one plane
      // The difference to the middle keeps the digits of small patches.
      const Eigen::Vector3d d = p - middle;
      patch.x.col(static_cast<Eigen::Index>(i)) << d.dot(u) / along, d.dot(v) / along;
    }
    double image = 0, rest = 0;
    for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
      const auto& [i, j, k] = patch.triangles[t];
      const Eigen::Vector2d e = patch.x.col(j) - patch.x.col(i),
                            g = patch.x.col(k) - patch.x.col(i);
      image += 0.5 * (e.x() * g.y() - e.y() * g.x());
      rest += patch.shapes[t].area;
    }
    if (!(image > 0)) return false;
    const double scale = std::sqrt(rest / image);
    patch.x *= scale;
    if (!untangle_patch(patch)) return false;

    std::vector<Eigen::RowVector3d> before;
    for (std::int64_t i = 0; i < patch.inner; ++i) {
      before.emplace_back(S_.row(patch.vertices[i]));
      const Eigen::Vector2d x = patch.x.col(i) / scale;
      S_.row(patch.vertices[i]) = (middle + x.x() * u + x.y() * v).normalized().transpose();
    }
    for (const std::int32_t t : triangles) {
      if (!positive(F_, S_, t)) {
        for (std::int64_t i = 0; i < patch.inner; ++i) S_.row(patch.vertices[i]) = before[i];
        return false;
      }
    }
    return true;
  }

  /// Inner vertices are those all of whose triangles belong to the patch.
  bool fill(const std::vector<std::int32_t>& triangles, Patch& patch) const {
    std::vector<std::int32_t> border;
    std::unordered_map<std::int32_t, std::int32_t> place;
    for (const std::int32_t t : triangles) {
      for (int k = 0; k < 3; ++k) {
        const std::int32_t v = F_(t, k);
        if (!place.emplace(v, 0).second) continue;
        bool inner = true;
        around(v, [&](std::int32_t other) {
          inner = inner && std::binary_search(triangles.begin(), triangles.end(), other);
        });
        (inner ? patch.vertices : border).push_back(v);
      }
    }
    patch.inner = static_cast<std::int64_t>(patch.vertices.size());
    if (patch.inner == 0 || border.empty()) return false;
    patch.vertices.insert(patch.vertices.end(), border.begin(), border.end());
    for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
      place[patch.vertices[i]] = static_cast<std::int32_t>(i);
    }
    for (const std::int32_t t : triangles) {
      patch.triangles.push_back({place[F_(t, 0)], place[F_(t, 1)], place[F_(t, 2)]});
      patch.shapes.push_back(rest_shape(row(V_, F_(t, 0)), row(V_, F_(t, 1)), row(V_, F_(t, 2))));
    }
    return true;
  }

  const ConstPoints& V_;
  const ConstTriangles& F_;
  const Twins& twins_;
  Points& S_;
  std::vector<std::int32_t> any_;
  std::unordered_set<std::int32_t> failed_;
};

}  // namespace

std::int64_t flipped_count(const ConstTriangles& F, const Points& S) {
  std::int64_t count = 0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) count += positive(F, S, t) ? 0 : 1;
  return count;
}

Untangling untangle(const ConstPoints& V, const ConstTriangles& F, const Twins& twins, Points& S) {
  Untangling result;
  std::vector<std::int32_t> flipped;
  const auto find = [&] {
    flipped.clear();
    for (std::int32_t t = 0; t < F.rows(); ++t) {
      if (!positive(F, S, t)) flipped.push_back(t);
    }
    return static_cast<std::int64_t>(flipped.size());
  };
  result.found = result.left = find();
  Untangler untangler(V, F, twins, S);
  // A map that is flipped in large parts is beyond local repair.
  if (10 * result.found > F.rows()) return result;
  for (int pass = 0; pass < 3 && result.left > 0; ++pass) {
    untangler.next_pass();
    for (const std::int32_t t : flipped) {
      if (!positive(F, S, t)) untangler.repair(t);
    }
    const std::int64_t before = result.left;
    result.left = find();
    if (result.left == before) break;
  }
  if (result.left > 0) return result;  // no map to improve
  for (std::int32_t t = 0; t < F.rows(); ++t) {
    if (positive(F, S, t) && stretched(V, F, S, t)) untangler.relax(t);
  }
  return result;
}

}  // namespace shape3d::mapping
