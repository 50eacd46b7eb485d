#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "common/mesh.hpp"

// Meshes whose counts, genus, area and volume are known in closed form.
namespace shape3d::test {

using apps::Mesh;

inline Mesh make_mesh(const std::vector<std::array<double, 3>>& points,
                      const std::vector<std::array<std::int32_t, 3>>& triangles) {
  Mesh mesh;
  mesh.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    mesh.V.row(static_cast<Eigen::Index>(i)) << points[i][0], points[i][1], points[i][2];
  }
  mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    mesh.F.row(static_cast<Eigen::Index>(i)) << triangles[i][0], triangles[i][1], triangles[i][2];
  }
  return mesh;
}

/// Corners (0,0,0), (1,0,0), (0,1,0), (0,0,1), seen counter-clockwise from outside: volume 1/6,
/// area 3/2 + √3/2.
inline Mesh tetrahedron() {
  return make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

/// The unit cube: volume 1, area 6.
inline Mesh cube() {
  return make_mesh(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      {{0, 2, 1},
       {0, 3, 2},
       {4, 5, 6},
       {4, 6, 7},
       {0, 1, 5},
       {0, 5, 4},
       {1, 2, 6},
       {1, 6, 5},
       {2, 3, 7},
       {2, 7, 6},
       {3, 0, 4},
       {3, 4, 7}});
}

/// A grid of u × v quads, each two triangles, whose opposite sides are joined: v always, u when
/// `around`, with the v direction reversed when `twisted`. A torus, a tube, a Klein bottle.
inline Mesh torus(int u_count, int v_count, double large = 3.0, double small = 1.0,
                  bool twisted = false) {
  constexpr double kTurn = 6.283185307179586;
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  for (int u = 0; u < u_count; ++u) {
    for (int v = 0; v < v_count; ++v) {
      const double a = kTurn * u / u_count, b = kTurn * v / v_count;
      const double radius = large + small * std::cos(b);
      points.push_back({radius * std::cos(a), radius * std::sin(a), small * std::sin(b)});
    }
  }
  const auto id = [&](int u, int v) {
    if (u == u_count) {
      u = 0;
      if (twisted) v = -v;
    }
    return static_cast<std::int32_t>(u * v_count + (v % v_count + v_count) % v_count);
  };
  for (int u = 0; u < u_count; ++u) {
    for (int v = 0; v < v_count; ++v) {
      triangles.push_back({id(u, v), id(u + 1, v), id(u + 1, v + 1)});
      triangles.push_back({id(u, v), id(u + 1, v + 1), id(u, v + 1)});
    }
  }
  return make_mesh(points, triangles);
}

/// An octahedron of 8n² triangles at radius 1 + a few waves: closed, of genus 0, star-shaped,
/// without symmetry.
inline Mesh bumpy_ball(int n) {
  std::map<std::array<int, 3>, std::int32_t> ids;  // by n times the place on the octahedron
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  const auto id = [&](const std::array<int, 3>& place) {
    const auto [entry, added] = ids.emplace(place, static_cast<std::int32_t>(points.size()));
    if (added) {
      const double length = std::hypot(place[0], place[1], place[2]);
      const double x = place[0] / length, y = place[1] / length, z = place[2] / length;
      const double radius = 1 + 0.25 * std::sin(2 * x + y) + 0.2 * x * z + 0.15 * y * z * z;
      points.push_back({1.5 * radius * x, radius * y, 0.7 * radius * z});
    }
    return entry->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const int sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
    const auto corner = [&](int i, int j) { return id({sx * (n - i - j), sy * i, sz * j}); };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        std::vector<std::array<std::int32_t, 3>> added{
            {corner(i, j), corner(i + 1, j), corner(i, j + 1)}};
        if (i + j + 1 < n) {
          added.push_back({corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
        }
        for (std::array<std::int32_t, 3> triangle : added) {
          if (sx * sy * sz < 0) std::swap(triangle[1], triangle[2]);
          triangles.push_back(triangle);
        }
      }
    }
  }
  return make_mesh(points, triangles);
}

/// A band of `count` quads, its end joined to its start with half a turn.
inline Mesh moebius_strip(int count) {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  for (int i = 0; i < count; ++i) {
    const double a = 6.283185307179586 * i / count;
    for (const double w : {-0.4, 0.4}) {
      const double radius = 2.0 + w * std::cos(a / 2);
      points.push_back({radius * std::cos(a), radius * std::sin(a), w * std::sin(a / 2)});
    }
  }
  for (int i = 0; i < count; ++i) {
    const bool last = i + 1 == count;
    const auto a = static_cast<std::int32_t>(2 * i), b = a + 1;
    const auto c = static_cast<std::int32_t>(last ? 1 : a + 2),
               d = static_cast<std::int32_t>(last ? 0 : a + 3);
    triangles.push_back({a, c, b});
    triangles.push_back({b, c, d});
  }
  return make_mesh(points, triangles);
}

/// The triangles of both; the second moved.
inline Mesh together(const Mesh& a, const Mesh& b, const Eigen::RowVector3d& shift) {
  Mesh mesh;
  mesh.V.resize(a.V.rows() + b.V.rows(), 3);
  mesh.V << a.V, b.V.rowwise() + shift;
  mesh.F.resize(a.F.rows() + b.F.rows(), 3);
  mesh.F << a.F, b.F.array() + static_cast<std::int32_t>(a.V.rows());
  return mesh;
}

/// The same with every triangle turned over.
inline Mesh turned_over(Mesh mesh) {
  mesh.F.col(1).swap(mesh.F.col(2));
  return mesh;
}

}  // namespace shape3d::test
