#include "bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

namespace shape3d::mapping::test {
namespace {

using Triple = std::array<std::int32_t, 3>;

/// Collects triangles given by points; equal points are one vertex.
class Builder {
 public:
  std::int32_t vertex(const Eigen::Vector3d& p) {
    const std::array<double, 3> key{p[0] + 0.0, p[1] + 0.0, p[2] + 0.0};
    const auto [found, is_new] = ids_.try_emplace(key, static_cast<std::int32_t>(points_.size()));
    if (is_new) points_.push_back(p);
    return found->second;
  }
  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    triangles_.push_back({vertex(a), vertex(b), vertex(c)});
  }
  Body finish(std::string name) const {
    Body body;
    body.name = std::move(name);
    body.V.resize(static_cast<Eigen::Index>(points_.size()), 3);
    body.F.resize(static_cast<Eigen::Index>(triangles_.size()), 3);
    for (std::size_t v = 0; v < points_.size(); ++v)
      body.V.row(static_cast<Eigen::Index>(v)) = points_[v].transpose();
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i)
        body.F(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(i)) = triangles_[t][i];
    }
    return body;
  }

 private:
  std::map<std::array<double, 3>, std::int32_t> ids_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Triple> triangles_;
};

/// Adds one side of the cube: place(s, t) for s, t of −1 … 1, with s, t and the outside
/// right-handed.
using Place = std::function<Eigen::Vector3d(double, double)>;
using Side = std::function<void(Builder&, const Place&)>;

Body cube(const std::string& name, const Side& side) {
  Builder builder;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      side(builder, [axis, sign](double s, double t) {
        Eigen::Vector3d p;
        p[axis] = sign;
        p[(axis + 1) % 3] = sign > 0 ? s : t;
        p[(axis + 2) % 3] = sign > 0 ? t : s;
        return p;
      });
    }
  }
  return builder.finish(name);
}

// A lattice of the given lines; the diagonal of a square runs up or down.
Side grid(const std::vector<double>& lines,
          const std::function<bool(std::size_t, std::size_t)>& up) {
  return [lines, up](Builder& builder, const Place& place) {
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
      for (std::size_t j = 0; j + 1 < lines.size(); ++j) {
        const auto p = [&](std::size_t di, std::size_t dj) {
          return place(lines[i + di], lines[j + dj]);
        };
        if (up(i, j)) {
          builder.triangle(p(0, 0), p(1, 0), p(1, 1));
          builder.triangle(p(0, 0), p(1, 1), p(0, 1));
        } else {
          builder.triangle(p(0, 0), p(1, 0), p(0, 1));
          builder.triangle(p(1, 0), p(1, 1), p(0, 1));
        }
      }
    }
  };
}

std::vector<double> lines(int n, const std::function<double(double)>& place) {
  std::vector<double> result;
  for (int i = 0; i <= n; ++i) result.push_back(place(-1.0 + 2.0 * i / n));
  return result;
}

// Triangles from an inner point to the pieces of the border.
Side fan(double s, double t, const std::vector<double>& border) {
  return [s, t, border](Builder& builder, const Place& place) {
    for (std::size_t i = 0; i + 1 < border.size(); ++i) {
      const double a = border[i], b = border[i + 1];
      builder.triangle(place(s, t), place(a, -1), place(b, -1));
      builder.triangle(place(s, t), place(1, a), place(1, b));
      builder.triangle(place(s, t), place(-a, 1), place(-b, 1));
      builder.triangle(place(s, t), place(-1, -a), place(-1, -b));
    }
  };
}

// Squared distance of a point to a triangle: to its plane when the point is between the three
// planes through the sides, else to the nearest side.
double squared_distance(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& q) {
  const Eigen::Vector3d normal = (q[1] - q[0]).cross(q[2] - q[0]);
  bool within = true;
  double sides = 1e300;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d &a = q[i], &b = q[(i + 1) % 3];
    within = within && normal.cross(b - a).dot(p - a) >= 0.0;
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    sides = std::min(sides, (a + t * (b - a) - p).squaredNorm());
  }
  if (!within) return sides;
  const double height = normal.dot(p - q[0]);
  return height * height / normal.squaredNorm();
}

