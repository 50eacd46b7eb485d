#include "shape3d/mapping/curvature.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include "edge_list.hpp"
#include "mesh_arguments.hpp"

namespace shape3d::mapping {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Vertices joined by an edge, and rings of them.
class Neighbours {
 public:
  Neighbours(const ConstTriangles& F, Eigen::Index vertices)
      : begin_(index(vertices) + 1, 0), seen_(index(vertices), -1) {
    std::vector<bool> use;
    for (Eigen::Index t = 0; t < F.rows(); ++t)
      use.push_back(F(t, 0) != F(t, 1) && F(t, 1) != F(t, 2) && F(t, 2) != F(t, 0));
    const auto uses = detail::edge_list(F, use, vertices);
    const auto for_each_pair = [&](const auto& visit) {
      detail::for_each_edge(uses, [&](const detail::EdgeUse* edge, const detail::EdgeUse*) {
        visit(edge->low, edge->high);
        visit(edge->high, edge->low);
      });
    };
    for_each_pair([&](std::int32_t from, std::int32_t) { ++begin_[index(from) + 1]; });
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    others_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for_each_pair([&](std::int32_t from, std::int32_t to) { others_[next[index(from)]++] = to; });
  }

  /// The vertices within `rings` edges of v, without v; more rings until there are `least`.
  const std::vector<std::int32_t>& around(std::int32_t v, int rings, std::size_t least) {
    found_.clear();
    seen_[index(v)] = v;
    std::size_t ring_begin = 0;
    add_neighbours(v, v);
    for (int ring = 1; ring < rings || found_.size() < least; ++ring) {
      const std::size_t ring_end = found_.size();
      for (std::size_t i = ring_begin; i < ring_end; ++i) add_neighbours(found_[i], v);
      ring_begin = ring_end;
      if (found_.size() == ring_end) break;  // that is the whole component
    }
    return found_;
  }

 private:
  void add_neighbours(std::int32_t of, std::int32_t mark) {
    for (std::size_t i = begin_[index(of)]; i < begin_[index(of) + 1]; ++i) {
      if (seen_[index(others_[i])] == mark) continue;
      seen_[index(others_[i])] = mark;
      found_.push_back(others_[i]);
    }
  }

  std::vector<std::size_t> begin_;
  std::vector<std::int32_t> others_, seen_, found_;
};

// Normals of the triangles round each vertex, by area.
Points vertex_normals(const ConstPoints& V, const ConstTriangles& F) {
  Points normals = Points::Zero(V.rows(), 3);
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::Vector3d a = V.row(F(t, 0)), b = V.row(F(t, 1)), c = V.row(F(t, 2));
    const Eigen::RowVector3d normal = (b - a).cross(c - a);
    for (Eigen::Index i = 0; i < 3; ++i) normals.row(F(t, i)) += normal;
  }
  for (Eigen::Index v = 0; v < V.rows(); ++v) normals.row(v) = normals.row(v).stableNormalized();
  return normals;
}

/// Slopes and second derivatives of a height over a plane, at its origin.
struct Jet {
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
};

// Least squares fit of z = Σ a_ij x^i y^j, i + j ≤ degree, with coordinates of about 1; a lower
// degree when the points do not determine all coefficients.
std::optional<Jet> fit(const Eigen::Matrix3Xd& points, int degree) {
  for (; degree >= 2; --degree) {
    const Eigen::Index terms = (degree + 1) * (degree + 2) / 2;
    if (points.cols() < terms) continue;
    Eigen::MatrixXd A(points.cols(), terms);
    for (Eigen::Index p = 0; p < points.cols(); ++p) {
      Eigen::Index term = 0;
      double x_power = 1.0;
      for (int i = 0; i <= degree; ++i, x_power *= points(0, p)) {
        double power = x_power;
        for (int j = 0; i + j <= degree; ++j, power *= points(1, p)) A(p, term++) = power;
      }
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(A);
    solver.setThreshold(1e-9);
    if (solver.rank() < terms) continue;
    const Eigen::VectorXd a = solver.solve(points.row(2).transpose());
    // Places of x⁰y⁰ x⁰y¹ x⁰y² … x¹y⁰ x¹y¹ … x²y⁰.
    const Eigen::Index x1 = degree + 1, x2 = 2 * degree + 1;
    return Jet{a[x1], a[1], 2.0 * a[x2], a[x1 + 1], 2.0 * a[2]};
  }
  return std::nullopt;
}

void check(const ConstPoints& V, const ConstTriangles& F, const CurvatureOptions& options) {
  if (options.degree < 2 || options.degree > 4) {
    throw std::invalid_argument("options.degree: expected 2 to 4, got " +
                                std::to_string(options.degree));
  }
  if (options.rings < 1 || options.rings > 10) {
    throw std::invalid_argument("options.rings: expected 1 to 10, got " +
                                std::to_string(options.rings));
  }
  detail::check_indices(V, F);
  detail::check_finite(V);
}

}  // namespace

