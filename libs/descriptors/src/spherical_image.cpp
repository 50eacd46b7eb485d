#include "shape3d/descriptors/spherical_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "parallel.hpp"
#include "sh_checks.hpp"
#include "sphere_cells.hpp"
#include "sphere_points.hpp"

namespace shape3d::descriptors {
namespace {

// What both kinds of attribute share: the map with outward triangles, and the values.
struct Drawing {
  Points S;
  Triangles F;
  Eigen::MatrixXd values;
  bool at_vertices;
  int size;
  int threads;
};

// Triangles are summed in a number of parts that does not depend on the threads; each part has the
// memory of an image.
int parts_of(int size) { return size <= 256 ? 8 : 1; }

// A triangle of a linear attribute, halved at its longest edge until no edge is longer than half a
// cell; each piece has the attribute's value at its middle. Places are barycentric.
class DividedTriangle {
 public:
  DividedTriangle(const Drawing& drawing, SphereCells& cells)
      : drawing_(drawing),
        cells_(cells),
        limit_(0.5 * detail::kPi / drawing.size),
        value_(drawing.values.cols()) {}

  void add(Eigen::Index t) {
    for (int i = 0; i < 3; ++i) {
      corners_.col(i) = drawing_.S.row(drawing_.F(t, i));
      values_[static_cast<std::size_t>(i)] = drawing_.F(t, i);
    }
    const Place a{Eigen::Vector3d::UnitX(), corners_.col(0)},
        b{Eigen::Vector3d::UnitY(), corners_.col(1)}, c{Eigen::Vector3d::UnitZ(), corners_.col(2)};
    divide(a, b, c);
  }

 private:
  struct Place {
    Eigen::Vector3d weights;    // barycentric
    Eigen::Vector3d direction;  // of the point, a unit vector
  };

  void divide(const Place& a, const Place& b, const Place& c) {
    const double ab = (b.direction - a.direction).squaredNorm(),
                 bc = (c.direction - b.direction).squaredNorm(),
                 ca = (a.direction - c.direction).squaredNorm();
    const double longest = std::max({ab, bc, ca});
    if (longest <= limit_ * limit_) {
      const Eigen::Vector3d weights = (a.weights + b.weights + c.weights) / 3.0;
      for (Eigen::Index k = 0; k < value_.size(); ++k) {
        value_[k] = weights[0] * drawing_.values(values_[0], k) +
                    weights[1] * drawing_.values(values_[1], k) +
                    weights[2] * drawing_.values(values_[2], k);
      }
      cells_.add({off_axis(a.direction), off_axis(b.direction), off_axis(c.direction)},
                 value_.data());
      return;
    }
    if (longest == ab) {
      halve(a, b, c);
    } else if (longest == bc) {
      halve(b, c, a);
    } else {
      halve(c, a, b);
    }
  }

  // At the middle of the edge from a to b.
  void halve(const Place& a, const Place& b, const Place& c) {
    Place middle;
    middle.weights = 0.5 * (a.weights + b.weights);
    middle.direction = (corners_ * middle.weights).normalized();
    divide(a, middle, c);
    divide(middle, b, c);
  }

  const Drawing& drawing_;
  SphereCells& cells_;
  double limit_;
  Eigen::Matrix3d corners_;
  std::array<std::int32_t, 3> values_{};  // rows of the attribute
  Eigen::VectorXd value_;
};

Eigen::MatrixXd area_means(const Drawing& drawing) {
  const int components = static_cast<int>(drawing.values.cols());
  const int parts = parts_of(drawing.size);
  std::vector<SphereCells> cells(static_cast<std::size_t>(parts),
                                 SphereCells(drawing.size, components));
  const Eigen::Index count = drawing.F.rows();
  detail::parallel_blocks(parts, 1, drawing.threads, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t part = first; part < last; ++part) {
      SphereCells& sums = cells[static_cast<std::size_t>(part)];
      DividedTriangle divided(drawing, sums);
      for (Eigen::Index t = count * part / parts; t < count * (part + 1) / parts; ++t) {
        if (drawing.at_vertices) {
          divided.add(t);
        } else {
          const Eigen::VectorXd value = drawing.values.row(t);
          sums.add(
              {off_axis(drawing.S.row(drawing.F(t, 0))), off_axis(drawing.S.row(drawing.F(t, 1))),
               off_axis(drawing.S.row(drawing.F(t, 2)))},
              value.data());
        }
      }
    }
  });
  for (std::size_t part = 1; part < cells.size(); ++part) cells[0].add(cells[part]);
  return cells[0].means();
}