double same(double x) { return x; }
double cubed(double x) { return x * x * x; }

}  // namespace

Body sphere(int level) {
  Builder builder;
  const double g = 0.5 * (1 + std::sqrt(5.0));
  const std::array<Eigen::Vector3d, 12> p{Eigen::Vector3d(-1, g, 0),
                                          {1, g, 0},
                                          {-1, -g, 0},
                                          {1, -g, 0},
                                          {0, -1, g},
                                          {0, 1, g},
                                          {0, -1, -g},
                                          {0, 1, -g},
                                          {g, 0, -1},
                                          {g, 0, 1},
                                          {-g, 0, -1},
                                          {-g, 0, 1}};
  constexpr int kFaces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  const std::function<void(const Eigen::Vector3d&, const Eigen::Vector3d&, const Eigen::Vector3d&,
                           int)>
      add =
          [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, int n) {
            if (n == 0) {
              builder.triangle(a, b, c);
              return;
            }
            const Eigen::Vector3d ab = (a + b).normalized(), bc = (b + c).normalized(),
                                  ca = (c + a).normalized();
            add(a, ab, ca, n - 1);
            add(b, bc, ab, n - 1);
            add(c, ca, bc, n - 1);
            add(ab, bc, ca, n - 1);
          };
  for (const auto& f : kFaces)
    add(p[f[0]].normalized(), p[f[1]].normalized(), p[f[2]].normalized(), level);
  return builder.finish("sphere");
}

std::vector<Body> cubes_meshed_twelve_ways() {
  const auto up = [](std::size_t, std::size_t) { return true; };
  const auto down = [](std::size_t, std::size_t) { return false; };
  const auto mixed = [](std::size_t i, std::size_t j) { return (i + j) % 2 == 0; };
  const auto scattered = [](std::size_t i, std::size_t j) { return (i * 7 + j * 13) % 5 < 2; };
  const std::vector<double> ends{-1, 1};
  std::vector<Body> bodies;
  bodies.push_back(cube("12 triangles, diagonals up", grid(ends, up)));
  bodies.push_back(cube("12 triangles, diagonals down", grid(ends, down)));
  bodies.push_back(cube("fans from the middles", fan(0, 0, ends)));
  bodies.push_back(cube("fans from points near a corner", fan(0.9, 0.83, ends)));
  bodies.push_back(cube("even grid", grid(lines(8, same), up)));
  bodies.push_back(cube("even grid, diagonals in turn", grid(lines(7, same), mixed)));
  bodies.push_back(cube("lines close to the middle", grid(lines(10, cubed), scattered)));
  // Corners alone keep the same border from both sides; uneven lines must be symmetric.
  bodies.push_back(
      cube("lines close to the edges",
           grid(lines(9, [](double x) { return std::sin(1.5707963267948966 * x); }), mixed)));
  bodies.push_back(cube("slivers", fan(0, -0.999, lines(40, same))));
  std::mt19937 random(3);
  Body points = bodies[0];
  for (int pass = 0; pass < 4; ++pass) points = split_at_random_points(points, random);
  points.name = "random points";
  bodies.push_back(std::move(points));
  Body corner = bodies[2];
  for (int pass = 0; pass < 5; ++pass) {  // only the triangles near (1, 1, 1) are split
    Builder builder;
    for (Eigen::Index t = 0; t < corner.F.rows(); ++t) {
      const Eigen::Vector3d a = corner.V.row(corner.F(t, 0)), b = corner.V.row(corner.F(t, 1)),
                            c = corner.V.row(corner.F(t, 2));
      if (a.sum() + b.sum() + c.sum() > 4) {
        const Eigen::Vector3d m = (a + b + c) / 3;
        builder.triangle(a, b, m);
        builder.triangle(b, c, m);
        builder.triangle(c, a, m);
      } else {
        builder.triangle(a, b, c);
      }
    }
    corner = builder.finish("refined in a corner");
  }
  bodies.push_back(std::move(corner));
  bodies.push_back(shuffled(bodies[6], random));
  bodies.back().name = "in random order";
  return bodies;
}