Curvature curvature(const ConstPoints& V, const ConstTriangles& F,
                    const CurvatureOptions& options) {
  check(V, F, options);
  const Eigen::Index n = V.rows();
  Curvature result;
  for (Eigen::VectorXd* values : {&result.mean, &result.gaussian, &result.maximum, &result.minimum})
    values->setConstant(n, kNaN);
  for (Points* vectors : {&result.maximum_direction, &result.minimum_direction, &result.normal})
    vectors->setConstant(n, 3, kNaN);
  if (F.rows() == 0) {
    result.undetermined = n;
    return result;
  }
  const detail::Frame frame = detail::frame_of(V, F);
  const Points P = (V.rowwise() - frame.centre) / frame.unit;
  const Points normals = vertex_normals(P, F);
  Neighbours neighbours(F, n);
  const auto terms = index((options.degree + 1) * (options.degree + 2) / 2);

  for (Eigen::Index v = 0; v < n; ++v) {
    const Eigen::Vector3d normal = normals.row(v).transpose();
    const auto& around =
        neighbours.around(static_cast<std::int32_t>(v), options.rings, terms + terms / 2);
    std::optional<Jet> jet;
    Eigen::Matrix3d axes;  // columns: two tangents and the normal
    double size = 0.0;
    if (normal.squaredNorm() > 0.5 && !around.empty()) {
      axes.col(2) = normal;
      axes.col(0) = normal.unitOrthogonal();
      axes.col(1) = normal.cross(axes.col(0));
      Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(around.size()) + 1);
      points.col(0).setZero();
      for (std::size_t i = 0; i < around.size(); ++i) {
        const Eigen::Vector3d offset = (P.row(around[i]) - P.row(v)).transpose();
        points.col(static_cast<Eigen::Index>(i) + 1) = axes.transpose() * offset;
        size += offset.norm() / static_cast<double>(around.size());
      }
      if (size > 0.0) jet = fit(points / size, options.degree);
    }
    if (!jet) {
      ++result.undetermined;
      continue;
    }
    // First and second fundamental form of (x, y, z(x, y)); κ v = I⁻¹ II v. Away from the normal is
    // positive.
    const double w = std::sqrt(1.0 + jet->x * jet->x + jet->y * jet->y);
    Eigen::Matrix2d first, second;
    first << 1.0 + jet->x * jet->x, jet->x * jet->y, jet->x * jet->y, 1.0 + jet->y * jet->y;
    second << jet->xx, jet->xy, jet->xy, jet->yy;
    second *= -1.0 / w;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> eigen(second, first);
    const double unit = size * frame.unit;
    const double least = eigen.eigenvalues()[0] / unit, most = eigen.eigenvalues()[1] / unit;
    const auto tangent = [&](Eigen::Index which) -> Eigen::RowVector3d {
      const Eigen::Vector2d t = eigen.eigenvectors().col(which);
      return (axes * Eigen::Vector3d(t[0], t[1], jet->x * t[0] + jet->y * t[1])).normalized();
    };
    result.maximum[v] = most;
    result.minimum[v] = least;
    result.mean[v] = 0.5 * (most + least);
    result.gaussian[v] = most * least;
    result.maximum_direction.row(v) = tangent(1);
    result.minimum_direction.row(v) = tangent(0);
    result.normal.row(v) = (axes * Eigen::Vector3d(-jet->x, -jet->y, 1.0)).normalized();
  }
  return result;
}

}  // namespace shape3d::mapping
