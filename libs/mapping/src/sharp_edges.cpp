#include "sharp_edges.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "point_triangle.hpp"

namespace shape3d::mapping::detail {
namespace {

std::size_t index(std::int32_t v) { return static_cast<std::size_t>(v); }

void erase(std::vector<std::int32_t>& list, std::int32_t value) {
  list.erase(std::remove(list.begin(), list.end(), value), list.end());
}

}  // namespace

std::uint64_t SharpEdges::key(std::int32_t a, std::int32_t b) {
  const auto [low, high] = std::minmax(a, b);
  return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
}

void SharpEdges::add(std::int32_t a, std::int32_t b, const Positions& P) {
  std::vector<Point>& points = points_[key(a, b)];
  points.push_back({0.5 * (P[index(a)] + P[index(b)]), 0.0});
  for (const auto& [v, other] : {std::pair{a, b}, std::pair{b, a}}) {
    if (neighbours_[index(v)].empty()) points.push_back({P[index(v)], 0.0});  // each vertex once
    neighbours_[index(v)].push_back(other);
  }
}

SharpEdges::Rule SharpEdges::rule(std::int32_t v0, std::int32_t v1, std::int32_t left,
                                  std::int32_t right) const {
  const std::size_t degree0 = degree(v0), degree1 = degree(v1);
  if (degree0 == 0 && degree1 == 0) return Rule::free;
  for (const std::int32_t apex : {left, right})
    if (apex >= 0 && has(v0, apex) && has(v1, apex)) return Rule::forbidden;
  if (degree0 == 0) return Rule::stay_at_v1;
  if (degree1 == 0) return Rule::stay_at_v0;
  if (!has(v0, v1)) return Rule::forbidden;
  if (degree0 != 2 && degree1 != 2) return Rule::forbidden;
  if (degree0 != 2) return Rule::stay_at_v0;
  return degree1 != 2 ? Rule::stay_at_v1 : Rule::free;
}

SharpEdges::Around SharpEdges::around(std::int32_t v0, std::int32_t v1) const {
  Around result;
  for (const auto& [v, other] : {std::pair{v0, v1}, std::pair{v1, v0}}) {
    for (const std::int32_t end : neighbours_[index(v)]) {
      if (end != other) result.ends.push_back(end);
      if (end == other && v == v1) continue;  // the points of the edge v0 v1 once
      for (const Point& point : points_.at(key(v, end))) result.points.push_back(&point);
    }
  }
  return result;
}

double SharpEdges::change(std::int32_t v0, std::int32_t v1, const Eigen::Vector3d& x,
                          const Positions& P) const {
  if (degree(v0) == 0 && degree(v1) == 0) return 0.0;
  const Around found = around(v0, v1);
  double sum = 0.0;
  for (const Point* point : found.points) {
    double least = (point->position - x).squaredNorm();
    for (const std::int32_t end : found.ends) {
      const Foot foot = nearest_on_segment(point->position, x, P[index(end)]);
      least = std::min(least, foot.squared_distance);
    }
    sum += least - point->squared_distance;
  }
  return sum;
}

void SharpEdges::collapse(std::int32_t removed, std::int32_t kept, const Positions& P) {
  if (degree(removed) == 0 && degree(kept) == 0) return;
  const Around found = around(removed, kept);
  std::vector<Point> points;
  for (const Point* point : found.points) points.push_back(*point);
  for (const std::int32_t v : {removed, kept}) {
    for (const std::int32_t end : neighbours_[index(v)]) {
      points_.erase(key(v, end));
      erase(neighbours_[index(end)], v);
    }
    neighbours_[index(v)].clear();
  }
  for (const std::int32_t end : found.ends) {
    if (std::count(neighbours_[index(kept)].begin(), neighbours_[index(kept)].end(), end) > 0)
      continue;
    neighbours_[index(kept)].push_back(end);
    neighbours_[index(end)].push_back(kept);
    points_[key(kept, end)];
  }
  for (Point& point : points) {
    point.squared_distance = std::numeric_limits<double>::max();
    std::int32_t nearest = -1;
    for (const std::int32_t end : neighbours_[index(kept)]) {
      const Foot foot = nearest_on_segment(point.position, P[index(kept)], P[index(end)]);
      if (foot.squared_distance >= point.squared_distance) continue;
      point.squared_distance = foot.squared_distance;
      nearest = end;
    }
    if (nearest >= 0) points_[key(kept, nearest)].push_back(point);
  }
}

double SharpEdges::energy() const {
  double sum = 0.0;
  for (const auto& [edge, points] : points_)
    for (const Point& point : points) sum += point.squared_distance;
  return sum;
}

}  // namespace shape3d::mapping::detail
