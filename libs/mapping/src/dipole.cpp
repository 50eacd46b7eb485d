#include "dipole.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include <Eigen/CholmodSupport>

namespace shape3d::mapping {
namespace {

/// Outgoing half-edges of each vertex, one list after the other.
struct Stars {
  std::vector<std::int32_t> begin, half_edge;
  explicit Stars(const IntrinsicTriangulation& mesh)
      : begin(mesh.vertex_count + 1, 0), half_edge(mesh.origin.size()) {
    for (const std::int32_t v : mesh.origin) ++begin[v + 1];
    for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
    std::vector<std::int32_t> place(begin.begin(), begin.end() - 1);
    for (std::size_t h = 0; h < mesh.origin.size(); ++h) {
      half_edge[place[mesh.origin[h]]++] = static_cast<std::int32_t>(h);
    }
  }
};

/// Lengths of the shortest paths of edges from a vertex.
std::vector<double> edge_distances(const IntrinsicTriangulation& mesh, const Stars& stars,
                                   std::int32_t from) {
  std::vector<double> distance(mesh.vertex_count, std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::int32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  distance[from] = 0;
  queue.emplace(0.0, from);
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[v]) continue;
    for (std::int32_t s = stars.begin[v]; s < stars.begin[v + 1]; ++s) {
      const std::int32_t h = stars.half_edge[s], w = mesh.target(h);
      if (d + mesh.length[h] < distance[w]) {
        distance[w] = d + mesh.length[h];
        queue.emplace(distance[w], w);
      }
    }
  }
  return distance;
}

/// 1 for an equilateral triangle, 0 for a degenerate one.
double regularity(const IntrinsicTriangulation& mesh, std::int32_t t) {
  const double a = mesh.length[3 * t], b = mesh.length[3 * t + 1], c = mesh.length[3 * t + 2];
  const double squares = a * a + b * b + c * c;
  return squares > 0 ? 6.9282032302755091741 * triangle_cotangents(mesh, t).area / squares : 0;
}

/// Regularity of a triangle and its neighbours: the dipole is resolved by them.
double patch_regularity(const IntrinsicTriangulation& mesh, const std::vector<double>& quality,
                        std::int32_t t) {
  double lowest = quality[t];
  for (int k = 0; k < 3; ++k) lowest = std::min(lowest, quality[mesh.twin[3 * t + k] / 3]);
  return quality[t] + lowest;
}

bool three_vertices(const IntrinsicTriangulation& mesh, std::int32_t t) {
  const std::int32_t a = mesh.origin[3 * t], b = mesh.origin[3 * t + 1], c = mesh.origin[3 * t + 2];
  return a != b && b != c && c != a;
}

}  // namespace

std::vector<std::int32_t> pole_candidates(const IntrinsicTriangulation& mesh,
                                          std::int32_t extremity, std::size_t count) {
  const Stars stars(mesh);
  // The eccentricity of a vertex, from below: its distance to extremities, each the farthest from
  // the ones before.
  std::vector<double> eccentricity(mesh.vertex_count, 0);
  std::vector<double> nearest(mesh.vertex_count, std::numeric_limits<double>::infinity());
  constexpr int kExtremities = 5;
  for (int end = 0; end < kExtremities; ++end) {
    const std::vector<double> distance = edge_distances(mesh, stars, extremity);
    for (std::size_t v = 0; v < distance.size(); ++v) {
      eccentricity[v] = std::max(eccentricity[v], distance[v]);
      nearest[v] = std::min(nearest[v], distance[v]);
    }
    extremity = static_cast<std::int32_t>(std::max_element(nearest.begin(), nearest.end()) -
                                          nearest.begin());
  }
  const auto count_of = static_cast<std::int32_t>(mesh.twin.size() / 3);
  std::vector<double> quality(count_of);
  for (std::int32_t t = 0; t < count_of; ++t) quality[t] = regularity(mesh, t);
  const double least = *std::min_element(eccentricity.begin(), eccentricity.end());

  std::vector<std::pair<double, std::int32_t>> scored;
  for (std::int32_t t = 0; t < count_of; ++t) {
    if (!three_vertices(mesh, t)) continue;
    const double farthest =
        std::max({eccentricity[mesh.origin[3 * t]], eccentricity[mesh.origin[3 * t + 1]],
                  eccentricity[mesh.origin[3 * t + 2]]});
    const double excess = farthest / std::max(least, 1e-300) - 1;
    scored.emplace_back(patch_regularity(mesh, quality, t) - 4 * std::max(0.0, excess - 0.1), t);
  }
  std::sort(scored.begin(), scored.end(), [](const auto& l, const auto& r) {
    return l.first != r.first ? l.first > r.first : l.second < r.second;
  });
  std::vector<std::int32_t> chosen;
  std::vector<double> apart(mesh.vertex_count, std::numeric_limits<double>::infinity());
  for (const auto& [score, t] : scored) {
    if (chosen.size() == count) break;
    if (apart[mesh.origin[3 * t]] < 0.1 * least) continue;
    chosen.push_back(t);
    if (chosen.size() == count) break;
    const std::vector<double> distance = edge_distances(mesh, stars, mesh.origin[3 * t]);
    for (std::size_t v = 0; v < apart.size(); ++v) apart[v] = std::min(apart[v], distance[v]);
  }
  return chosen;
}

struct DipoleSolver::State {
  /// Row of each vertex in the system; -1 for the grounded one, where z = 0.
  std::vector<std::int32_t> row;
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor;
};

