#include "sphere_work.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>
#include <shape3d/descriptors/spherical_image.hpp>
#include <shape3d/mapping/align.hpp>
#include <shape3d/mapping/distortion.hpp>
#include <shape3d/mapping/inspect.hpp>
#include <shape3d/mapping/spherical_map.hpp>

#include "common/vertex_normals.hpp"

namespace shape3d::apps::viewer {
namespace {

// 127.5 (1 + x) for each coordinate, x within −1 … 1.
std::vector<std::uint8_t> three_bytes(const Eigen::MatrixXd& values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(static_cast<std::size_t>(3 * values.rows()));
  for (Eigen::Index n = 0; n < values.rows(); ++n) {
    for (Eigen::Index c = 0; c < 3; ++c)
      bytes.push_back(static_cast<std::uint8_t>(
          std::lround(127.5 * (1.0 + std::clamp(values(n, c), -1.0, 1.0)))));
  }
  return bytes;
}

// One pixel for each sample, north above.
Raster picture_of(const descriptors::SphericalImage& image,
                  const std::function<Color(const Eigen::VectorXd&)>& color) {
  Raster raster = make_raster(2 * image.size, image.size, {0.0, 0.0, 0.0});
  std::uint8_t* to = raster.rgb.data();
  for (int row = 0; row < image.size; ++row) {
    for (int column = 0; column < 2 * image.size; ++column) {
      // Columns of the picture run from −π to π, those of the image from 0 to 2π.
      const int from = (column + image.size) % (2 * image.size);
      const Color c = color(image.samples.row(2L * image.size * row + from).transpose());
      for (const double channel : c)
        *to++ = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(channel, 0.0, 1.0)));
    }
  }
  return raster;
}

Color direction_color(const Eigen::VectorXd& v) {
  return {0.5 * (1.0 + v[0]), 0.5 * (1.0 + v[1]), 0.5 * (1.0 + v[2])};
}

class Work {
 public:
  Work(const Mesh& mesh, const SphereWish& wish, const std::function<bool(double)>& progress)
      : wish_(wish), progress_(progress) {
    result_.mesh.V = mesh.V;
    result_.mesh.F = mesh.F;
  }

  SphereResult run() {
    try {
      if (map()) color();
    } catch (const std::invalid_argument& error) {
      result_.error = std::string("The mesh cannot be mapped: ") + error.what();
    }
    return std::move(result_);
  }

 private:
  bool report(double share) {
    result_.cancelled = result_.cancelled || (progress_ && !progress_(share));
    return !result_.cancelled;
  }

  bool map() {
    const mapping::Inspection found = mapping::inspect(result_.mesh.V, result_.mesh.F);
    if (!found.spherical()) {
      result_.error =
          "The mesh cannot be mapped: " + found.why_not_spherical("shape3d repair", "shape3d wrap");
      return false;
    }
    pose_ = mapping::align(result_.mesh.V, result_.mesh.F);
    result_.mesh.V = (result_.mesh.V.rowwise() - pose_.centroid.transpose()) * pose_.scale;
    mapping::SphericalMapOptions options;
    options.linear = wish_.linear;
    options.area_balance = wish_.area_balance;
    options.progress = [this](double share) { return report(0.8 * share); };
    mapping::SphericalMap map = mapping::spherical_map(result_.mesh.V, result_.mesh.F, options);
    result_.seconds = map.seconds.total;
    if (map.status == mapping::Status::cancelled) {
      result_.cancelled = true;
      return false;
    }
    if (map.status != mapping::Status::certified) {
      result_.error = "The mesh cannot be mapped: ";
      result_.error += to_string(map.status);
      return false;
    }
    result_.median_angle_change = map.distortion.angle_change.median;
    result_.p95_angle_change = map.distortion.angle_change.p95;
    result_.energy_over_area = map.distortion.energy_over_area;
    result_.sphere.V = std::move(map.S);
    result_.sphere.F = result_.mesh.F;
    return report(0.82);
  }

  SphereColoring& coloring(SphereColor color) {
    return result_.colorings[static_cast<std::size_t>(color)];
  }

