#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

namespace shape3d::mapping::detail {

/// The sharp edges of a mesh whose edges are collapsed, and the points that stand for them: each
/// edge that is sharp at the beginning gives its middle and its ends.
class SharpEdges {
 public:
  using Positions = std::vector<Eigen::Vector3d>;  ///< Of the vertices at present.

  explicit SharpEdges(std::size_t vertices) : neighbours_(vertices) {}

  void add(std::int32_t a, std::int32_t b, const Positions& P);

  /// What a collapse of the edge v0 v1 may do.
  enum class Rule { forbidden, free, stay_at_v0, stay_at_v1 };
  /// Keeps how curves of sharp edges are connected: no two of them touch, none shrinks to nothing,
  /// and the vertices where they end or meet stay. `left`, `right`: the third vertices of the
  /// triangles at the edge; −1: none.
  [[nodiscard]] Rule rule(std::int32_t v0, std::int32_t v1, std::int32_t left,
                          std::int32_t right) const;

  /// Sum of the squared distances of the points at the edges of v0 and v1 to these edges after a
  /// collapse to x, less that to the present edges.
  [[nodiscard]] double change(std::int32_t v0, std::int32_t v1, const Eigen::Vector3d& x,
                              const Positions& P) const;

  /// Joins `removed` to `kept`, whose new position P has.
  void collapse(std::int32_t removed, std::int32_t kept, const Positions& P);

  /// Number of sharp edges at a vertex.
  [[nodiscard]] std::size_t degree(std::int32_t v) const {
    return neighbours_[static_cast<std::size_t>(v)].size();
  }
  /// Σ of the squared distances of all points to their edges.
  [[nodiscard]] double energy() const;

 private:
  struct Point {
    Eigen::Vector3d position;
    double squared_distance = 0.0;  ///< To its edge at present.
  };
  struct Around {
    std::vector<std::int32_t> ends;    ///< Of the edges there will be at the vertex.
    std::vector<const Point*> points;  ///< Of the edges there are at v0 and v1.
  };

  static std::uint64_t key(std::int32_t a, std::int32_t b);
  [[nodiscard]] bool has(std::int32_t a, std::int32_t b) const {
    return points_.count(key(a, b)) > 0;
  }
  [[nodiscard]] Around around(std::int32_t v0, std::int32_t v1) const;

  std::vector<std::vector<std::int32_t>> neighbours_;
  std::unordered_map<std::uint64_t, std::vector<Point>> points_;
};

}  // namespace shape3d::mapping::detail
