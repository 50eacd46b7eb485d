#include "corner_mesh.hpp"

#include <algorithm>
#include <numeric>

#include "edge_list.hpp"

namespace shape3d::mapping::detail {

CornerMesh::CornerMesh(std::int64_t triangles, std::int64_t vertices)
    : vertex_(static_cast<std::size_t>(3 * triangles), -1),
      opposite_(static_cast<std::size_t>(3 * triangles), -1),
      corner_(static_cast<std::size_t>(vertices), -1) {}

CornerMesh::CornerMesh(const ConstTriangles& F, std::int64_t vertices)
    : CornerMesh(F.rows(), vertices) {
  std::vector<std::int32_t> triangles(static_cast<std::size_t>(F.rows()));
  std::iota(triangles.begin(), triangles.end(), 0);
  for (const std::int32_t t : triangles) set_triangle(t, F(t, 0), F(t, 1), F(t, 2));
  (void)connect(triangles);
}

void CornerMesh::fill_triangle(std::int32_t triangle, const std::array<std::int32_t, 3>& ids) {
  for (std::size_t i = 0; i < 3; ++i) vertex_[3 * static_cast<std::size_t>(triangle) + i] = ids[i];
}

void CornerMesh::set_triangle(std::int32_t triangle, std::int32_t a, std::int32_t b,
                              std::int32_t c) {
  fill_triangle(triangle, {a, b, c});
  for (Corner at = 3 * triangle; at < 3 * triangle + 3; ++at)
    corner_[static_cast<std::size_t>(vertex(at))] = at;
}

void CornerMesh::set_opposite(Corner c, Corner d) {
  if (c >= 0) opposite_[static_cast<std::size_t>(c)] = d;
  if (d >= 0) opposite_[static_cast<std::size_t>(d)] = c;
}

bool CornerMesh::connect(const std::vector<std::int32_t>& triangles) {
  Triangles F(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) F(static_cast<Eigen::Index>(t), i) = vertex(3 * triangles[t] + i);
  }
  const std::vector<bool> all(triangles.size(), true);
  bool manifold = true;
  const auto uses = edge_list(F, all, static_cast<Eigen::Index>(corner_.size()));
  for_each_edge(uses, [&](const EdgeUse* begin, const EdgeUse* end) {
    if (end - begin > 2 || (end - begin == 2 && begin[0].forward == begin[1].forward)) {
      manifold = false;
    } else if (end - begin == 2) {
      const auto corner = [&](const EdgeUse& use) {  // across the side that begins at use.side
        return 3 * triangles[static_cast<std::size_t>(use.triangle)] + (use.side + 2) % 3;
      };
      set_opposite(corner(begin[0]), corner(begin[1]));
    }
  });
  return manifold;
}

Corner CornerMesh::first_corner(std::int32_t v) const {
  const Corner start = corner_at(v);
  Corner first = start;
  for (Corner c = start;;) {
    const Corner back = turn_back(c);
    if (back < 0) return c;
    if (back == start) return first;
    first = std::min(first, back);
    c = back;
  }
}

CollapsePlace CornerMesh::find_edge(std::int32_t u, std::int32_t v) const {
  CollapsePlace place;
  const Corner first = first_corner(u);
  Corner c = first;
  do {
    if (vertex(next(c)) == v) place.left = c;
    if (vertex(previous(c)) == v) place.right = c;
    c = turn(c);
  } while (c >= 0 && c != first);
  return place;
}

template <class Visit>
void CornerMesh::for_each_kept_corner(const CollapsePlace& place, const Visit& visit) const {
  if (place.left >= 0) {
    Corner c = turn(place.left);
    for (; c >= 0 && c != place.right; c = turn(c)) visit(c);
    if (c >= 0) return;
  }
  // u is at the boundary, so that the walk ended before it came to the other triangle.
  if (place.right >= 0) {
    for (Corner c = turn_back(place.right); c >= 0; c = turn_back(c)) visit(c);
  }
}

void CornerMesh::collapse(const CollapsePlace& place) {
  const std::int32_t v = place.left >= 0 ? vertex(next(place.left)) : vertex(previous(place.right));
  for_each_kept_corner(place, [&](Corner c) { vertex_[static_cast<std::size_t>(c)] = v; });
  // Joins what is across the other two edges; `at_v` and `at_apex` are corners of the triangle.
  const auto remove = [&](Corner at_u, Corner at_v, Corner at_apex) {
    const Corner beyond_u = opposite(at_u), beyond_v = opposite(at_v);
    if (beyond_u >= 0) opposite_[static_cast<std::size_t>(beyond_u)] = beyond_v;
    if (beyond_v >= 0) opposite_[static_cast<std::size_t>(beyond_v)] = beyond_u;
    const std::int32_t apex = vertex(at_apex);
    for (const Corner beyond : {beyond_u, beyond_v}) {
      if (beyond < 0) continue;
      for (const Corner c : {next(beyond), previous(beyond)}) {
        if (vertex(c) == apex) corner_[static_cast<std::size_t>(apex)] = c;
        if (vertex(c) == v) corner_[static_cast<std::size_t>(v)] = c;
      }
    }
  };
  if (place.left >= 0) remove(place.left, next(place.left), previous(place.left));
  if (place.right >= 0) remove(place.right, previous(place.right), next(place.right));
}

void CornerMesh::split(const CollapsePlace& place) {
  const auto insert = [&](Corner at_u, Corner at_v) {
    set_opposite(at_u, opposite(at_u));
    set_opposite(at_v, opposite(at_v));
    corner_[static_cast<std::size_t>(vertex(at_u))] = at_u;
    corner_[static_cast<std::size_t>(vertex(at_v))] = at_v;
  };
  if (place.left >= 0) insert(place.left, next(place.left));
  if (place.right >= 0) insert(place.right, previous(place.right));
  const std::int32_t u = vertex(place.left >= 0 ? place.left : place.right);
  for_each_kept_corner(place, [&](Corner c) { vertex_[static_cast<std::size_t>(c)] = u; });
}

}  // namespace shape3d::mapping::detail