DipoleSolver::DipoleSolver(const IntrinsicTriangulation& mesh,
                           const std::vector<std::int32_t>& order)
    : mesh_(mesh), state_(std::make_unique<State>()) {
  const auto grounded = static_cast<std::int32_t>(mesh.vertex_count - 1);
  std::vector<std::int32_t>& row = state_->row;
  row.assign(mesh.vertex_count, -1);
  std::int32_t n = 0;
  for (const std::int32_t v : order) {
    if (v != grounded) row[v] = n++;
  }
  const std::vector<double> weights = cotangent_weights(mesh);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(weights.size() + static_cast<std::size_t>(n));
  std::vector<double> diagonal(n, 0);
  for (std::int32_t h = 0; h < static_cast<std::int32_t>(weights.size()); ++h) {
    const std::int32_t i = row[mesh.origin[h]], j = row[mesh.target(h)];
    if (i == j || i < 0) continue;
    diagonal[i] += weights[h];
    if (i > j && j >= 0) entries.emplace_back(i, j, -weights[h]);
  }
  for (std::int32_t i = 0; i < n; ++i) entries.emplace_back(i, i, diagonal[i]);
  Eigen::SparseMatrix<double> L(n, n);
  L.setFromTriplets(entries.begin(), entries.end());
  cholmod_common& settings = state_->factor.cholmod();
  settings.print = 0;
  settings.nmethods = 1;
  settings.method[0].ordering = CHOLMOD_NATURAL;
  state_->factor.compute(L);
}

DipoleSolver::~DipoleSolver() = default;

bool DipoleSolver::factorised() const { return state_->factor.info() == Eigen::Success; }

PlanePoints DipoleSolver::solve(std::int32_t pole) const {
  // The pole's triangle in its plane: A = 0, B = (ab, 0), C; E is the foot of C's height.
  const double ab = mesh_.length[3 * pole], bc = mesh_.length[3 * pole + 1],
               ca = mesh_.length[3 * pole + 2];
  const double foot = (ab * ab + ca * ca - bc * bc) / (2 * ab);
  const double height = 2 * triangle_cotangents(mesh_, pole).area / ab;
  const double theta = foot / ab;
  const std::vector<std::int32_t>& row = state_->row;
  Eigen::MatrixX2d b = Eigen::MatrixX2d::Zero(mesh_.vertex_count - 1, 2);
  const auto add = [&](std::int32_t v, double x, double y) {
    if (row[v] >= 0) b.row(row[v]) += Eigen::RowVector2d(x, y);
  };
  add(mesh_.origin[3 * pole], -1 / ab, (1 - theta) / height);
  add(mesh_.origin[3 * pole + 1], 1 / ab, theta / height);
  add(mesh_.origin[3 * pole + 2], 0, -1 / height);
  const Eigen::MatrixX2d x = state_->factor.solve(b);
  PlanePoints z(mesh_.vertex_count, Complex(0, 0));
  for (std::size_t v = 0; v < z.size(); ++v) {
    if (row[v] >= 0) z[v] = {x(row[v], 0), x(row[v], 1)};
  }

  // The outer triangle is the pole turned inside out; so the others run the way opposite to it.
  const Complex A = z[mesh_.origin[3 * pole]], B = z[mesh_.origin[3 * pole + 1]],
                C = z[mesh_.origin[3 * pole + 2]];
  if (std::imag(std::conj(B - A) * (C - A)) > 0) {
    for (Complex& p : z) p = std::conj(p);
  }
  return z;
}

Complex remove_dilatation(const IntrinsicTriangulation& mesh, std::int32_t pole, PlanePoints& z) {
  std::vector<std::pair<double, double>> real, imaginary;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.twin.size() / 3); ++t) {
    if (t == pole) continue;
    const double a = mesh.length[3 * t], bc = mesh.length[3 * t + 1], ca = mesh.length[3 * t + 2];
    const double area = triangle_cotangents(mesh, t).area;
    if (!(area > 1e-6 * a * a)) continue;  // its shape is not known well enough
    const double x = (a * a + ca * ca - bc * bc) / (2 * a), y = 2 * area / a;
    const Complex e1 = z[mesh.origin[3 * t + 1]] - z[mesh.origin[3 * t]];
    const Complex e2 = z[mesh.origin[3 * t + 2]] - z[mesh.origin[3 * t]];
    const Complex fu = e1 / a, fv = (e2 - e1 * (x / a)) / y;
    const Complex i(0, 1), fz = 0.5 * (fu - i * fv), fzbar = 0.5 * (fu + i * fv);
    if (!(std::abs(fz) > 0)) continue;
    const Complex nu = fzbar / std::conj(fz);
    if (!std::isfinite(nu.real()) || !std::isfinite(nu.imag())) continue;
    real.emplace_back(nu.real(), area);
    imaginary.emplace_back(nu.imag(), area);
  }
  const auto median = [](std::vector<std::pair<double, double>>& values) {
    std::sort(values.begin(), values.end());
    double total = 0, sum = 0;
    for (const auto& value : values) total += value.second;
    for (const auto& value : values) {
      sum += value.second;
      if (2 * sum >= total) return value.first;
    }
    return 0.0;
  };
  const Complex c(median(real), median(imaginary));
  if (!(std::norm(c) < 0.81)) return 0;  // no correction, but another map altogether
  for (Complex& p : z) p = (p - c * std::conj(p)) / (1 - std::norm(c));
  return c;
}

}  // namespace shape3d::mapping
