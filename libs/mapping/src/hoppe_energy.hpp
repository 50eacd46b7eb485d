#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "shape3d/mapping/mesh.hpp"
#include "shape3d/mapping/progressive.hpp"
#include "sharp_edges.hpp"

namespace shape3d::mapping::detail {

/// The triangles round an edge v0 v1.
struct EdgeStar {
  std::int32_t v0 = 0, v1 = 0;
  std::int32_t left = -1, right = -1;  ///< Third vertices of the triangles at the edge; −1: none.
  std::vector<std::int32_t> faces;     ///< Those at v0 or v1 that stay.
  std::vector<std::int32_t> removed;   ///< Those at the edge.
  std::vector<std::array<std::int32_t, 3>> corners;  ///< Of `faces`.
};

/// Hoppe's energy (4.12) of a mesh whose edges are collapsed, and by how much a collapse changes
/// it. Lengths are divided by the diagonal of the bounding box.
class HoppeEnergy {
 public:
  /// @param P  Positions in any unit. @param F  An oriented manifold.
  HoppeEnergy(std::vector<Eigen::Vector3d> P, const ConstTriangles& F, const HoppeOptions& options);

  struct Choice {
    Eigen::Vector3d position;
    double cost = 0.0;
  };
  /// The place of the vertex that a collapse leaves, and the change of E; empty when the collapse
  /// is not allowed. From the middle of the edge, one step of least squares with fixed feet.
  [[nodiscard]] std::optional<Choice> evaluate(const EdgeStar& star) const;

  /// Makes a collapse to `position`: the points of the removed and changed triangles get new feet.
  void collapse(const EdgeStar& star, std::int32_t removed, std::int32_t kept,
                const Eigen::Vector3d& position);

  /// E_dist, E_scalar and E_disc at present, weighted; E_spring depends on the place.
  [[nodiscard]] std::array<double, 3> terms() const;

 private:
  struct Sample {
    Eigen::Vector3d position;
    double squared_distance = 0.0, scalar_error = 0.0;
  };
  /// A sample at a triangle of a star after the collapse.
  struct Landing {
    std::size_t triangle = 0;
    Eigen::Vector3d weights;  ///< Of its corners.
    double squared_distance = 0.0;
  };

  /// What a choice depends on besides the place.
  struct Around {
    std::vector<std::int32_t> samples, ring;
    double kappa = 0.0;
  };

  [[nodiscard]] std::vector<Landing> land_all(const std::vector<std::int32_t>& samples,
                                              const EdgeStar& star, const Eigen::Vector3d& x) const;
  [[nodiscard]] Eigen::Vector3d best_position(const EdgeStar& star, const Around& around,
                                              const std::vector<Landing>& landings,
                                              const Eigen::Vector3d& start) const;
  /// Of E by a collapse to x.
  [[nodiscard]] double change(const EdgeStar& star, const Around& around,
                              const std::vector<Landing>& landings, const Eigen::Vector3d& x) const;
  [[nodiscard]] Landing land(const Eigen::Vector3d& p, const EdgeStar& star,
                             const Eigen::Vector3d& x) const;
  [[nodiscard]] std::vector<std::int32_t> samples_of(const EdgeStar& star) const;
  [[nodiscard]] std::vector<std::int32_t> ring_of(const EdgeStar& star) const;
  [[nodiscard]] double spring(const EdgeStar& star, std::size_t samples) const;
  [[nodiscard]] double length_change(const EdgeStar& star, const std::vector<std::int32_t>& ring,
                                     const Eigen::Vector3d& x) const;
  /// Value of the attributes at the vertex of least E_scalar, and what E_scalar is with it.
  [[nodiscard]] std::pair<Eigen::VectorXd, double> best_attributes(
      const EdgeStar& star, const std::vector<std::int32_t>& samples,
      const std::vector<Landing>& landings) const;
  [[nodiscard]] bool moves(const EdgeStar& star, std::int32_t v) const {
    return v == star.v0 || v == star.v1;
  }

  HoppeOptions options_;
  double inverse_square_ = 1.0;  ///< 1 / diagonal².
  std::vector<Eigen::Vector3d> P_;
  Eigen::MatrixXd attributes_;   ///< Of the vertices at present, one a column; or none.
  Eigen::MatrixXd wanted_;       ///< Of the samples.
  std::vector<Sample> samples_;  ///< X: one for each vertex of the given mesh.
  std::vector<std::vector<std::int32_t>> face_samples_;
  SharpEdges sharp_;
};

}  // namespace shape3d::mapping::detail
