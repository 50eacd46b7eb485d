#include "intrinsic.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "triangle.hpp"

namespace shape3d::mapping {
namespace {

/// Area by Heron's formula in Kahan's order, which is accurate for needles.
double heron(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (a < c) std::swap(a, c);
  if (b < c) std::swap(b, c);
  const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return product > 0 ? 0.25 * std::sqrt(product) : 0;
}

/// Sine and cosine of the angle opposite to `opposite`, up to the common factor 2 · b · c.
struct Angle {
  double sine, cosine;
};

Angle angle_opposite(double opposite, double b, double c) {
  return {4 * heron(opposite, b, c), b * b + c * c - opposite * opposite};
}

bool is_delaunay(const IntrinsicTriangulation& mesh, std::int32_t h) {
  const auto angle = [&mesh](std::int32_t e) {
    return angle_opposite(mesh.length[e], mesh.length[next_half_edge(e)],
                          mesh.length[previous_half_edge(e)]);
  };
  const Angle alpha = angle(h), beta = angle(mesh.twin[h]);
  const double norm = std::hypot(alpha.sine, alpha.cosine) * std::hypot(beta.sine, beta.cosine);
  // sin(α + β) ≥ 0. The slack, far above rounding, keeps cocircular quadrilaterals from flipping to
  // and fro.
  return alpha.sine * beta.cosine + alpha.cosine * beta.sine >= -1e-10 * norm;
}

/// Replaces edge i → j, between the triangles (i, j, k) and (j, i, l), by k → l.
void flip(IntrinsicTriangulation& mesh, std::int32_t h) {
  const std::int32_t t = mesh.twin[h];
  const std::int32_t n = next_half_edge(h), p = previous_half_edge(h);
  const std::int32_t tn = next_half_edge(t), tp = previous_half_edge(t);
  const std::int32_t i = mesh.origin[h], j = mesh.origin[t], k = mesh.origin[p],
                     l = mesh.origin[tp];
  const double ij = mesh.length[h], jk = mesh.length[n], ki = mesh.length[p], il = mesh.length[tn],
               lj = mesh.length[tp];
  // i at the origin, j on the x axis, k above it and l below.
  const double kx = (ij * ij + ki * ki - jk * jk) / (2 * ij), ky = 2 * heron(ij, jk, ki) / ij;
  const double lx = (ij * ij + il * il - lj * lj) / (2 * ij), ly = -2 * heron(ij, il, lj) / ij;
  // A rounded diagonal must not break the triangle inequalities of the new triangles.
  const double low = std::max(std::abs(jk - lj), std::abs(ki - il));
  const double high = std::min(jk + lj, ki + il);
  const double kl = std::clamp(std::hypot(kx - lx, ky - ly), low, high);

  // The four sides move on by one place: (h, n, p) is then k → l → j, (t, tn, tp) is l → k → i.
  const auto moved = [&](std::int32_t e) {
    return e == n ? p : e == p ? tn : e == tn ? tp : e == tp ? n : e;
  };
  const std::array<std::int32_t, 4> sides{n, p, tn, tp};
  std::array<std::int32_t, 4> outer{};
  for (int s = 0; s < 4; ++s) outer[s] = mesh.twin[sides[s]];
  for (int s = 0; s < 4; ++s) {
    mesh.twin[moved(sides[s])] = moved(outer[s]);
    mesh.twin[moved(outer[s])] = moved(sides[s]);
  }
  mesh.origin[h] = k;
  mesh.origin[n] = l;
  mesh.origin[p] = j;
  mesh.origin[t] = l;
  mesh.origin[tn] = k;
  mesh.origin[tp] = i;
  mesh.length[h] = mesh.length[t] = kl;
  mesh.length[n] = lj;
  mesh.length[p] = jk;
  mesh.length[tn] = ki;
  mesh.length[tp] = il;
  ++mesh.flips;
}

/// Adds to all edges what the worst triangle lacks.
void mollify(IntrinsicTriangulation& mesh) {
  double mean = 0;
  for (const double length : mesh.length) mean += length;
  mean /= static_cast<double>(mesh.length.size());
  const double margin = 1e-8 * mean;
  double lacking = 0;
  for (std::size_t t = 0; t < mesh.length.size() / 3; ++t) {
    const double a = mesh.length[3 * t], b = mesh.length[3 * t + 1], c = mesh.length[3 * t + 2];
    lacking = std::max({lacking, margin + a - b - c, margin + b - c - a, margin + c - a - b});
  }
  for (double& length : mesh.length) length += lacking;
}

}  // namespace

IntrinsicTriangulation intrinsic_triangulation(const ConstPoints& V, const ConstTriangles& F,
                                               const Twins& twins) {
  IntrinsicTriangulation mesh;
  mesh.vertex_count = V.rows();
  mesh.twin = twins;
  mesh.origin.resize(twins.size());
  mesh.length.resize(twins.size());
  for (std::int32_t h = 0; h < static_cast<std::int32_t>(twins.size()); ++h) {
    mesh.origin[h] = F(h / 3, h % 3);
  }
  for (std::int32_t h = 0; h < static_cast<std::int32_t>(twins.size()); ++h) {
    mesh.length[h] = h < twins[h] ? (row(V, mesh.origin[h]) - row(V, mesh.target(h))).norm()
                                  : mesh.length[twins[h]];
  }
  mollify(mesh);
  return mesh;
}

void make_delaunay(IntrinsicTriangulation& mesh) {
  const auto count = static_cast<std::int32_t>(mesh.twin.size());
  std::vector<std::int32_t> queue;
  std::vector<char> queued(mesh.twin.size(), 0);
  const auto push = [&](std::int32_t h) {
    const std::int32_t low = std::min(h, mesh.twin[h]);
    if (!queued[low]) {
      queued[low] = 1;
      queue.push_back(low);
    }
  };
  for (std::int32_t h = 0; h < count; ++h) {
    if (h < mesh.twin[h]) push(h);
  }
  // Termination is proved for exact lengths; the limit is for rounded ones.
  const std::int64_t limit = mesh.flips + 50LL * count;
  while (!queue.empty() && mesh.flips < limit) {
    const std::int32_t h = queue.back();
    queue.pop_back();
    queued[h] = 0;
    const std::int32_t t = mesh.twin[h];
    if (h / 3 == t / 3 || is_delaunay(mesh, h)) continue;
    const std::array<std::int32_t, 4> sides{next_half_edge(h), previous_half_edge(h),
                                            next_half_edge(t), previous_half_edge(t)};
    // The sides change their numbers: they leave the queue under the old ones.
    for (const std::int32_t s : sides) queued[std::min(s, mesh.twin[s])] = 0;
    flip(mesh, h);
    for (const std::int32_t s : sides) push(s);
  }
}

TriangleCotangents triangle_cotangents(const IntrinsicTriangulation& mesh, std::int32_t t) {
  const double a = mesh.length[3 * t], b = mesh.length[3 * t + 1], c = mesh.length[3 * t + 2];
  TriangleCotangents result;
  result.area = heron(a, b, c);
  // A triangle that rounding has flattened gets the area of one that is not quite.
  const double area = std::max(result.area, 1e-12 * std::max({a * a, b * b, c * c}));
  result.cotangent[0] = (b * b + c * c - a * a) / (4 * area);
  result.cotangent[1] = (c * c + a * a - b * b) / (4 * area);
  result.cotangent[2] = (a * a + b * b - c * c) / (4 * area);
  return result;
}

std::vector<double> cotangent_weights(const IntrinsicTriangulation& mesh) {
  std::vector<double> weights(mesh.twin.size(), 0);
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.twin.size() / 3); ++t) {
    const TriangleCotangents c = triangle_cotangents(mesh, t);
    for (int k = 0; k < 3; ++k) {
      weights[3 * t + k] += 0.5 * c.cotangent[k];
      weights[mesh.twin[3 * t + k]] += 0.5 * c.cotangent[k];
    }
  }
  for (double& weight : weights) weight = std::max(weight, 0.0);
  return weights;
}

}  // namespace shape3d::mapping