  void color() {
    posed_ = result_.mesh.V * pose_.rotation.transpose();
    posed_sphere_ = result_.sphere.V * pose_.rotation.transpose();
    options_.size = wish_.image_size;
    options_.sampling = descriptors::ImageSampling::point;
    color_normals();
    if (!report(0.86)) return;
    color_coordinates();
    if (!report(0.9)) return;
    color_curvature();
    if (!report(0.94)) return;
    color_distortion();
    report(1.0);
  }

  void color_normals() {
    SphereColoring& normals = coloring(SphereColor::normal);
    // In the canonical pose, as the image has them.
    normals.bytes = three_bytes(vertex_normals(result_.mesh) * pose_.rotation.transpose());
    normals.image = picture_of(
        descriptors::spherical_normal_image(posed_, result_.mesh.F, posed_sphere_, options_),
        direction_color);
  }

  void color_coordinates() {
    SphereColoring& coordinates = coloring(SphereColor::coordinates);
    const double extent = posed_.cwiseAbs().maxCoeff();
    coordinates.bytes = three_bytes(posed_ / extent);
    coordinates.image = picture_of(
        descriptors::spherical_geometry_image(posed_, result_.mesh.F, posed_sphere_, options_),
        [extent](const Eigen::VectorXd& v) { return direction_color(v / extent); });
  }

  void color_curvature() {
    SphereColoring& curvature = coloring(SphereColor::curvature);
    curvature.scale = {ColorMap::cool_warm, -1.0, 1.0, false, "(2/pi) atan(r H)"};
    curvature.has_scale = true;
    const double r =
        std::sqrt(descriptors::surface_area(result_.mesh.V, result_.mesh.F) / (4.0 * M_PI));
    const Eigen::VectorXd H = descriptors::vertex_mean_curvature(result_.mesh.V, result_.mesh.F);
    const Eigen::VectorXd bounded = (H.array() * r).atan() * (2.0 / M_PI);
    curvature.bytes =
        colors_of(bounded.data(), static_cast<std::size_t>(bounded.size()), curvature.scale);
    curvature.image = picture_of(
        descriptors::spherical_curvature_image(posed_, result_.mesh.F, posed_sphere_, options_),
        [&curvature](const Eigen::VectorXd& v) {
          return color_at(curvature.scale.map, curvature.scale.share_of(v[0]));
        });
  }

  void color_distortion() {
    const mapping::TriangleDistortion distortion =
        mapping::triangle_distortion(result_.mesh.V, result_.mesh.F, result_.sphere.V);
    // Round upper ends, so that pictures of several meshes can be compared.
    const double worst = std::max(1.0, std::ceil(result_.p95_angle_change / 5.0) * 5.0);
    color_triangles(coloring(SphereColor::angle), distortion.angle_change,
                    {ColorMap::viridis, 0.0, worst, false, "angle change (degrees)"});
    color_triangles(coloring(SphereColor::area), distortion.log10_area_scale,
                    {ColorMap::cool_warm, -1.5, 1.5, false, "log10 of the area factor"});
  }

  void color_triangles(SphereColoring& coloring, const std::vector<double>& values,
                       const ColorScale& scale) {
    coloring.scale = scale;
    coloring.has_scale = true;
    coloring.of_triangles = true;
    coloring.bytes = colors_of(values.data(), values.size(), scale);
    Eigen::MatrixXd column(static_cast<Eigen::Index>(values.size()), 1);
    for (std::size_t t = 0; t < values.size(); ++t)
      column(static_cast<Eigen::Index>(t), 0) = std::isfinite(values[t]) ? values[t] : scale.lower;
    coloring.image = picture_of(
        descriptors::triangle_image(posed_, result_.mesh.F, posed_sphere_, column, options_),
        [&scale](const Eigen::VectorXd& v) { return color_at(scale.map, scale.share_of(v[0])); });
  }

  SphereWish wish_;
  const std::function<bool(double)>& progress_;
  SphereResult result_;
  mapping::Pose pose_;
  Mesh::Points posed_, posed_sphere_;
  descriptors::SphericalImageOptions options_;
};

}  // namespace

SphereResult map_and_color(const Mesh& mesh, const SphereWish& wish,
                           const std::function<bool(double)>& progress) {
  return Work(mesh, wish, progress).run();
}

}  // namespace shape3d::apps::viewer