Body split_at_random_points(const Body& body, std::mt19937& random) {
  std::exponential_distribution<double> share;
  Body result;
  result.name = body.name + ", split";
  const Eigen::Index vertices = body.V.rows(), triangles = body.F.rows();
  result.V.resize(vertices + triangles, 3);
  result.V.topRows(vertices) = body.V;
  result.F.resize(3 * triangles, 3);
  for (Eigen::Index t = 0; t < triangles; ++t) {
    Eigen::Vector3d w(share(random), share(random), share(random));
    w /= w.sum();
    result.V.row(vertices + t).setZero();
    for (Eigen::Index i = 0; i < 3; ++i)
      result.V.row(vertices + t) += w[i] * body.V.row(body.F(t, i));
    for (Eigen::Index i = 0; i < 3; ++i) {
      result.F.row(3 * t + i) << body.F(t, i), body.F(t, (i + 1) % 3),
          static_cast<std::int32_t>(vertices + t);
    }
  }
  return result;
}

Body torus(double R, double r, int n, int m) {
  Body body;
  body.name = "torus";
  body.V.resize(n * m, 3);
  body.F.resize(2 * n * m, 3);
  constexpr double kTurn = 6.283185307179586;
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const double theta = kTurn * i / n, phi = kTurn * j / m, ring = R + r * std::cos(phi);
      body.V.row(i + n * j) << ring * std::cos(theta), ring * std::sin(theta), r * std::sin(phi);
      const int a = i + n * j, b = (i + 1) % n + n * j;
      const int d = i + n * ((j + 1) % m), c = (i + 1) % n + n * ((j + 1) % m);
      body.F.row(2 * (i + n * j)) << a, b, c;
      body.F.row(2 * (i + n * j) + 1) << a, c, d;
    }
  }
  return body;
}

Body patch(int n, double (*height)(double, double)) {
  Body body;
  body.name = "patch";
  body.V.resize((n + 1) * (n + 1), 3);
  body.F.resize(2 * n * n, 3);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = -1 + 2.0 * i / n, y = -1 + 2.0 * j / n;
      body.V.row(i + (n + 1) * j) << x, y, height(x, y);
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = i + (n + 1) * j, b = a + 1, d = a + n + 1, c = d + 1;
      body.F.row(2 * (i + n * j)) << a, b, c;
      body.F.row(2 * (i + n * j) + 1) << a, c, d;
    }
  }
  return body;
}

double distance_to_mesh(const Points& from, const Points& V, const Triangles& F) {
  double most = 0.0;
  for (Eigen::Index p = 0; p < from.rows(); ++p) {
    double least = 1e300;
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
      const std::array<Eigen::Vector3d, 3> corners{V.row(F(t, 0)), V.row(F(t, 1)), V.row(F(t, 2))};
      least = std::min(least, squared_distance(from.row(p), corners));
    }
    most = std::max(most, least);
  }
  return std::sqrt(most);
}

Body shuffled(const Body& body, std::mt19937& random) {
  std::vector<std::int32_t> place(static_cast<std::size_t>(body.V.rows()));
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), random);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(body.F.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::shuffle(order.begin(), order.end(), random);
  Body result = body;
  for (Eigen::Index v = 0; v < body.V.rows(); ++v)
    result.V.row(place[static_cast<std::size_t>(v)]) = body.V.row(v);
  for (Eigen::Index t = 0; t < body.F.rows(); ++t) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      result.F(t, i) =
          place[static_cast<std::size_t>(body.F(order[static_cast<std::size_t>(t)], (i + t) % 3))];
    }
  }
  return result;
}

}  // namespace shape3d::mapping::test