Eigen::MatrixXd point_samples(const Drawing& drawing) {
  const std::vector<SpherePlace> places = locate_pixels(drawing.S, drawing.F, drawing.size);
  Eigen::MatrixXd samples(static_cast<Eigen::Index>(places.size()), drawing.values.cols());
  for (std::size_t pixel = 0; pixel < places.size(); ++pixel) {
    const SpherePlace& place = places[pixel];
    const auto row = static_cast<Eigen::Index>(pixel);
    if (drawing.at_vertices) {
      samples.row(row) = place.u * drawing.values.row(drawing.F(place.triangle, 0)) +
                         place.v * drawing.values.row(drawing.F(place.triangle, 1)) +
                         place.w * drawing.values.row(drawing.F(place.triangle, 2));
    } else {
      samples.row(row) = drawing.values.row(place.triangle);
    }
  }
  return samples;
}

void check_values(const Eigen::Ref<const Eigen::MatrixXd>& values, Eigen::Index rows,
                  const char* expected) {
  if (values.rows() != rows) {
    throw std::invalid_argument("values has " + std::to_string(values.rows()) +
                                " rows, expected those of " + expected + ", " +
                                std::to_string(rows));
  }
  if (!values.allFinite()) {
    throw std::invalid_argument("values holds a number that is not finite, expected finite ones");
  }
}

SphericalImage draw(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
                    const Eigen::Ref<const Points>& S,
                    const Eigen::Ref<const Eigen::MatrixXd>& values, bool at_vertices,
                    const SphericalImageOptions& options) {
  detail::check_image_size(options.size);
  const int threads = detail::resolve_threads(options.threads);
  const int orientation = check_spherical_map(V, F, S);
  check_values(values, at_vertices ? V.rows() : F.rows(), at_vertices ? "V" : "F");
  Drawing drawing{S.rowwise().normalized(), F, values, at_vertices, options.size, threads};
  if (orientation < 0) drawing.F.col(1).swap(drawing.F.col(2));
  SphericalImage image;
  image.size = options.size;
  image.samples =
      options.sampling == ImageSampling::area ? area_means(drawing) : point_samples(drawing);
  return image;
}

}  // namespace

SphericalImage vertex_image(const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
                            const Eigen::Ref<const Points>& S,
                            const Eigen::Ref<const Eigen::MatrixXd>& values,
                            const SphericalImageOptions& options) {
  return draw(V, F, S, values, true, options);
}

SphericalImage triangle_image(const Eigen::Ref<const Points>& V,
                              const Eigen::Ref<const Triangles>& F,
                              const Eigen::Ref<const Points>& S,
                              const Eigen::Ref<const Eigen::MatrixXd>& values,
                              const SphericalImageOptions& options) {
  return draw(V, F, S, values, false, options);
}

SphericalImage spherical_normal_image(const Eigen::Ref<const Points>& V,
                                      const Eigen::Ref<const Triangles>& F,
                                      const Eigen::Ref<const Points>& S,
                                      const SphericalImageOptions& options) {
  const int orientation = check_spherical_map(V, F, S);
  // In units of the surface's size, so that products neither vanish nor overflow.
  const double size = (V.colwise().maxCoeff() - V.colwise().minCoeff()).maxCoeff();
  Eigen::MatrixXd normals(F.rows(), 3);
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::Vector3d a = (V.row(F(t, 1)) - V.row(F(t, 0))) / size;
    const Eigen::Vector3d b = (V.row(F(t, 2)) - V.row(F(t, 0))) / size;
    const Eigen::Vector3d normal = orientation * a.cross(b);
    const double length = normal.norm();
    normals.row(t) = length > 0.0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
  }
  return triangle_image(V, F, S, normals, options);
}

SphericalImage spherical_geometry_image(const Eigen::Ref<const Points>& V,
                                        const Eigen::Ref<const Triangles>& F,
                                        const Eigen::Ref<const Points>& S,
                                        const SphericalImageOptions& options) {
  const Frame frame = surface_frame(V, F, Centre::area, Scale::rms, 1.0);
  const Eigen::MatrixXd positions = (V.rowwise() - frame.centre.transpose()) / frame.radius;
  return vertex_image(V, F, S, positions, options);
}

SphericalImage spherical_curvature_image(const Eigen::Ref<const Points>& V,
                                         const Eigen::Ref<const Triangles>& F,
                                         const Eigen::Ref<const Points>& S,
                                         const SphericalImageOptions& options) {
  const int orientation = check_spherical_map(V, F, S);
  const double radius = std::sqrt(surface_area(V, F) / (4.0 * detail::kPi));
  if (radius == 0.0) throw std::invalid_argument("every triangle of the mesh has zero area");
  const Eigen::VectorXd curvature =
      (orientation * radius * vertex_mean_curvature(V, F)).array().atan() * (2.0 / detail::kPi);
  return vertex_image(V, F, S, curvature, options);
}

}  // namespace shape3d::descriptors
