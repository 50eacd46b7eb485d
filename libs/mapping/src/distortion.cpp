#include "shape3d/mapping/distortion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "surface.hpp"
#include "triangle.hpp"

namespace shape3d::mapping {
namespace {

constexpr double kDegrees = 57.295779513082320877;
constexpr double kFourPi = 12.566370614359172954;

/// Angles at (0, 0), (a, 0), (b, c).
std::array<double, 3> angles(const PlaneTriangle& t) {
  const double first = std::atan2(t.c, t.b), second = std::atan2(t.c, t.a - t.b);
  return {first, second, kFourPi / 4 - first - second};
}

/// The linear map (a, 0) → (a', 0), (b, c) → (b', c') is [xx, xy; 0, yy].
struct TriangleMap {
  double xx, xy, yy;
  TriangleMap(const PlaneTriangle& from, const PlaneTriangle& to)
      : xx(to.a / from.a), xy((to.b - from.b * xx) / from.c), yy(to.c / from.c) {}
  [[nodiscard]] double squared_norm() const { return xx * xx + xy * xy + yy * yy; }
  [[nodiscard]] double determinant() const { return xx * yy; }
  /// σ1 ± σ2 are the norms of the conformal and the anticonformal part, so that no digits are lost
  /// near 1.
  [[nodiscard]] double sigma_ratio() const {
    const double sum = std::hypot(xx + yy, xy), difference = std::hypot(xx - yy, xy);
    return sum > difference ? (sum + difference) / (sum - difference)
                            : std::numeric_limits<double>::infinity();
  }
};

struct Measured {
  PlaneTriangle from, to;
  double omega = 0;  ///< Solid angle in S.
};

Measured measure(const ConstPoints& V, const ConstTriangles& F, const ConstPoints& S,
                 Eigen::Index t) {
  const auto i = F(t, 0), j = F(t, 1), k = F(t, 2);
  return {plane_triangle(row(V, i), row(V, j), row(V, k)),
          plane_triangle(row(S, i), row(S, j), row(S, k)),
          solid_angle(row(S, i), row(S, j), row(S, k))};
}

bool has_area(const PlaneTriangle& t) { return t.a > 0 && t.c > 0 && t.area() > 0; }

double mean_angle_change(const Measured& m, double* changes) {
  const std::array<double, 3> before = angles(m.from), after = angles(m.to);
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    changes[k] = kDegrees * std::abs(after[k] - before[k]);
    sum += changes[k];
  }
  return sum / 3;
}

Quantiles quantiles(std::vector<double> values) {
  Quantiles q;
  if (values.empty()) return q;
  for (const double value : values) q.mean += value;
  q.mean /= static_cast<double>(values.size());
  // Nearest rank: the smallest value that no less than the share p does not exceed.
  const auto rank = [&values](double p) {
    const auto n = static_cast<std::size_t>(std::ceil(p * static_cast<double>(values.size())));
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(n, 1) - 1);
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  q.median = rank(0.5);
  q.p95 = rank(0.95);
  q.p99 = rank(0.99);
  q.max = rank(1);
  return q;
}

void require_pair(const ConstPoints& V, const ConstTriangles& F, const ConstPoints& S) {
  if (S.rows() != V.rows()) {
    throw std::invalid_argument("S: " + std::to_string(S.rows()) + " rows; expected " +
                                std::to_string(V.rows()) + ", one for each row of V");
  }
  require_finite(V, "V");
  require_finite(S, "S");
  require_indices(F, V.rows());
}

/// V moved and scaled into the unit box, where products of coordinates neither overflow nor vanish.
Points normalised(const ConstPoints& V) {
  if (V.rows() == 0) return V;
  // Halved before they are subtracted: the difference of the largest doubles overflows.
  const Eigen::RowVector3d low = 0.5 * V.colwise().minCoeff(), high = 0.5 * V.colwise().maxCoeff();
  const double extent = (high - low).maxCoeff();
  Points result = (0.5 * V).rowwise() - 0.5 * (high + low);
  if (extent > 0) result /= extent;
  return result;
}

}  // namespace

Distortion measure_distortion(const ConstPoints& V, const ConstTriangles& F, const ConstPoints& S) {
  require_pair(V, F, S);
  const Points W = normalised(V);
  Distortion result;
  std::vector<double> changes, ratios;
  changes.reserve(3 * F.rows());
  ratios.reserve(F.rows());
  double dirichlet = 0, image = 0, area = 0;
  double shortest = std::numeric_limits<double>::infinity();
  std::vector<std::array<double, 2>> shares;  // area in V, solid angle in S
  shares.reserve(F.rows());
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      shortest = std::min(shortest, (row(S, F(t, k)) - row(S, F(t, (k + 1) % 3))).norm());
    }
    const Measured m = measure(W, F, S, t);
    if (!has_area(m.from)) {
      ++result.unmeasured_triangles;
      continue;
    }
    std::array<double, 3> change{};
    mean_angle_change(m, change.data());
    changes.insert(changes.end(), change.begin(), change.end());
    const TriangleMap map(m.from, m.to);
    ratios.push_back(map.sigma_ratio());
    dirichlet += 0.5 * m.from.area() * map.squared_norm();
    image += m.to.area();
    area += m.from.area();
    shares.push_back({m.from.area(), m.omega});
  }
  double starved = 0;
  for (const auto& [a, omega] : shares) {
    if (omega < 0.01 * kFourPi * a / area) starved += a;
  }
  result.angle_change = quantiles(std::move(changes));
  result.sigma_ratio = quantiles(std::move(ratios));
  result.energy_over_area = image > 0 ? dirichlet / image : 0;
  result.starved_area_share = area > 0 ? starved / area : 0;
  result.shortest_edge = F.rows() > 0 ? shortest : 0;
  return result;
}

TriangleDistortion triangle_distortion(const ConstPoints& V, const ConstTriangles& F,
                                       const ConstPoints& S) {
  require_pair(V, F, S);
  const Points W = normalised(V);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  TriangleDistortion result;
  double area = 0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Measured m = measure(W, F, S, t);
    area += m.from.area();
    std::array<double, 3> change{};
    const bool measurable = has_area(m.from);
    result.angle_change.push_back(measurable ? mean_angle_change(m, change.data()) : nan);
    result.sigma_ratio.push_back(measurable ? TriangleMap(m.from, m.to).sigma_ratio() : nan);
    result.log10_area_scale.push_back(
        measurable ? std::log10(m.omega / kFourPi) - std::log10(m.from.area()) : nan);
  }
  for (double& scale : result.log10_area_scale) scale += std::log10(area);
  return result;
}

}  // namespace shape3d::mapping
