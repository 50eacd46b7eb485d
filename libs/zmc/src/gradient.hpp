#pragma once

// Gradients and normals at surface vertices.

#include <cmath>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/LU>

#include "geometry.hpp"
#include "samples.hpp"
#include "shape3d/zmc/options.hpp"

namespace shape3d::zmc::detail {

/// Differences of samples along the lattice axes, at lattice points.
template <class T>
class LatticeGradient {
 public:
  explicit LatticeGradient(const VolumeView& view)
      : data_(static_cast<const T*>(view.data)),
        strides_(view.effective_strides()),
        dims_(view.dims) {}

  /// Per lattice step, by central differences; one-sided where a neighbour is missing or not
  /// finite.
  Eigen::Vector3d operator()(const std::array<std::int64_t, 3>& p) const {
    const T* here = data_ + p[0] * strides_[0] + p[1] * strides_[1] + p[2] * strides_[2];
    Eigen::Vector3d g;
    for (std::size_t d = 0; d < 3; ++d) {
      const bool has_lower = p[d] > 0 && usable(here[-(p[d] > 0 ? strides_[d] : 0)]);
      const bool has_upper =
          p[d] + 1 < dims_[d] && usable(here[p[d] + 1 < dims_[d] ? strides_[d] : 0]);
      const auto lower = static_cast<double>(has_lower ? here[-strides_[d]] : *here);
      const auto upper = static_cast<double>(has_upper ? here[strides_[d]] : *here);
      // Halves first: the difference of two doubles may overflow, the central difference less
      // easily.
      const double scale = has_lower && has_upper ? 0.5 : 1.0;
      g[static_cast<Eigen::Index>(d)] = scale * upper - scale * lower;
    }
    return g;
  }

 private:
  static bool usable(T value) {
    if constexpr (std::is_floating_point_v<T>) return std::isfinite(value);
    return true;
  }

  const T* data_;
  std::array<std::int64_t, 3> strides_;
  std::array<std::int64_t, 3> dims_;
};

/// Attributes of surface vertices: the world gradient, and the normal that it gives.
struct VertexAttributes {
  Eigen::Vector3d gradient, normal;
};

/// Computes attributes of vertices on lattice edges. Lattice indices count from the imaginary layer
/// when capped.
class AttributeSampler {
 public:
  AttributeSampler(const VolumeView& view, const Options& options)
      : view_(view),
        margin_(options.border == Border::capped ? 1 : 0),
        outward_(options.inside == Inside::below ? 1.0 : -1.0),
        to_world_((view.direction * view.spacing.asDiagonal()).inverse().transpose()) {}

  /// At t of the edge from (i, j, k) along an axis; t = 0 at a lattice point, whatever the axis.
  template <class T>
  VertexAttributes at_edge(const LatticeGradient<T>& gradient, std::int64_t i, std::int64_t j,
                           std::int64_t k, int axis, double t) const {
    std::array<std::int64_t, 3> lower{i - margin_, j - margin_, k - margin_}, upper = lower;
    const auto d = static_cast<std::size_t>(axis);
    if (t > 0.0) {
      ++upper[d];
      if (!inside(lower) || !inside(upper)) {
        Eigen::Vector3d out = Eigen::Vector3d::Zero();
        out[axis] = inside(lower) ? 1.0 : -1.0;
        return {Eigen::Vector3d::Zero(), (to_world_ * out).normalized()};
      }
    }
    Eigen::Vector3d g = gradient(lower);
    if (t > 0.0) g = (1.0 - t) * g + t * gradient(upper);
    return from_gradient(to_world(g));
  }
  /// Per lattice step to per world unit. Sums are written out: write_attributes() makes the same.
  Eigen::Vector3d to_world(const Eigen::Vector3d& g) const {
    Eigen::Vector3d world;
    for (Eigen::Index d = 0; d < 3; ++d) {
      world[d] = (to_world_(d, 0) * g[0] + to_world_(d, 1) * g[1]) + to_world_(d, 2) * g[2];
    }
    return world;
  }
  VertexAttributes from_gradient(const Eigen::Vector3d& gradient) const {
    const double square =
        (gradient[0] * gradient[0] + gradient[1] * gradient[1]) + gradient[2] * gradient[2];
    const double length = is_plain_square(square) ? std::sqrt(square) : gradient.stableNorm();
    if (!(length > 0.0) || !std::isfinite(length)) return {gradient, Eigen::Vector3d::Zero()};
    return {gradient, outward_ * (gradient / length)};
  }
  /// Whether a square of a length is far from overflow and underflow.
  static bool is_plain_square(double square) { return square >= 0x1p-900 && square <= 0x1p900; }

  [[nodiscard]] const Eigen::Matrix3d& world_matrix() const { return to_world_; }
  [[nodiscard]] double outward() const { return outward_; }

  /// Of a surface vertex (as in CellPatches) of cell (i, j, k), with its crossing parameter.
  VertexAttributes at_surface_vertex(const AnyMagnitudeReader& magnitude, std::int64_t i,
                                     std::int64_t j, std::int64_t k, int vertex) const {
    const auto& low = kCellVertices[vertex >= 12 ? vertex - 12 : Geometry::lower_end(vertex)];
    const int axis = vertex >= 12 ? 0 : Geometry::edge_axis(vertex);
    i += low[0], j += low[1], k += low[2];
    const double t = vertex >= 12 ? 0.0 : magnitude.crossing(i, j, k, axis);
    return visit_sample_type(view_.type, [&](auto sample) {
      return at_edge(LatticeGradient<decltype(sample)>(view_), i, j, k, axis, t);
    });
  }

 private:
  bool inside(const std::array<std::int64_t, 3>& p) const {
    for (std::size_t d = 0; d < 3; ++d) {
      if (p[d] < 0 || p[d] >= view_.dims[d]) return false;
    }
    return true;
  }

  const VolumeView& view_;
  std::int64_t margin_;
  double outward_;
  Eigen::Matrix3d to_world_;
};

}  // namespace shape3d::zmc::detail
